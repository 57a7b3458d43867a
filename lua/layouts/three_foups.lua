-- Three FOUPs side by side, 505 mm apart: the arm comes in before it turns, or the wafer would meet the walls between them.
local wafers = {}
for slot = 1, 25 do
  wafers[slot] = { name = ("W%02d"):format(slot), station = "FOUP1", slot = slot }
end

return {
  tolerance = "strict",
  check = "swept",
  seat = true,
  collision = true,
  look_ahead = true,
  robot = { transit = 480, r = { max = 1000 } },
  grippers = { { name = "EE", on = "robot", valve = "eeVacValve[0]" } },
  stations = {
    FOUP1 = { kind = "foup", at = { 760, -505, 900 }, retract = 360 },
    FOUP2 = { kind = "foup", at = { 760, 0, 900 }, retract = 360 },
    FOUP3 = { kind = "foup", at = { 760, 505, 900 }, retract = 360 },
  },
  wafers = wafers,
}
