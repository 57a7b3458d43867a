-- A station behind a post that the arm cannot pass.
return {
  collision = true,
  look_ahead = true,
  grippers = { { name = "EE" } },
  stations = {
    A = { at = { 700, 0, 900 }, slots = 5 },
    B = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, slots = 5 },
  },
  wafers = { { name = "Wafer 1", station = "A", slot = 1 }, { name = "Wafer 2", station = "B", slot = 1 } },
  obstacles = { { name = "post", box = { 40, 40, 400 }, at = { 620, 0, 900 } } },
}
