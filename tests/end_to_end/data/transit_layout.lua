-- A robot with two arms between four stations, or one on a rail that turns its blade over, that stays within a circle while it turns.
local function around(degrees, rail)
  local angle = math.rad(degrees)
  return { at = { 740 * math.cos(angle) + (rail or 0), 740 * math.sin(angle), 900 }, rpy = { 0, 0, degrees }, retract = 340,
           slots = 2, pitch = 30, rail = rail }
end

local two = { kind = "TRZ", transit = 520, arms = { { heading = 0 }, { heading = 180, height = 10 } }, theta = { min = -720, max = 720 } }
local flips = { kind = "TRZY", transit = 520, rail = {}, flip = { seconds = 2 }, theta = { min = -720, max = 720 } }
local is_two = params.robot == "two"

return {
  collision = true, look_ahead = true,
  robot = is_two and two or flips,
  grippers = is_two and { { name = "LO", arm = 1 }, { name = "UP", arm = 2 } } or { { name = "LO" } },
  stations = {
    A = around(0, not is_two and 500 or nil), B = around(90, not is_two and -300 or nil),
    C = around(180, not is_two and -300 or nil), D = around(-70, not is_two and 0 or nil),
  },
  study = { placement = { dx = 0.05, dy = 0.05 } },
  wafers = { { name = "W1", station = "A", slot = 1 }, { name = "W2", station = "B", slot = 1 } },
}
