-- An equipment front end with two load ports, to which vehicles bring carriers: one is open when a run begins, the other empty.
local function port(y)
  return {
    kind = "load_port", at = { 760, y, 900 }, retract = 440, pickup_speed = 40,
    port = { clamp = 0.8, dock = 2.5, open = 4, map = 3, e84 = { t3 = 8, t4 = 3 }, mapper = { protruded = 10 } },
  }
end

return {
  tolerance = "strict",
  check = "swept",
  seat = true,
  collision = true,
  grippers = { { name = "EE" }, { name = "PA", on = "ALIGN" } },
  stations = {
    LP1 = port(-260),
    LP2 = port(260),
    ALIGN = { kind = "prealigner", at = { -120, 620, 950 }, rpy = { 0, 0, 100 }, retract = 300 },
  },
  carriers = { C1 = { wafers = 2, at = "LP1" }, C2 = { wafers = { 1, 3, 25 } } },
  obstacles = {
    { name = "front wall", box = { 10, 1300, 560 }, at = { 560, 0, 480 } },
    { name = "rear wall", box = { 10, 1800, 1600 }, at = { -560, 0, 800 } },
    { name = "table", box = { 1000, 1800, 20 }, at = { -40, 0, -20 } },
  },
  clearance = { blade_wafer_above = 1, blade_wafer_below = 1, wafer_ledge = 1 },
}
