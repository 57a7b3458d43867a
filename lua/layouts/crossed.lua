-- A FOUP as a careless hand left it: slots 4 and 5 share one wafer, slot 8 holds two.
return {
  grippers = { { name = "EE" } },
  stations = {
    A = { at = { 700, 0, 900 }, slots = 10, pitch = 10 },
    B = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, slots = 10, pitch = 10, check_map = true },
  },
  wafers = {
    { name = "Wafer 1", station = "A", slot = 1 },
    { name = "Wafer 2", station = "A", slot = 2 },
    { name = "Crossed", station = "A", slot = 4, dz = 5, rpy = { 1.91, 0, 0 } },
    { name = "Lower", station = "A", slot = 8 },
    { name = "Upper", station = "A", slot = 9, dz = -9.2 },
    { name = "Wafer 10", station = "A", slot = 10 },
  },
}
