-- Process modules in a row about a robot, between a load lock for wafers that come and one for those that go. With --set dual=true
-- the robot has two blades, and the first load lock is also the last.
local n = params.n or 3

local function place(degrees)
  local angle = math.rad(degrees)
  return { 700 * math.cos(angle), 700 * math.sin(angle), 900 }
end

local stations, wafers = {}, {}
local step = 300 / (n + 1)
for i = 0, n + 1 do
  local degrees = -150 + i * step + (i % 2) * 7 -- so that ways differ
  local slots = (i == 0 or i == n + 1) and 25 or 1
  stations["S" .. i] = { at = place(degrees), rpy = { 0, 0, degrees }, slots = slots, pitch = 10,
                         counts = i == (params.dual and 0 or n + 1) }
end
for slot = 1, params.lot or 12 do
  wafers[slot] = { name = ("W%02d"):format(slot), station = "S0", slot = slot }
end

local grippers = { { name = "EE" } }
if params.dual then
  grippers[2] = { name = "E2", at = { 0, 0, -15 } }
end
return { grippers = grippers, stations = stations, wafers = wafers }
