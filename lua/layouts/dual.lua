-- Two blades back to back on one wrist, two stations and a prealigner.
return {
  robot = { r = { min = 50, max = 700, home = 150 } }, -- to the wrist, which is between the blades
  shapes = { arm = { reach = 0, link = 360 } },
  grippers = {
    { name = "FRONT", at = { 250, 0, 0 } },
    { name = "BACK", at = { -250, 0, 10 }, rpy = { 0, 0, 180 } },
    { name = "PA", on = "P" },
  },
  stations = {
    A = { at = { 700, 0, 900 }, slots = 5, pitch = 10 },
    B = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, slots = 5, pitch = 10, effector = "BACK" },
    P = { kind = "prealigner", at = { -600, 0, 950 }, rpy = { 0, 0, 180 } },
  },
  wafers = {
    { name = "Wafer 1", station = "A", slot = 1 },
    { name = "Wafer 2", station = "A", slot = 2, dx = 3, dy = -2 },
    { name = "Wafer 3", station = "B", slot = 3 },
  },
}
