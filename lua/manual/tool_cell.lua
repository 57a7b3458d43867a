-- The cell of tutorial.md's second part: a robot in air, a robot in vacuum, two load locks, two process modules with slit valves.
local VACUUM = 600   -- x of the robot in vacuum

local function module(degrees, valve)   -- entered straight away from the axis of the robot in vacuum
  local a = math.rad(degrees)
  return { at = { VACUUM + 740 * math.cos(a), 740 * math.sin(a), 900 }, rpy = { 0, 0, degrees }, retract = 340, door = valve }
end

local function valve(degrees)           -- a wall in front of the module, which goes down to open
  local a = math.rad(degrees)
  return { at = { VACUUM + 570 * math.cos(a), 570 * math.sin(a), 905 }, rpy = { 0, 0, degrees },
           box = { 12, 420, 60 }, open = { 0, 0, -200 }, home = "open", seconds = 0.6 }
end

local function lock(y)                  -- entered by each robot from its own side
  local aside = math.deg(math.atan(y, VACUUM + 130))
  return { at = { -130, y, 900 }, retract = 400, by = { ATM = {}, VAC = { rpy = { 0, 0, 180 - aside } } } }
end

local wafers = {}
for slot = 1, 6 do
  wafers[slot] = { name = "W" .. slot, station = "LP", slot = slot }
end

return {
  collision = params.collision,
  robots = {
    ATM = { kind = "TRZY", at = { -900, 0, 0 } },
    VAC = { kind = "TRZ", at = { VACUUM, 0, 0 }, arms = { { heading = 0 }, { heading = 180, height = 10 } } },
  },
  grippers = { { name = "AIR", on = "ATM" }, { name = "NEW", on = "VAC" }, { name = "DONE", on = "VAC", arm = 2 } },
  stations = {
    LP = { kind = "foup", at = { -1600, 0, 900 }, rpy = { 0, 0, 180 }, retract = 340 },
    IN = lock(-250), OUT = lock(250),
    PM1 = module(-35, "V1"), PM2 = module(35, "V2"),
  },
  doors = { V1 = valve(-35), V2 = valve(35) },
  wafers = wafers,
}
