-- A robot with two arms between four stations, one on a rail that turns its blade over, one whose column tilts to one of the
-- stations, or one that goes by points, that stays within a circle while it turns.
local function around(degrees, rail, roll)
  local angle = math.rad(degrees)
  return { at = { 740 * math.cos(angle) + (rail or 0), 740 * math.sin(angle), 900 }, rpy = { roll or 0, 0, degrees }, retract = 340,
           via = params.robot == "points" and { { r = 330, blend = 300 } } or nil,
           slots = 2, pitch = 30, rail = rail }
end

local two = { kind = "TRZ", transit = 520, arms = { { heading = 0 }, { heading = 180, height = 10 } }, theta = { min = -720, max = 720 } }
local flips = { kind = "TRZY", transit = 520, rail = {}, flip = { seconds = 2 }, theta = { min = -720, max = 720 } }
local tilts = { kind = "TRZY", transit = 520, tilt = {}, theta = { min = -720, max = 720 } }
local points = { kind = "TRZY", transit = 520, theta = { min = -720, max = 720 } }
local robots = { two = two, flips = flips, tilts = tilts, points = points }
local is_two, is_tilting, has_rail = params.robot == "two", params.robot == "tilts", params.robot == "flips"

return {
  collision = true, look_ahead = true,
  robot = robots[params.robot],
  grippers = is_two and { { name = "LO", arm = 1 }, { name = "UP", arm = 2 } } or { { name = "LO" } },
  stations = {
    A = around(0, has_rail and 500 or nil), B = around(90, has_rail and -300 or nil, is_tilting and 1.5 or nil),
    C = around(180, has_rail and -300 or nil), D = around(-70, has_rail and 0 or nil),
  },
  study = { placement = { dx = 0.05, dy = 0.05 } },
  wafers = { { name = "W1", station = "A", slot = 1 }, { name = "W2", station = "B", slot = 1 } },
}
