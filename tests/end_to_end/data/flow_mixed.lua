-- A robot in air that is times alone, and one with axes in vacuum: two load locks with doors on both sides, two modules.
local doors, wafers = {}, {}
for number, name in ipairs { "PM1 door", "PM2 door", "L air", "L vacuum", "M air", "M vacuum" } do
  doors[name] = { at = { 2000, 100 * number, 0 }, box = { 10, 10, 10 }, open = { 0, 0, -20 }, seconds = 0.5 }
end
for slot = 1, params.wafers or 6 do
  wafers[slot] = { name = ("W%02d"):format(slot), station = "FROM", slot = slot, dx = slot == 1 and params.dx or nil }
end

local function module(name, degrees, process)
  local turn = math.rad(degrees)
  return { at = { 740 * math.cos(turn), 740 * math.sin(turn), 900 }, rpy = { 0, 0, degrees }, retract = 340, process = process,
    window = params.window or 60, clean = { after = 3, seconds = 5 }, door = name .. " door", by = { VAC = {} } }
end

local function lock(name, y)
  local aside = math.deg(math.atan(y, 730))
  return { at = { -730, y, 900 }, retract = 400, slots = params.slots or 1, pump = { down = 6, up = 4, empty_down = 3 },
    by = { ATM = { side = "atmosphere", door = name .. " air" },
           VAC = { rpy = { 0, 0, 180 - aside }, side = "vacuum", door = name .. " vacuum" } } }
end

local function stack(y)
  return { slots = 12, at = { -2200, y, 900 }, rpy = { 0, 0, 180 }, by = { ATM = {} } }
end

return {
  vacuum = "delayed",
  robots = {
    ATM = { kind = "timed", arms = params.arms, at = "FROM", pick = 2.0004, place = 3, move = { default = 1, ["FROM>L"] = 1.5 } },
    VAC = { kind = "TRZ", arms = { { heading = 0 }, { heading = 180, height = 10 } } },
  },
  doors = doors,
  grippers = { { name = "V1", on = "VAC" }, { name = "V2", on = "VAC", arm = 2 } },
  stations = { FROM = stack(-250), TO = stack(250), L = lock("L", -250), M = lock("M", 250),
    PM1 = module("PM1", -50, 20), PM2 = module("PM2", 50, 25) },
  wafers = wafers,
}
