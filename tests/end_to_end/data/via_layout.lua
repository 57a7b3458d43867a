-- A wall stands between two stations: the arm goes over it by points that the stations name.
return {
  collision = true, look_ahead = true,
  grippers = { { name = "EE" } },
  stations = {
    A = { at = { 700, 0, 900 }, slots = 3, via = { { r = 320, blend = 120 }, { r = 320, z = 1100, blend = 80 } } },
    B = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, slots = 3, via = params.straight and {} or { { theta = 60, r = 330, z = 1100, blend = 100 } } },
    C = { at = { -700, 0, 900 }, rpy = { 0, 0, 180 }, slots = 3 },
  },
  wafers = { { name = "W1", station = "A", slot = 1 } },
}
