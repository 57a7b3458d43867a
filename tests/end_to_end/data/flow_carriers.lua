-- Two load ports with real steps, a module that takes time and a buffer.
local function port(y, begins)
  return {
    kind = "load_port", by = params.mixed and { R = {}, T = {} } or nil, slots = 4, at = { 0, y, 900 }, rpy = { 0, 0, y > 0 and 90 or -90 }, retract = 360,
    port = { place = 0.5, clamp = 0.3, dock = 0.5, open = 1, map = 0.7, e84 = params.e84 and { t3 = 1, t4 = 0.5, tp3 = 4 } or nil, state = begins },
  }
end
-- With `mixed` a robot that is times alone stands beside the other one.
local by = params.mixed and { R = {}, T = {} } or nil
local recipe = params.recipe and "oxide" or nil

return {
  collision = params.collision,
  robots = by and { R = {}, T = { kind = "timed", pick = 1, place = 1, move = 1, at = "LP2" } },
  grippers = { { name = "EE", on = by and "R" or nil } },
  stations = {
    LP1 = port(760),
    LP2 = port(-760, params.docked and "docked" or nil),
    PM = { by = by, at = { 700, 0, 900 }, slots = 2, retract = 360, process = { default = 3, oxide = 5, nitride = 1 }, clean = { after = { default = 40, oxide = 2 }, seconds = 2 } },
  },
  carriers = { C1 = { wafers = 2, at = "LP1" }, C2 = { wafers = { 1, 2, 4 }, at = params.docked and "LP2" or nil, recipe = recipe }, C3 = { wafers = 2 }, EMPTY = {} },
}
