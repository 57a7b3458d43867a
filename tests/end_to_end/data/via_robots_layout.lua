-- Two robots and a load lock between them: each goes to stations by points of its own.
return {
  collision = true, look_ahead = true,
  robots = {
    ATM = { kind = "TRZY", at = { -700, 0, 0 } },
    VAC = { kind = "TRZ", at = { 700, 0, 0 }, heading = 180 },
  },
  grippers = { { name = "ATM blade", on = "ATM" }, { name = "VAC blade", on = "VAC" } },
  stations = {
    LL = { at = { 0, 0, 900 }, by = {
      ATM = { via = { { r = 320, z = 1000, blend = 60 } } },
      VAC = { rpy = { 0, 0, 180 }, via = { { theta = -10, r = 330, z = 1050, blend = 70 }, { r = 340, blend = 0 } } },
    } },
    A = { at = { -700, 700, 900 }, rpy = { 0, 0, 90 }, slots = 2, by = { ATM = { via = { { theta = 60, r = 330, z = 1100 } } } } },
    P = { at = { 700, 700, 900 }, rpy = { 0, 0, 90 }, by = { VAC = {} } },
  },
  study = { placement = { dx = 0.05, dy = 0.05 } },
  wafers = { { name = "W1", station = "A", slot = 1 }, { name = "W2", station = "P", slot = 1 } },
}
