-- Limits by which times come out round: 300 mm of R take 1 s, 90 degrees of theta 2 s, strokes of 6 and 3 mm 0.4 and 0.25 s.
return {
  tolerance = { projz = 0.51, projxy = 50, planar = 0.99 },
  seat = true,
  study = params.study and { placement = { dx = 0.01 } },
  robot = {
    kind = "TRZY",
    theta = { speed = 1000, acceleration = 1000, jerk = 360 },
    r = { home = 400, speed = 10000, acceleration = 10000, jerk = 9600 },
    z = { home = 897, speed = 400, acceleration = 400, jerk = 8000 },
  },
  grippers = { { name = "EE" }, { name = "PA", on = "P" } },
  stations = {
    A = { at = { 700, 0, 900 }, slots = 3, vacuum_delay = 0.1 },
    B = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, slots = 3, vacuum_delay = 0.1, counts = params.b ~= "lock" },
    C = { at = { 300, -350, 900 }, retract = 600 },
    P = { kind = "prealigner", at = { -700, 0, 900 }, rpy = { 0, 0, 180 } },
  },
  wafers = {
    { name = "first", station = "A", slot = 1 },
    { name = "second", station = "A", slot = 2 },
    { name = "third", station = "A", slot = 3 },
  },
}
