-- The cell of the paper's two runs: two stations, a prealigner, two wafers.
return {
  wafer = { diameter = 300, thickness = 0.775 },
  tolerance = "paper",
  check = "sampled",
  slice = 0.001,
  robot = { kind = "TRZY" },
  grippers = {
    { name = "EE", on = "robot", valve = "eeVacValve[0]" },
    { name = "PA", on = "P", valve = "paVacValve[0]" },
  },
  stations = {
    A = { at = { 700, 0, 900 }, rpy = { 1.5, 0, 0 }, slots = 25, pitch = 10, stroke = 6, offset = 3 },
    B = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, slots = 25, pitch = 10, stroke = 6, offset = 3 },
    P = { kind = "prealigner", at = { -600, 0, 950 }, rpy = { 0, 0, 180 }, stroke = 6, offset = 3 },
  },
  wafers = {
    { name = "Wafer 1", station = "A", slot = 1 },
    { name = "Wafer 2", station = "B", slot = 1, dx = 13.794, dy = 7.2385 },
  },
}
