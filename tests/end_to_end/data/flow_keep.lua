-- Two robots with two arms each, one of times alone, one with axes. The wafers' names are not those of their slots.
return {
  robots = { ATM = { kind = "timed", arms = 2, pick = 3, place = 3, move = 1.5, at = "STACK" }, VAC = { kind = "TRZ", arms = { { heading = 0 }, { heading = 180, height = 10 } } } },
  grippers = { { name = "NEW", on = "VAC" }, { name = "DONE", on = "VAC", arm = 2 } },
  stations = {
    STACK = { slots = 3, at = { -1600, 0, 900 }, by = { ATM = {} } },
    L = { at = { -730, 0, 900 }, retract = 400, pump = { down = 8, up = 6 }, by = { ATM = { side = "atmosphere" }, VAC = { rpy = { 0, 0, 180 }, side = "vacuum" } } },
    PM = { at = { 740, 0, 900 }, retract = 340, process = 20, by = { VAC = {} } },
    PM2 = { at = { 0, 740, 900 }, rpy = { 0, 0, 90 }, retract = 340, process = 20, by = { VAC = {} } },
  },
  wafers = { { name = "W3", station = "STACK", slot = 1 }, { name = "X", station = "STACK", slot = 2 }, { name = "W1", station = "STACK", slot = 3 } },
}
