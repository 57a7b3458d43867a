-- A tool: an atmospheric robot on a rail serves two FOUPs and two load locks, a robot in vacuum with two arms takes over
-- from there and serves four process stations.
local VACUUM = 600                       -- x of the robot in vacuum
local function around(degrees, distance) -- a station that the robot in vacuum enters straight away from its axis
  local angle = math.rad(degrees)
  return { at = { VACUUM + distance * math.cos(angle), distance * math.sin(angle), 900 }, rpy = { 0, 0, degrees },
           retract = 340, by = { VAC = {} } }
end
local function lock(y)                   -- entered by each robot from its own side
  local aside = math.deg(math.atan(y, VACUUM + 130))
  return { at = { -130, y, 900 }, retract = 400,
           by = { ATM = { rail = y }, VAC = { rpy = { 0, 0, 180 - aside } } } }
end
local function foup(y)
  return { kind = "foup", at = { -1600, y, 900 }, rpy = { 0, 0, 180 }, retract = 340, by = { ATM = { rail = y } } }
end

local wafers = {}
for slot = 1, 25 do
  wafers[slot] = { name = ("W%02d"):format(slot), station = "FROM", slot = slot }
end

return {
  collision = true,
  robots = {
    ATM = { kind = "TRZY", at = { -900, 0, 0 }, heading = 90, rail = { min = -400, max = 400 } },
    VAC = { kind = "TRZ", at = { VACUUM, 0, 0 }, arms = { { heading = 0 }, { heading = 180, height = 10 } } },
  },
  grippers = {
    { name = "ATM blade", on = "ATM" },
    { name = "VAC 1", on = "VAC" },
    { name = "VAC 2", on = "VAC", arm = 2 },
  },
  stations = {
    FROM = foup(-252.5), TO = foup(252.5),
    IN = lock(-250), OUT = lock(250),
    PM1 = around(-75, 740), PM2 = around(-25, 740), PM3 = around(25, 740), PM4 = around(75, 740),
  },
  wafers = wafers,
}
