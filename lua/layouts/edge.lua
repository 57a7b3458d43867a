-- An EFEM with an edge grip and an aligner: wafers of true diameters of their own, beside the middle of their slots, their notches anywhere.
return {
  robot = { z = { min = 700 } },
  grippers = { { name = "EE", grip = "edge" }, { name = "PA", on = "P" } },
  stations = {
    A = { kind = "foup", at = { 700, 0, 900 }, retract = 320 },
    B = { kind = "foup", at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, retract = 320 },
    P = { kind = "prealigner", at = { -620, 0, 950 }, rpy = { 0, 0, 180 }, sensor = { noise = 0.005 } },
  },
  wafers = {
    { name = "W01", station = "A", slot = 1, dx = 0.8, dy = -1.2, rpy = { 0, 0, 71 }, rim = { diameter = 300.2 } },
    { name = "W02", station = "A", slot = 2, dx = -1.1, dy = 0.4, rpy = { 0, 0, 30 }, rim = { diameter = 299.9 } },
    { name = "W03", station = "A", slot = 3, dx = -3, dy = 1.25, rpy = { 0, 0, -140 } },
  },
}
