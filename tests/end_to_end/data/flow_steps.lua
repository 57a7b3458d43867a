-- Steps in which something is done with the wafer: a prealigner with a sensor, a flipper, a station with beams.
local wafers = {}
for slot = 1, 3 do
  wafers[slot] = { name = ("W%d"):format(slot), station = "A", slot = slot, dx = 0.4 * slot, dy = -0.3 }
end
return {
  corrections = { x = 5, y = 5, turn = 5 },
  grippers = { { name = "EE" }, { name = "PA", on = "P" }, { name = "CLAMP", on = "F", flipper = { seconds = 1 } } },
  stations = {
    A = { at = { 700, 0, 900 }, slots = 5, retract = 350 },
    P = { kind = "prealigner", at = { -620, 0, 950 }, rpy = { 0, 0, 180 }, sensor = { noise = 0.005 } },
    F = { kind = "flipper", at = { 0, -750, 900 }, rpy = { 0, 0, -90 }, retract = 400 },
    B = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, slots = 5, retract = 350, beams = { { y = 60 }, { y = -110 } } },
  },
  wafers = wafers,
}
