-- Two stations and a prealigner with a vacuum that takes its time, pads, and faults from the beginning.
return {
  vacuum = { build = 0.04, vent = 0.015 },
  pads = { friction = 0.2, force = 4 },
  faults = {
    { kind = "slow_vacuum", value = 0.06, after = 0.5, lasting = 2 },
    { kind = "leak", gripper = "PA", value = 0.65, after = 4 },
    { kind = "wafer_shifted", wafer = "Wafer 2", dx = 2, dy = 1, after = 0.01 },
    { kind = "command_lost", after = 1, lasting = 0.002 },
  },
  grippers = { { name = "EE" }, { name = "PA", on = "P" } },
  stations = {
    A = { at = { 650, 0, 900 }, slots = 5 },
    B = { at = { 0, 650, 900 }, rpy = { 0, 0, 90 }, slots = 5 },
    P = { kind = "prealigner", at = { -600, 0, 950 }, rpy = { 0, 0, 180 } },
  },
  wafers = { { station = "A", slot = 1 }, { station = "A", slot = 2 } },
}
