-- A wafer is turned over on its way, and comes back: after two turns it lies as before.
cell "../layouts/flip.lua"

-- Near a station there is no room: the error names the part that would be hit, before anything moves.
get("A", 1)
line { dx = 200 }
local good, problem = pcall(flip, "EE")
expect(not good and problem.name == "COLLISION_AHEAD", tostring(problem))
line { dx = -200 }

flip("EE")                  -- the wafer hangs below the blade
put("D", 1)                 -- the blade comes from above
expect(face("W01") == "down", "W01 lies face down")
expect_offset("W01", "D", 1, 1.5, 0.8)

get("D", 1)                 -- from above again, by its back
flip("EE")
put("A", 1)
expect(face("W01") == "up", "W01 lies face up")
expect_offset("W01", "A", 1, 1.5, -0.8)
