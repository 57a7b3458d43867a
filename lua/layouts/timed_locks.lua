-- A tool of times alone: two load ports, an aligner, two load locks, a vacuum robot with two arms, four modules that are cleaned.
local lock = { pump = { down = 20, up = 15, empty_down = 12, empty_up = 9 }, by = { ATM = { side = "atmosphere" }, VAC = { side = "vacuum" } } }
local module = { process = 240, window = 120, clean = { after = 10, seconds = 60 }, by = "VAC" }

return {
  robots = {
    ATM = { kind = "timed", pick = 3, place = 3, move = 2, at = "LP1" },
    VAC = { kind = "timed", arms = 2, pick = 4, place = 4, move = 2, swap = 9, at = "PM1" },
  },
  stations = {
    LP1 = { kind = "load_port", by = "ATM" },
    LP2 = { kind = "load_port", by = "ATM" },
    AL = { process = 5, by = "ATM" },
    LLA = lock,
    LLB = lock,
    PM1 = module,
    PM2 = module,
    PM3 = module,
    PM4 = module,
  },
}
