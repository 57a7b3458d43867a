-- An arm whose links come from its URDF: one motor folds shoulder, elbow and wrist.
return {
  robot = {
    kind = "TRZ", r = { min = 260, max = 900, home = 300 }, z = { min = 500, max = 1200 },
    urdf = "folding.urdf", tool = "effector", joints = { lift = "z", turn = "theta", q3 = "fold" },
  },
  collision = true,
  grippers = { { name = "EE" } },
  stations = {
    A = { kind = "foup", at = { 760, 0, 800 }, retract = 360 },
    B = { at = { 0, 700, 800 }, rpy = { 0, 0, 90 }, slots = 4, pitch = 10, retract = 360 },
  },
  wafers = { { station = "A", slot = 1 } },
}
