-- One robot of the tool has axes, and its ways are looked at; the other one is known by its times alone. Both share two load locks, their
-- doors and their pumps. Which of them limits the tool?
cell "../layouts/mixed_locks.lua"

local last = params.wafers or 12
local told = flow {
  lots = { { wafers = { "STACK", 1, last }, back = "STACK" } },
  routes = { through = { "L", "PM1", "PM2", "M" } },
  rule = params.rule or "swap",
}

expect(told["end"] == "done", "each wafer is back in its slot")
expect(#told.stays == 0, "no wafer waits too long in a module")
for slot = 1, last do
  expect_offset(("W%02d"):format(slot), "STACK", slot, 0, 0, 1e-6)
end
