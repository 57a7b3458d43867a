-- The cell of the errors: two blades, a station that nobody has taught, one wafer far aside, one FOUP as it should not be.
return {
  homed = params.homed ~= "no",
  vacuum = params.vacuum,
  grippers = {
    { name = "FRONT" },
    { name = "BACK", at = { 0, 0, 10 }, rpy = { 0, 0, 180 } },
    { name = "PA", on = "P" },
  },
  stations = {
    A = { at = { 700, 0, 900 }, slots = 5 },
    B = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, slots = 5, check_map = true },
    C = { at = { 0, -700, 900 }, rpy = { 0, 0, -90 }, slots = 5 },
    P = { kind = "prealigner", at = { -600, 0, 950 }, rpy = { 0, 0, 180 } },
    U = { at = { 5000, 0, 900 }, slots = 25, taught = false },
  },
  wafers = {
    { name = "Wafer 1", station = "A", slot = 1 },
    { name = "Wafer 2", station = "A", slot = 2 },
    { name = "Aside", station = "A", slot = 4, dx = 30, dy = 45 },
    { name = "Crossed", station = "C", slot = 2, dz = 5, rpy = { 1.91, 0, 0 } },
  },
}
