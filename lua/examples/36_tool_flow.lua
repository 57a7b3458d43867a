-- A lot through a tool with real motions: two load locks that pump, two modules for each of two processes, two arms that exchange.
-- Collisions are looked for between all parts. A wafer may wait 60 s in a module, and each module is cleaned after three wafers.
cell "../layouts/tool_with_locks.lua"

local last = params.wafers or 25
local told = flow {
  lots = { { wafers = { "FROM", 1, last } } },
  routes = { through = { "L", { "PM1", "PM2" }, { "PM3", "PM4" }, "M", "TO" } },
  rule = params.rule or "swap",
}

expect(told["end"] == "done", "each wafer is in TO")
expect(#told.stays == 0, "no wafer waits too long in a module")
for slot = 1, last do
  expect_offset(("W%02d"):format(slot), "TO", slot, 0, 0, 1e-6)
end
