-- An equipment front end: a robot on a rail between two FOUPs, a prealigner with an edge sensor, and two load locks. Each lock holds
-- a wafer for as long as the tool behind it takes.
local function foup(y)
  return { kind = "foup", at = { 700, y, 900 }, rail = y, retract = 340 }
end

-- A door in the lock's face, which opens downwards.
local function door(y)
  return { at = { -482, y, 905 }, box = { 12, 420, 130 }, open = { 0, 0, -260 }, seconds = 0.8 }
end

local function lock(y, name)
  return { at = { -700, y, 900 }, rpy = { 0, 0, 180 }, rail = y, retract = 400, door = name, process = params.tool or 50 }
end

local wafers = {}
for slot = 1, params.wafers or 12 do
  wafers[slot] = { name = ("W%02d"):format(slot), station = "FOUP1", slot = slot, dx = 0.3 * (slot % 4) - 0.5, rpy = { 0, 0, 25 * slot % 90 } }
end

return {
  collision = true,
  robot = { kind = "TRZY", heading = 90, rail = { min = -600, max = 600 } },
  doors = { ["A door"] = door(-505), ["B door"] = door(505) },
  grippers = { { name = "EE" }, { name = "CHUCK", on = "AL" } },
  stations = {
    FOUP1 = foup(-252.5), FOUP2 = foup(252.5),
    AL = { kind = "prealigner", at = { -700, 0, 900 }, rpy = { 0, 0, 180 }, rail = 0, retract = 388, sensor = { noise = 0.005 } },
    LLA = lock(-505, "A door"), LLB = lock(505, "B door"),
  },
  wafers = wafers,
}
