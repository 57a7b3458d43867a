-- The cell of tutorial.md: two load ports, an aligner and a load lock.
return {
  collision = params.collision,
  tolerance = { projz = 0.5, projxy = 2, planar = 0.999 },
  grippers = { { name = "EE" }, { name = "AL", on = "AL" } },
  stations = {
    LP1 = { kind = "foup", retract = 320, at = { 0, 700, 900 }, rpy = { 0, 0, 90 } },
    LP2 = { kind = "foup", retract = 320, at = { 0, -700, 900 }, rpy = { 0, 0, -90 } },
    AL = { kind = "prealigner", at = { -650, 0, 950 }, rpy = { 0, 0, 180 } },
    LL = { retract = 320, at = { 720, 0, 900 }, slots = 2 },
  },
  wafers = {
    { name = "W1", station = "LP1", slot = 1 },
    { name = "W2", station = "LP1", slot = 2 },
    { name = "W3", station = "LP1", slot = 3 },
  },
}
