-- Ten wafers are turned at two aligners and go to a third FOUP. One arm brings a new wafer to an aligner, and the other
-- one takes the turned wafer from there; both aligners turn meanwhile. With --set alone=true one thing is done after the
-- other, with one arm.
cell "../layouts/dual_efem.lua"

local WAFERS <const>, TURN <const> = 10, 1080   -- degrees: the aligner's turn takes time

local function source(wafer)
  return wafer <= 5 and "FOUP1" or "FOUP2", (wafer - 1) % 5 + 1
end

if params.alone then
  for wafer = 1, WAFERS do
    get(source(wafer))   put("P1", 1)
    rotate("P1", TURN)
    get("P1", 1)   put("FOUP3", wafer)
  end
else
  for i, aligner in ipairs { "P1", "P2" } do
    task(function()
      for _ = i, WAFERS, 2 do
        await(aligner .. " is full")
        rotate(aligner, TURN)
        signal(aligner .. " is done")
      end
    end)
  end
  for wafer = 1, WAFERS + 2 do
    local aligner = wafer % 2 == 1 and "P1" or "P2"
    if wafer <= WAFERS then
      local foup, slot = source(wafer)
      get(foup, slot, { gripper = "ONE" })
    end
    if wafer > 2 then
      await(aligner .. " is done")
    end
    if wafer <= 2 then
      put(aligner, 1, { gripper = "ONE" })
    elseif wafer <= WAFERS then
      swap(aligner, 1)
    else
      get(aligner, 1, { gripper = "TWO" })
    end
    if wafer <= WAFERS then
      signal(aligner .. " is full")
    end
    if wafer > 2 then
      put("FOUP3", wafer - 2, { gripper = "TWO" })
    end
  end
end

for wafer = 1, WAFERS do
  local name = (wafer <= 5 and "A" or "B") .. (wafer - 1) % 5 + 1
  expect_offset(name, "FOUP3", wafer, 0, 0, 1e-6)
end
