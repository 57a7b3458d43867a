-- A robot with axes, two load ports whose steps take time, two modules; --set seat=true seats wafers in their slots.
local function port(y)
  return {
    kind = "load_port", at = { -700, y, 900 }, rpy = { 0, 0, y > 0 and 135 or -135 }, retract = 340, slots = 25,
    port = { place = 2, clamp = 1, dock = 2, open = 3, map = 4 },
  }
end
local function module(degrees)
  local angle = math.rad(degrees)
  return { at = { 740 * math.cos(angle), 740 * math.sin(angle), 900 }, rpy = { 0, 0, degrees }, retract = 340, process = 30 }
end

local carriers = {}
for i = 1, params.lots do
  carriers["C" .. i] = { wafers = 25 }
end

return {
  seat = params.seat,
  grippers = { { name = "EE" } },
  stations = { LP1 = port(300), LP2 = port(-300), PM1 = module(30), PM2 = module(-30) },
  carriers = carriers,
}
