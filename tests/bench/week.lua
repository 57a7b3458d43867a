-- A week (--set seconds=N) of the vacuum tool of lua/layouts/timed_locks.lua: carriers of 25 wafers on two load ports, one after
-- another, two locks, four modules that are cleaned, two arms that exchange.
cell "../../lua/layouts/timed_locks.lua"
local seconds = params.seconds or 604800
local lots = {}
for i = 1, seconds // 1500 + 2 do
  local port = i % 2 == 1 and "LP1" or "LP2"
  lots[i] = { name = "L" .. i, wafers = { port, 1, 25 }, back = port }
end
flow {
  lots = lots,
  routes = { usual = { "AL", { "LLA", "LLB" }, { "PM1", "PM2", "PM3", "PM4" }, { "LLA", "LLB" } } },
  rule = "swap", until_s = seconds, late = "tell",
}
