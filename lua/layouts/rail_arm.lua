-- An arm that folds, on a rail, in a laboratory: four nests of one wafer each.
return {
  robot = {
    kind = "SCARA", links = { 302, 289 }, elbow = "right", rail = { min = 0, max = 1500 }, z = { min = 0, max = 750, home = 300 },
    forearm = { min = -165, max = 165 },
  },
  collision = true,
  grippers = { { name = "hand", at = { 80, 0, 0 } } },
  stations = {
    N1 = { at = { 250, 560, 200 }, rpy = { 0, 0, 90 }, retract = 330 },
    N2 = { at = { -150, 560, 200 }, rpy = { 0, 0, 90 }, retract = 330 },
    N3 = { at = { 1450, 560, 200 }, rpy = { 0, 0, 90 }, retract = 330, rail = 1200 },
    N4 = { at = { 0, -580, 250 }, rpy = { 0, 0, -90 }, retract = 330 },
  },
  wafers = { { name = "W1", station = "N1", slot = 1 }, { name = "W2", station = "N4", slot = 1 } },
}
