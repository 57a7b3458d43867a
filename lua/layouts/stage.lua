-- A prealigner whose chuck is on an XY stage, with pins that lift a wafer off it, and three wafers that lie beside their slots' middles.
return {
  grippers = {
    { name = "EE" },
    { name = "PA", on = "P", stage = { travel = 5 } },
    { name = "PINS", on = "P", pins = { up = 5, down = 3 } },
  },
  stations = {
    A = { kind = "foup", at = { 700, 0, 900 } },
    P = { kind = "prealigner", at = { -620, 0, 950 }, rpy = { 0, 0, 180 }, sensor = { noise = 0.005 } },
  },
  wafers = {
    { name = "W01", station = "A", slot = 1, dx = 1.5, dy = -0.8, rpy = { 0, 0, 37 } },
    { name = "W02", station = "A", slot = 2, dx = -2.1, dy = 0.4, rpy = { 0, 0, -120 } },
    { name = "W03", station = "A", slot = 3, dx = 0.3, dy = 2.6, rpy = { 0, 0, 179 } },
  },
}
