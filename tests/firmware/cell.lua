-- The cell of bench.h as a layout, for a board in the loop: two stacks of three slots, and a robot as fast as controller.c is.
return {
  settle = true,
  collision = true,
  vacuum = "delayed",
  robot = {
    theta = { speed = 181 },
    r = { min = 250, max = 750, home = 300, speed = 1001 },
    z = { min = 800, max = 1000, home = 850, speed = 301 },
    yaw = { speed = 181 },
  },
  grippers = { { name = "blade" } },
  stations = {
    A = { at = { 700, 0, 900 }, slots = 3, pitch = 10 },
    B = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, slots = 3, pitch = 10 },
  },
  wafers = {
    { name = "Wafer 1", station = "A", slot = 1 },
    { name = "Wafer 2", station = "B", slot = 2 },
  },
}
