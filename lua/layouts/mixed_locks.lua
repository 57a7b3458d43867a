-- A tool of which one robot is measured out, and the other one is times alone so far: a robot in air between a stack and two load locks
-- with doors, a robot in vacuum with two arms between the locks and two modules.
local function module(degrees, process) -- entered straight away from the robot's axis
  local angle = math.rad(degrees)
  return { at = { 740 * math.cos(angle), 740 * math.sin(angle), 900 }, rpy = { 0, 0, degrees }, retract = 340, process = process,
           window = 60, by = { VAC = {} } }
end

local function lock(y, name)            -- the robot in vacuum comes straight away from its axis
  local aside = math.deg(math.atan(y, 730))
  return { at = { -730, y, 900 }, retract = 400, pump = { down = 8, up = 6 },
           by = { ATM = { side = "atmosphere", door = name .. " air" },
                  VAC = { rpy = { 0, 0, 180 - aside }, side = "vacuum", door = name .. " vacuum" } } }
end

-- Doors stand across the ways in, and open downwards.
local function air_door(y)
  return { at = { -930, y, 905 }, box = { 12, 360, 130 }, open = { 0, 0, -260 }, seconds = 0.6 }
end
local function vacuum_door(y)
  local aside = math.deg(math.atan(y, 730))
  local way = math.rad(-aside)
  return { at = { -730 + 200 * math.cos(way), y + 200 * math.sin(way), 905 }, rpy = { 0, 0, -aside }, box = { 12, 360, 130 },
           open = { 0, 0, -260 }, seconds = 0.6 }
end

local wafers = {}
for slot = 1, params.wafers or 12 do
  wafers[slot] = { name = ("W%02d"):format(slot), station = "STACK", slot = slot }
end

return {
  collision = true,
  robots = {
    ATM = { kind = "timed", at = "STACK", pick = params.pick or 3, place = 3, move = { default = 1.5, ["L>M"] = 1 } },
    VAC = { kind = "TRZ", arms = { { heading = 0 }, { heading = 180, height = 10 } } },
  },
  doors = { ["L air"] = air_door(-250), ["M air"] = air_door(250), ["L vacuum"] = vacuum_door(-250), ["M vacuum"] = vacuum_door(250) },
  grippers = { { name = "V1", on = "VAC" }, { name = "V2", on = "VAC", arm = 2 } },
  stations = {
    STACK = { slots = 25, at = { -1600, 0, 900 }, rpy = { 0, 0, 180 }, by = { ATM = {} } },
    L = lock(-250, "L"), M = lock(250, "M"), PM1 = module(-40, 50), PM2 = module(40, 40),
  },
  wafers = wafers,
}
