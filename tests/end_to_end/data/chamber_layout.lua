-- A chamber behind a slit, and a load lock between atmosphere and vacuum; one robot, on the atmosphere's side.
return {
  wafer = { diameter = 300 },
  robot = params.two and { kind = "TRZ", arms = { { heading = 0 }, { heading = 180, height = 10 } } } or nil,
  grippers = { { name = "EE" }, params.two and { name = "B2", arm = 2 } or nil },
  doors = {
    AIR = { at = { -500, 0, 900 }, box = { 10, 300, 100 }, open = { 0, 0, -200 }, seconds = 0.5 },
    SLIT = { at = { 0, 450, 900 }, box = { 300, 10, 100 }, open = { 0, 0, -200 }, seconds = 0.5 },
    VAC = { at = { -900, 0, 900 }, box = { 10, 300, 100 }, open = { 0, 0, -200 }, seconds = 0.5 },
  },
  stations = {
    A = { at = { 700, 0, 900 }, retract = 350, slots = 3, pitch = 20 },
    L = {
      at = { -700, 0, 900 }, rpy = { 0, 0, 180 }, retract = 350, door = "AIR", side = "atmosphere",
      pump = { down = 4, up = 3, empty_down = 2, doors = { vacuum = "VAC" } },
    },
    PM = {
      at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, retract = 350, door = "SLIT", process = 5, window = 4,
      clean = { after = 2, seconds = 3 },
    },
  },
  wafers = { { name = "W1", station = "A", slot = 1 }, { name = "W2", station = "A", slot = 2 }, { name = "W3", station = "A", slot = 3 } },
}
