-- A tool: a robot in air on a rail serves two FOUPs and two load locks with doors; a robot in vacuum with two arms takes over from
-- there and serves four modules, of which each is cleaned after three wafers.
local VACUUM <const> = 600               -- x of the robot in vacuum
local function module(degrees, process)  -- entered straight away from that robot's axis
  local angle = math.rad(degrees)
  return { at = { VACUUM + 740 * math.cos(angle), 740 * math.sin(angle), 900 }, rpy = { 0, 0, degrees }, retract = 340,
           process = process, window = params.window or 60, clean = { after = 3, seconds = 15 }, by = { VAC = {} } }
end

local function aside(y)
  return math.deg(math.atan(y, VACUUM + 130))
end
local function lock(y, name)             -- entered by each robot from its own side
  return { at = { -130, y, 900 }, retract = 400, pump = { down = 8, up = 6 },
           by = { ATM = { rail = y, side = "atmosphere", door = name .. " air" },
                  VAC = { rpy = { 0, 0, 180 - aside(y) }, side = "vacuum", door = name .. " vacuum" } } }
end

-- Doors stand across the ways in, and open downwards.
local function air_door(y)
  return { at = { -330, y, 905 }, box = { 12, 360, 130 }, open = { 0, 0, -260 }, seconds = 0.6 }
end
local function vacuum_door(y)
  local way = math.rad(-aside(y))
  return { at = { -130 + 200 * math.cos(way), y + 200 * math.sin(way), 905 }, rpy = { 0, 0, -aside(y) }, box = { 12, 360, 130 },
           open = { 0, 0, -260 }, seconds = 0.6 }
end
local function foup(y)
  return { kind = "foup", at = { -1600, y, 900 }, rpy = { 0, 0, 180 }, retract = 340, by = { ATM = { rail = y } } }
end

local wafers = {}
for slot = 1, params.wafers or 25 do
  wafers[slot] = { name = ("W%02d"):format(slot), station = "FROM", slot = slot }
end

return {
  collision = true,
  robots = {
    ATM = { kind = "TRZY", at = { -900, 0, 0 }, heading = 90, rail = { min = -400, max = 400 } },
    VAC = { kind = "TRZ", at = { VACUUM, 0, 0 }, arms = { { heading = 0 }, { heading = 180, height = 10 } } },
  },
  doors = { ["L air"] = air_door(-250), ["M air"] = air_door(250), ["L vacuum"] = vacuum_door(-250), ["M vacuum"] = vacuum_door(250) },
  grippers = { { name = "ATM blade", on = "ATM" }, { name = "VAC 1", on = "VAC" }, { name = "VAC 2", on = "VAC", arm = 2 } },
  stations = {
    FROM = foup(-252.5), TO = foup(252.5), L = lock(-250, "L"), M = lock(250, "M"),
    PM1 = module(-75, 60), PM2 = module(-25, 60), PM3 = module(25, 45), PM4 = module(75, 45),
  },
  wafers = wafers,
}
