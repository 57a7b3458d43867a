-- A tool of times alone: a load port with many slots, two load locks, two robots, six modules.
local lock = function(state) return { pump = { down = 20, up = 15 }, state = state, by = { ATM = { side = "atmosphere" }, VAC = { side = "vacuum" } } } end
local stations = { LP = { slots = params.wafers, by = "ATM" }, IN = lock("atmosphere"), OUT = lock("vacuum") }
for i = 1, 6 do
  stations["PM" .. i] = { process = 150, by = "VAC" }
end
return {
  robots = {
    ATM = { kind = "timed", pick = 3, place = 3, move = 2, at = "LP" },
    VAC = { kind = "timed", pick = 4, place = 4, move = 2, at = "IN" },
  },
  stations = stations,
}
