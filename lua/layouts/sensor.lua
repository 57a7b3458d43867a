-- A prealigner with an edge sensor, and a wafer that lies beside the middle of its slot, turned, with a chip in its edge.
return {
  grippers = { { name = "EE" }, { name = "PA", on = "P" } },
  stations = {
    A = { kind = "foup", at = { 700, 0, 900 } },
    P = { kind = "prealigner", at = { -620, 0, 950 }, rpy = { 0, 0, 180 }, sensor = { noise = 0.005 } },
  },
  wafers = {
    { name = "W01", station = "A", slot = 1, dx = 1.5, dy = -0.8, rpy = { 0, 0, 37 },
      rim = { diameter = 300.05, chips = { { at = 110, width = 2, depth = 0.3 } } } },
  },
}
