-- A tool in vacuum, where nothing can be sucked: wafers lie on passive blades, on the shelves of a load lock and on
-- the pins of two chambers, by their weight alone. An aligner has an electrostatic chuck and passive pins beside it.
return {
  check = "swept",
  vacuum = { model = "delayed", build = 0.1, vent = 0.05 }, -- of the aligner's chuck
  pads = { friction = 0.25, force = 20 },
  -- Friction holds 2,379 mm/s^2 in every direction. The axes could do five times that, and do without a wafer.
  robot = { kind = "TRZ", loaded = { acceleration = params.loaded or 2300 }, r = { min = 250, max = 900 },
    arms = { { heading = 0, height = 0 }, { heading = 180, height = 12 } } },
  chuck = { acceleration = 600 },
  grippers = {
    { name = "A", grip = "passive", arm = 1 },
    { name = "B", grip = "passive", arm = 2 },
    { name = "CHUCK", on = "AL" },
    { name = "PINS", on = "AL", grip = "passive", pins = { up = 6, down = 4, speed = 20 } },
  },
  stations = {
    LL = { at = { 700, 0, 900 }, slots = 2, pitch = 15, retract = 320 }, -- shelves
    PM1 = { at = { 0, 750, 900 }, rpy = { 0, 0, 90 }, stroke = 10, retract = 320 }, -- pins
    PM2 = { at = { 0, -750, 900 }, rpy = { 0, 0, -90 }, stroke = 10, retract = 320 },
    AL = { kind = "prealigner", at = { -700, 0, 900 }, rpy = { 0, 0, 180 } },
  },
  wafers = {
    { name = "W1", station = "LL", slot = 1, dx = 0.4 },
    { name = "W2", station = "LL", slot = 2, dy = -0.3 },
    { name = "W3", station = "PM1", slot = 1 },
  },
}
