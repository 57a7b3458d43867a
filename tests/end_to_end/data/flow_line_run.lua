-- The flow itself.
cell "flow_line.lua"
local told = flow { lots = { { wafers = { "A", 1, params.wafers or 24 } } }, rule = params.rule or "backward",
  routes = { R = { "P1", "P2", "P3", "B" } } }
expect(told["end"] == "done", "every wafer is there")
