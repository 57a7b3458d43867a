-- A wafer from one robot to another and back, with errors of teaching for each of them.
study { teaching = { x = 0.2, y = 0.2, z = 0.05, roll = 0.01 } }
cell "../../../lua/layouts/two_robots.lua"
local ATM, VAC = robot "ATM", robot "VAC"
ATM:get("FROM", 1)   ATM:put("IN", 1)
local inner = task(function()
  VAC:get("IN", 1)   VAC:put("PM", 1)
  VAC:get("PM", 1)   VAC:put("OUT", 1)
  signal "out"
end)
ATM:get("FROM", 2)   ATM:put("TO", 2)
await "out"
ATM:get("OUT", 1)   ATM:put("TO", 1)
join(inner)
expect_offset("W1", "TO", 1, 0, 0, 20)
