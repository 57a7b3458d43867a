-- A robot whose column tilts takes a wafer from a station that is tilted by 1.5 degrees, in the wafer's own plane.
return {
  robot = { kind = "TRZY", tilt = { min = -3, max = 3 } },
  grippers = { { name = "EE" } },
  stations = {
    A = { at = { 700, 250, 900 }, rpy = { 1.5, 0, 0 }, slots = 25, pitch = 10 },
    B = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, slots = 25, pitch = 10 },
  },
  wafers = { { name = "Wafer 1", station = "A", slot = 1 } },
}
