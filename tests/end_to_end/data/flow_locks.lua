-- A robot in air on a rail, one in vacuum with two arms, two load locks that both may use, two modules with doors that are cleaned.
local AIR <const> = -1500 -- x of the robot in air
local doors, wafers = {}, {}
for number, name in ipairs { "PM1 door", "PM2 door", "L air", "L vacuum", "M air", "M vacuum" } do
  doors[name] = { at = { 2000, 100 * number, 0 }, box = { 10, 10, 10 }, open = { 0, 0, -20 }, seconds = 0.5 }
end
for slot = 1, params.wafers or 6 do
  wafers[slot] = { name = ("W%02d"):format(slot), station = "FROM", slot = slot }
end

local function module(name, degrees, process)
  local turn = math.rad(degrees)
  return { at = { 740 * math.cos(turn), 740 * math.sin(turn), 900 }, rpy = { 0, 0, degrees }, retract = 340, process = process,
    window = params.window or 60, clean = { after = 3, seconds = 5 }, door = name .. " door", by = { VAC = {} } }
end

local function lock(name, y) -- entered by each robot from its own side
  local aside = math.deg(math.atan(y, 730))
  return { at = { -730, y, 900 }, retract = 400, slots = params.slots or 1, pump = { down = 6, up = 4, empty_down = 3 },
    by = { ATM = { rpy = { 0, 0, 0 }, rail = y, side = "atmosphere", door = name .. " air" },
           VAC = { rpy = { 0, 0, 180 - aside }, side = "vacuum", door = name .. " vacuum" } } }
end

local function stack(y)
  return { slots = 12, at = { AIR - 700, y, 900 }, rpy = { 0, 0, 180 }, retract = 340, by = { ATM = { rail = y } } }
end

return {
  vacuum = "delayed",
  robots = {
    ATM = { kind = "TRZY", at = { AIR, 0, 0 }, heading = 90, rail = { min = -400, max = 400 } },
    VAC = { kind = "TRZ", arms = { { heading = 0 }, { heading = 180, height = 10 } } },
  },
  doors = doors,
  grippers = { { name = "AIR", on = "ATM" }, { name = "V1", on = "VAC" }, { name = "V2", on = "VAC", arm = 2 } },
  stations = { FROM = stack(-250), TO = stack(250), L = lock("L", -250), M = lock("M", 250),
    PM1 = module("PM1", -50, 20), PM2 = module("PM2", 50, 25) },
  wafers = wafers,
}
