-- Two prealigners turn wafers while the arm goes on. With --set alone=true one thing is done after the other, as without tasks.
cell "../layouts/two_aligners.lua"

local aligners, turning = { "P", "Q" }, {}

-- Turns the wafer on its chuck, in a task.
local function begin_align(aligner)
  turning[aligner] = task(function() return align(aligner, { angle = 90 }).notch end)
  if params.alone then join(turning[aligner]) end
end

for slot = 1, 6 do
  local aligner = aligners[2 - slot % 2]
  if slot > 2 then   -- the wafer of two rounds ago has been turned, or will be soon
    join(turning[aligner])
    get(aligner, 1)   put("B", slot - 2)
  end
  if slot <= 4 then
    get("A", slot)   put(aligner, 1)
    begin_align(aligner)
  end
end

for slot = 1, 4 do
  local wafer = ("W%02d"):format(slot)
  expect_offset(wafer, "B", slot, 0, 0, 0.01)
  expect(math.abs(measure("B/" .. slot, wafer).heading - 90) < 0.01, wafer .. "'s notch points to 90 degrees")
end
