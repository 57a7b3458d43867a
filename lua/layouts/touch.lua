-- A station that nobody has taught yet but by eye, with a block at its door. The blade has a probe: a pin with a ball below it, whose switch
-- closes as the ball meets the block, 5 um early or late. How far the station itself is off, `waferhand run --error` says, such as
-- --error A.x=0.25.
return {
  grippers = { { name = "EE", probe = { noise = 0.005 } } },
  stations = { A = { at = { 700, 0, 900 }, block = {} } },
  wafers = { { name = "W", station = "A", slot = 1 } },
}
