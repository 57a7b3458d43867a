-- Two stations along a rail with a post between them: the arm passes it by points.
return {
  collision = true, look_ahead = true,
  robot = { rail = {}, flip = {}, tilt = {} },
  grippers = { { name = "EE" } },
  stations = {
    A = { at = { -500, 700, 900 }, rpy = { 0, 0, 90 }, rail = -500, via = { { r = 320, rail = -300, blend = 60 } } },
    B = { at = { 500, 700, 900 }, rpy = { 0, 0, 90 }, rail = 500, via = { { r = 330, rail = 200, z = 1000, blend = 80 } } },
  },
  wafers = { { name = "W1", station = "A", slot = 1 } },
}
