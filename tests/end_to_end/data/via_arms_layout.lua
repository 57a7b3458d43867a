-- A robot with an elbow, with two wrists or with two arms, between stations that it goes to by points of theirs.
local kind = params.robot
local robots = {
  scara = { kind = "SCARA", links = { 350, 350 } },
  wrists = { kind = "SCARA", links = { 350, 350 }, wrists = { { heading = 0 }, { heading = 90, height = 30 } } },
  arms = { kind = "TRZ", arms = { { heading = 0 }, { heading = 180, height = 10 } }, theta = { min = -720, max = 720 } },
}
local grippers = {
  scara = { { name = "LO", at = { 250, 0, 0 } } },
  wrists = { { name = "LO", wrist = 1, at = { 250, 0, 0 } }, { name = "UP", wrist = 2, at = { 250, 0, 0 } } },
  arms = { { name = "LO", arm = 1 }, { name = "UP", arm = 2 } },
}
local is_polar = kind == "arms"

return {
  collision = true, look_ahead = true,
  robot = robots[kind],
  grippers = grippers[kind],
  stations = {
    -- Folded, the elbow points aside, and the wrist is before the station.
    A = { at = { 700, 0, 900 }, slots = 3, retract = 320,
          via = { is_polar and { r = 330, z = 1000, blend = 60 } or { theta = 75, forearm = -150, yaw = 75, z = 1000, blend = 60 } } },
    B = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, slots = 3, retract = 320,
          via = { is_polar and { theta = 70, r = 340, z = 1060, blend = 50 } or { theta = 145, forearm = -150, z = 1060, blend = 50 } } },
    C = { at = { -700, 0, 900 }, rpy = { 0, 0, 180 }, slots = 3, retract = 320 },
  },
  study = { placement = { dx = 0.05, dy = 0.05 } },
  wafers = { { name = "W1", station = "A", slot = 1 }, { name = "W2", station = "B", slot = 3 } },
}
