-- Wafers lie face up in A and face down in D: the wrist turns them over on the way, its vacuum holds them from above.
return {
  collision = true,
  look_ahead = true,
  robot = { flip = {} },
  pads = { friction = 0.5, force = params.force or 10 },
  grippers = { { name = "EE" } },
  stations = {
    A = { kind = "foup", at = { 850, 0, 900 }, retract = 450, face = "up" },
    D = { kind = "foup", at = { 0, 850, 900 }, rpy = { 0, 0, 90 }, retract = 450, face = "down" },
  },
  wafers = {
    { name = "W01", station = "A", slot = 1, dx = 1.5, dy = -0.8 },
    { name = "W02", station = "A", slot = 2 },
  },
}
