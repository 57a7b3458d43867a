-- A cell whose errors are large beside its tolerance: picks, hand-overs and expectations fail now and then.
local vacuum = params.vacuum or "ideal"
return {
  tolerance = { projz = 0.5, projxy = 1.5, planar = 0.99998 },
  check = params.check or "sampled",
  seat = params.seat or false,
  settle = params.settle or false,
  collision = params.collision or false,
  vacuum = vacuum,
  grippers = {
    { name = "EE", valve = "eeVacValve[0]" },
    { name = "PA", on = "P", valve = "paVacValve[0]" },
  },
  stations = {
    A = { at = { 700, 0, 900 }, slots = 3 },
    B = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, slots = 3 },
    P = { kind = "prealigner", at = { -600, 0, 950 }, rpy = { 0, 0, 180 } },
  },
  wafers = {
    { name = "Wafer 1", station = "A", slot = 1 },
    { name = "Wafer 2", station = "A", slot = 2, dx = 0.25 },
    params.double and { name = "Upper", station = "A", slot = 3, dx = 24.5, dz = -19.2 } or nil,
  },
  study = params.none == nil and {
    placement = { dx = 0.5, dy = 0.5, dz = 0.05, tilt = 0.1, turn = 3 },
    teaching = { x = 0.3, y = 0.3, z = params.z or 0.15, roll = 0.05, pitch = 0.05, yaw = 0.1, shape = "uniform" },
    timing = { valve = params.valve or 0, vacuum = params.late or 0 },
    wafers = { ["Wafer 2"] = { turn = 0 } },
    stations = { P = { x = 0.6 } },
    grippers = { PA = { valve = (params.valve or 0) / 2, shape = "uniform" } },
  } or nil,
}
