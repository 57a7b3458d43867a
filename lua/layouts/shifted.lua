-- One station with a wafer pushed so far aside that the paper's tolerance does not allow a pick.
return {
  tolerance = "paper",
  grippers = { { name = "EE" } },
  stations = {
    A = { at = { 700, 0, 900 }, slots = 25 },
  },
  wafers = {
    { name = "Wafer 1", station = "A", slot = 1, dx = 30, dy = 45 },
    { name = "Wafer 2", station = "A", slot = 3 },
  },
}
