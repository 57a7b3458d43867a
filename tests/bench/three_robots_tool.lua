-- A tool with three robots: one in air between FOUPs and two load locks, two in vacuum with two arms each, which share a buffer and have
-- three modules each. Doors, pumps, cleans, vacuum that builds up, wafers that settle and may slip: all is looked at.
local FIRST <const>, SECOND <const>, REACH <const> = 600, 2080, 740
local function around(x, degrees, by, process)
  local angle = math.rad(degrees)
  return { at = { x + REACH * math.cos(angle), REACH * math.sin(angle), 900 }, rpy = { 0, 0, degrees }, retract = 340,
           process = process, window = 600, clean = { after = 5, seconds = 5 }, by = { [by] = {} } }
end
local function aside(y)
  return math.deg(math.atan(y, FIRST + 130))
end
local function lock(y, name)
  return { at = { -130, y, 900 }, retract = 400, pump = { down = 4, up = 3 },
           by = { ATM = { rail = y, side = "atmosphere", door = name .. " air" },
                  V1 = { rpy = { 0, 0, 180 - aside(y) }, side = "vacuum", door = name .. " vacuum" } } }
end
local function air_door(y)
  return { at = { -330, y, 905 }, box = { 12, 360, 130 }, open = { 0, 0, -260 }, seconds = 0.3 }
end
local function vacuum_door(y)
  local way = math.rad(-aside(y))
  return { at = { -130 + 200 * math.cos(way), y + 200 * math.sin(way), 905 }, rpy = { 0, 0, -aside(y) }, box = { 12, 360, 130 },
           open = { 0, 0, -260 }, seconds = 0.3 }
end
local function foup(y)
  return { kind = "foup", at = { -1600, y, 900 }, rpy = { 0, 0, 180 }, retract = 340, by = { ATM = { rail = y } } }
end
local function buffer(y, first)
  local angle = math.deg(math.atan(y, REACH))
  return { at = { FIRST + REACH, y, 900 }, retract = 340, by = { V1 = { rpy = { 0, 0, angle } }, V2 = { rpy = { 0, 0, 180 - angle } } } }
end

local wafers = {}
for slot = 1, 25 do
  wafers[slot] = { name = ("W%02d"):format(slot), station = "FROM", slot = slot }
end
local arms = { { heading = 0 }, { heading = 180, height = 10 } }

return {
  collision = true, settle = true, seat = true, vacuum = "delayed", check = "swept", look_ahead = params.ahead == 1,
  pads = { friction = 0.6, force = 12 },
  robots = {
    ATM = { kind = "TRZY", at = { -900, 0, 0 }, heading = 90, rail = { min = -400, max = 400 } },
    V1 = { kind = "TRZ", at = { FIRST, 0, 0 }, arms = arms },
    V2 = { kind = "TRZ", at = { SECOND, 0, 0 }, heading = 180, arms = arms },
  },
  doors = { ["L air"] = air_door(-250), ["M air"] = air_door(250), ["L vacuum"] = vacuum_door(-250), ["M vacuum"] = vacuum_door(250) },
  grippers = {
    { name = "air", on = "ATM" }, { name = "V1 1", on = "V1" }, { name = "V1 2", on = "V1", arm = 2 },
    { name = "V2 1", on = "V2" }, { name = "V2 2", on = "V2", arm = 2 },
  },
  stations = {
    FROM = foup(-252.5), TO = foup(252.5), L = lock(-250, "L"), M = lock(250, "M"),
    B = buffer(-200), C = buffer(200),
    P1 = around(FIRST, -70, "V1", 20), P2 = around(FIRST, 70, "V1", 20),
    Q1 = around(SECOND, -70, "V2", 30), Q2 = around(SECOND, 0, "V2", 30), Q3 = around(SECOND, 70, "V2", 30),
  },
  wafers = wafers,
}
