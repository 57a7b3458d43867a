-- A station that nobody has taught yet but by eye, with a beam at its door of which the same is true: motion control does not know `dx`,
-- `dy` and `late`. How far the station itself is off, `waferhand run --error` says, such as --error A.x=0.25.
return {
  grippers = { { name = "EE" } },
  stations = {
    A = {
      at = { 700, 0, 900 },
      beams = { { y = 60, delay_on = 50e-6, delay_off = 50e-6, jitter = 10e-6, late = 10e-6, dx = 0.4, dy = -0.3 } },
    },
  },
  wafers = { { name = "W", station = "A", slot = 1 } },
}
