-- An EFEM with one arm and two prealigners, which turn wafers while the arm brings the next ones.
return {
  grippers = {
    { name = "EE", on = "robot" },
    { name = "P1", on = "P" },
    { name = "Q1", on = "Q" },
  },
  stations = {
    A = { kind = "foup", at = { 700, 0, 900 }, retract = 320 },
    B = { kind = "foup", at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, retract = 320, counts = true },
    P = { kind = "prealigner", at = { -620, 0, 950 }, rpy = { 0, 0, 180 }, sensor = { noise = 0.005 } },
    Q = { kind = "prealigner", at = { 0, -620, 950 }, rpy = { 0, 0, -90 }, sensor = { noise = 0.005 } },
  },
  wafers = {
    { name = "W01", station = "A", slot = 1, dx = 1.5, dy = -0.8, rpy = { 0, 0, 37 } },
    { name = "W02", station = "A", slot = 2, dx = -0.6, dy = 0.9, rpy = { 0, 0, -110 } },
    { name = "W03", station = "A", slot = 3, dx = 0.2, dy = 1.1, rpy = { 0, 0, 160 } },
    { name = "W04", station = "A", slot = 4, dx = -1.2, dy = -0.3, rpy = { 0, 0, 5 } },
  },
}
