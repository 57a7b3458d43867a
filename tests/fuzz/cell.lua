-- The cell of the fuzz targets for scripts and lines: small and with long slices, for speed.
return {
  check = "swept",
  slice = 0.05,
  near = { projz = 20 },
  grippers = { { name = "EE" }, { name = "E 2" }, { name = "PA", on = "P" } },
  stations = {
    A = { at = { 700, 0, 900 }, rpy = { 1.5, 0, 0 }, slots = 3 },
    ["B 2"] = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, pickup_speed = 100 },
    P = { kind = "prealigner", at = { -600, 0, 950 }, rpy = { 0, 0, 180 }, release = 0.25, timeout = 0.05 },
  },
  wafers = {
    { name = "W1", station = "A", slot = 1 },
    { name = 'W "2"', station = "A", slot = 3, dx = 60 },
    { name = "W3", station = "B 2", slot = 1, rpy = { 0, 5, 0 } },
  },
}
