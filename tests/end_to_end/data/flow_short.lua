-- A short flow of robots of both kinds, for runs in several processes: few slices, a load lock that pumps, one module.
return {
  vacuum = "delayed",
  robots = { ATM = { kind = "timed", pick = 0.3, place = 0.3, move = 0.2 }, VAC = { kind = "TRZ" } },
  grippers = { { name = "blade", on = "VAC" } },
  stations = {
    STACK = { slots = 5, at = { -1600, 0, 900 }, by = { ATM = {} } },
    L = { at = { -730, 0, 900 }, retract = 400, pump = { down = 0.4, up = 0.3 },
          by = { ATM = { side = "atmosphere" }, VAC = { rpy = { 0, 0, 180 }, side = "vacuum" } } },
    PM = { at = { 740, 0, 900 }, retract = 340, process = 0.5, window = 30, by = { VAC = {} } },
  },
  wafers = { { name = "W1", station = "STACK", slot = 1 }, { name = "W2", station = "STACK", slot = 2, dx = 0.6, dy = -0.3 } },
  study = { timing = { process = 0.2 }, placement = { dx = 0.2, dy = 0.2 } },
}
