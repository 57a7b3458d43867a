-- A lot (--set wafers=N) through the tool of three_robots_tool.lua, with real motions.
cell "three_robots_tool.lua"
local last = params.wafers or 25
local told = flow {
  lots = { { wafers = { "FROM", 1, last } } },
  routes = { A = { "L", { "P1", "P2" }, "B", { "Q1", "Q2", "Q3" }, "C", "M", "TO" } },
  rule = "swap",
}
expect(told["end"] == "done", "each wafer is in TO")
for slot = 1, last do
  expect_offset(("W%02d"):format(slot), "TO", slot, 0, 0, 1e-6)
end
