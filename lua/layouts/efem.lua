-- An equipment front end: two FOUPs on load ports, an atmospheric robot, a prealigner, walls; collisions are checked.
local wafers = {}
for slot = 1, 25 do
  wafers[slot] = { name = ("W%02d"):format(slot), station = "FOUP1", slot = slot }
end

return {
  tolerance = "strict",
  check = "swept",
  seat = true,
  collision = true,
  grippers = {
    { name = "EE", on = "robot", valve = "eeVacValve[0]" },
    { name = "PA", on = "ALIGN", valve = "paVacValve[0]" },
  },
  stations = {
    FOUP1 = { kind = "foup", at = { 760, -260, 900 }, rpy = { 0, 0, 0 }, retract = 440, pickup_speed = 40 },
    FOUP2 = { kind = "foup", at = { 760, 260, 900 }, rpy = { 0, 0, 0 }, retract = 440, pickup_speed = 40 },
    ALIGN = { kind = "prealigner", at = { -120, 620, 950 }, rpy = { 0, 0, 100 }, retract = 300 },
  },
  obstacles = {
    { name = "front wall", box = { 10, 1300, 560 }, at = { 560, 0, 480 } },
    { name = "rear wall", box = { 10, 1800, 1600 }, at = { -560, 0, 800 } },
    { name = "table", box = { 1000, 1800, 20 }, at = { -40, 0, -20 } },
  },
  wafers = wafers,
  clearance = { blade_wafer_above = 1, blade_wafer_below = 1, wafer_ledge = 1 },
}
