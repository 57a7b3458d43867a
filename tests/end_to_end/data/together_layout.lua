-- A chuck on a stage, with pins that its station names; wafers settle, and what is ahead is looked at.
return {
  settle = true, collision = true, look_ahead = true,
  grippers = {
    { name = "EE" },
    { name = "PA", on = "P", stage = { travel = 5 } },
    { name = "PINS", on = "P", pins = { up = 5, down = 3 } },
  },
  stations = {
    A = { kind = "foup", at = { 700, 0, 900 } },
    P = { kind = "prealigner", at = { -620, 0, 950 }, rpy = { 0, 0, 180 }, sensor = {}, pins = "PINS" },
  },
  wafers = {
    { name = "W01", station = "A", slot = 1, dx = 1.5, dy = -0.8 },
    { name = "W02", station = "A", slot = 2 },
  },
}
