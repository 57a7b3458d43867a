-- A cassette of 200 mm wafers, two of which lie askew; collisions are checked.
return {
  wafer = { diameter = 200 },
  tolerance = "strict",
  check = "swept",
  seat = true,
  settle = true,
  collision = true,
  grippers = { { name = "EE" } },
  stations = {
    C = { at = { 700, 0, 900 }, slots = 25, stroke = 4, offset = 1.9 },
  },
  wafers = {
    { name = "W01", station = "C", slot = 1 },
    { name = "W02", station = "C", slot = 2, rpy = { 0, -0.3, 0 } },
    { name = "W04", station = "C", slot = 4, rpy = { 0, -0.3, 0 } },
  },
  clearance = { blade_wafer_above = 0.5, blade_wafer_below = 0.5 },
}
