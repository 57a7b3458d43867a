-- Two robots whose links come from URDFs, with a load lock between them: one with one arm, one with two.
local arm = { min = 260, max = 900, home = 300 }
local lift = { min = 500, max = 1200 }

return {
  robots = {
    ATM = {
      kind = "TRZ", at = { -900, 0, 0 }, heading = 180, r = arm, z = lift,
      urdf = "folding.urdf", tool = "effector", joints = { lift = "z", turn = "theta", q3 = "fold" },
    },
    VAC = {
      kind = "TRZ", at = { 600, 0, 0 }, r = arm, z = lift, arms = { {}, { heading = 180, height = 10 } },
      urdf = "two_arms.urdf", tool = "effector", tool2 = "effector 2",
      joints = { lift = "z", turn = "theta", fold = "fold", fold2 = "fold2" },
    },
  },
  collision = true, look_ahead = true,
  grippers = {
    { name = "ATM blade", on = "ATM" },
    { name = "VAC lower", on = "VAC", arm = 1 }, { name = "VAC upper", on = "VAC", arm = 2 },
  },
  stations = {
    FROM = { at = { -1650, 0, 900 }, rpy = { 0, 0, 180 }, slots = 4, retract = 360 },
    LL = { at = { -150, 0, 900 }, retract = 360, by = { ATM = {}, VAC = { rpy = { 0, 0, 180 } } } },
    PM = { at = { 1350, 0, 900 }, retract = 360 },
  },
  wafers = { { name = "W1", station = "FROM", slot = 1 }, { name = "W2", station = "FROM", slot = 2 } },
}
