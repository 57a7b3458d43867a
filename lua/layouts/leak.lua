-- Two stations and a gripper whose vacuum takes its time; its pads carry what friction and vacuum give.
return {
  vacuum = { build = 0.04, vent = 0.015 },
  pads = { friction = 0.4, force = 6 },
  grippers = { { name = "EE" } },
  stations = {
    A = { at = { 700, 0, 900 }, slots = 25 },
    B = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, slots = 25 },
  },
  wafers = { { name = "Wafer 1", station = "A", slot = 1 } },
}
