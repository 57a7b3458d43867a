-- Two stations, and how well they are taught, wafers placed and valves timed: what `waferhand study` draws.
return {
  tolerance = { projz = 0.5, projxy = 2.2, planar = 0.99998 },
  grippers = { { name = "EE", valve = "eeVacValve[0]" } },
  stations = {
    A = { at = { 700, 0, 900 }, slots = 25 },
    B = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, slots = 25 },
  },
  wafers = { { name = "Wafer 1", station = "A", slot = 1 } },
  study = {
    placement = { dx = 0.5, dy = 0.5, tilt = 0.02 },        -- standard deviations, mm and degrees
    teaching = { x = 0.2, y = 0.2, z = 0.1, yaw = 0.05 },
    timing = { valve = 0.005, shape = "uniform" },          -- late by up to 5 ms
    stations = { B = { z = 0.2, shape = "uniform" } },      -- B's height is known to 0.2 mm either way
  },
}
