-- A FOUP whose wafers lie aside, as a sensor of the tool would tell, and a robot that may go after them.
return {
  seat = true,
  settle = true,
  corrections = { x = 8, y = 8, turn = 10 },
  grippers = { { name = "EE" } },
  stations = {
    A = { at = { 700, 0, 900 }, slots = 5 },
    B = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, slots = 5 },
  },
  wafers = {
    { name = "W01", station = "A", slot = 1, dx = 6.25, dy = -3.5 },
    { name = "W02", station = "A", slot = 2, rpy = { 0, 0, 8 } },
    { name = "W03", station = "A", slot = 3, dx = 1 },
  },
}
