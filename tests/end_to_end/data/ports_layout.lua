-- Two load ports, one served by vehicles, and a stack; one robot, with two blades if params.two is true.
return {
  wafer = { diameter = 300 },
  robot = params.two and { kind = "TRZ", arms = { { heading = 0 }, { heading = 180, height = 10 } } } or nil,
  grippers = { { name = "EE" }, params.two and { name = "B2", arm = 2 } or nil },
  stations = {
    A = { at = { 760, 0, 900 }, retract = 350, slots = 3, pitch = 20 },
    LP1 = {
      kind = "load_port", at = { 0, 760, 900 }, rpy = { 0, 0, 90 }, retract = 360, slots = 5, pitch = 20,
      port = { e84 = { t4 = 1 }, mapper = { protruded = params.protruded } },
    },
    LP2 = {
      kind = "load_port", at = { 0, -760, 900 }, rpy = { 0, 0, -90 }, retract = 360, slots = 3, pitch = 20,
      port = { place = 2, clamp = 0.5, dock = 1, open = 2, map = 1.5, close = 2.5, goes = "open" },
    },
  },
  carriers = { C1 = { wafers = 5 }, C2 = { wafers = { 1, 3 } } },
  wafers = { { name = "W1", station = "A", slot = 1 }, { name = "W2", station = "LP2", slot = 2 } },
}
