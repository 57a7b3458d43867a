-- A load lock with a door, a flipper beside it, and a FOUP's worth of slots for a robot between them.
---@type waferhand.layout
return {
  vacuum = "delayed", collision = true, look_ahead = true,
  doors = { DOOR = { at = { 0, -470, 905 }, box = { 420, 12, 130 }, open = { 0, 0, 180 }, seconds = 0.8 } },
  grippers = { { name = "EE" }, { name = "CLAMP", on = "FLIPPER", flipper = { seconds = 1 } } },
  stations = {
    A = { at = { 0, 800, 900 }, rpy = { 0, 0, 90 }, slots = 4, retract = 450 },
    FLIPPER = { kind = "flipper", at = { 800, 0, 900 }, retract = 450 },
    LL = { at = { 0, -800, 900 }, rpy = { 0, 0, -90 }, slots = 2, retract = 500, door = "DOOR", face = "down" },
  },
  wafers = {
    { name = "W01", station = "A", slot = 1, dx = 0.4, dy = -0.3 },
    { name = "W02", station = "A", slot = 2, dx = -0.2, dy = 0.5 },
  },
}
