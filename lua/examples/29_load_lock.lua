-- Wafers go into a load lock face down: the flipper turns each over, and the door opens meanwhile. The door is shut
-- again while the robot is elsewhere.
cell "../layouts/load_lock.lua"

local function bring(from, to)
  get("A", from)
  put("FLIPPER", 1)
  local opening = task(function() open "DOOR" end)
  flip "FLIPPER"
  get("FLIPPER", 1)
  put("LL", to)          -- waits for the door if it is not open yet
  join(opening)
  return task(function() close "DOOR" end)
end

local closing = bring(1, 1)
join(closing, bring(2, 2))

-- A shut door is an error before anything moves, and so is one that would close on the arm.
local ok, problem = pcall(get, "LL", 1)
expect(not ok and problem.name == "DOOR_SHUT", "the shut door is told ahead")
open "DOOR"
get("LL", 2, { stop = "extended" })
ok, problem = pcall(close, "DOOR")
expect(not ok and problem.name == "DOOR_BLOCKED", "the door does not close on the arm")
stop() recover() close "DOOR"

expect(face("W01") == "down" and face("W02") == "down", "both lie face down")
expect_offset("W01", "LL", 1, 0.4, 0.3, 1e-3)
expect_offset("W02", "LL", 2, -0.2, -0.5, 1e-3)
