-- A real class of tool: at one opening of a lock's door a wafer comes in and another one goes out, if the lock has a slot for each
-- way. `--set slots=1` shows what that is worth: with one slot for both ways the lock turns empty.
cell "../layouts/timed_exchange.lua"

local locks = params.locks == 1 and "LLA" or { "LLA", "LLB" }
local told = flow {
  lots = { { name = "A", wafers = { "LP1", 1, 12 }, back = "LP1" } },
  routes = { usual = { "AL", locks, { "PM1", "PM2" }, locks } },
  rule = params.rule or "longest_wait",
}
expect(told.wafers == 12, "all wafers are back")
expect(params.slots == 1 or told.makespan_s < 1000, "sooner than by one slot")
