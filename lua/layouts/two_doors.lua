-- A load lock with beams at both of its doors: the atmospheric robot passes the first two, the robot in vacuum the others, and so each
-- is told by itself how its wafer lies, and teaches itself the load lock. How far beside it was taught it `waferhand run --error` says,
-- such as --error LL.ATM.x=0.2.
return {
  robots = { ATM = { kind = "TRZY", at = { -700, 0, 0 } }, VAC = { kind = "TRZY", at = { 700, 0, 0 } } },
  grippers = { { name = "ATM blade", on = "ATM", probe = {} }, { name = "VAC blade", on = "VAC" } },
  stations = {
    A = { at = { -700, 700, 900 }, rpy = { 0, 0, 90 }, slots = 3, by = { ATM = {} } },
    LL = {
      at = { 0, 0, 900 }, slots = 2, by = { ATM = {}, VAC = { rpy = { 0, 0, 180 } } }, centre = true, block = {},
      beams = { { y = 60 }, { y = -110 }, { x = 150, y = 70 }, { x = 150, y = -120 } },
    },
    PM = { at = { 1400, 0, 900 }, by = { VAC = {} }, centre = true, beams = { { y = 60 }, { y = -110 } } },
  },
  wafers = {
    { name = "W1", station = "A", slot = 1, dx = 1.5, dy = -0.8 }, { name = "W2", station = "A", slot = 2, dx = -0.7, dy = 0.9 },
    { name = "W3", station = "LL", slot = 1 },
  },
}
