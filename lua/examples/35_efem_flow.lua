-- A lot through an equipment front end with real motions: the FOUP is mapped, each wafer is aligned, goes into the load lock that is
-- free first, and comes back into a slot of its number.
cell "../layouts/efem_locks.lua"

local last = params.wafers or 12
local told = flow {
  lots = { { name = "LOT", wafers = { "FOUP1", 1, last }, back = "FOUP2", map = true } },
  routes = { through = { { "AL", align = 90 }, { "LLA", "LLB" } } },
  rule = params.rule or "backward",
}

expect(told["end"] == "done", "each wafer is in FOUP2")
for slot = 1, last do
  expect_offset(("W%02d"):format(slot), "FOUP2", slot, 0, 0, 0.2)
end
