-- Two lots through two load locks and four modules that are cleaned, with two arms that exchange wafers, by times alone. The second
-- carrier comes late, and a module fails for ten minutes with a wafer inside. Another rule: `--set rule=first_come`.
cell "../layouts/timed_locks.lua"

local told = flow {
  lots = {
    { name = "A", wafers = { "LP1", 1, 25 }, back = "LP1" },
    { name = "B", wafers = { "LP2", 1, 25 }, back = "LP2", arrives = 900 },
  },
  routes = { usual = { "AL", { "LLA", "LLB" }, { "PM1", "PM2", "PM3", "PM4" }, { "LLA", "LLB" } } },
  rule = params.rule or "swap",
  down = { { "PM2", at = 1200, seconds = 600 } },
  late = "tell",
}
expect(told.wafers == 50, "all wafers are back")
for _, stay in ipairs(told.stays) do
  expect(stay.station == "PM2", "no wafer stays too long but in the module that failed")
end
