-- A prealigner whose edge sensor is off by as much as one that was built in by hand, and nobody has told motion control: `offset` to
-- `latency` are the truth, `believed` would be what is known of them.
return {
  grippers = { { name = "EE" }, { name = "PA", on = "P" } },
  corrections = { x = 8, y = 8 },
  seat = true,
  stations = {
    A = { kind = "foup", at = { 700, 0, 900 } },
    P = {
      kind = "prealigner", at = { -620, 0, 950 }, rpy = { 0, 0, 180 },
      sensor = { noise = 0.005, offset = 0.1, zero = -0.15, gain = 0.001, latency = 20e-6 },
    },
  },
  wafers = { { name = "W", station = "A", slot = 1, dx = 1.5, dy = -0.8, rpy = { 0, 0, 37 } } },
}
