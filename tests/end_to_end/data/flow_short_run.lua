-- The flow itself; `route` says how far it goes.
cell "flow_short.lua"
local routes = { there = { "L" }, into = { "L", { "PM", process = 0 } }, back = { "L", "PM", "L" } }
local which = params.route or "back"
local told = flow { lots = { { wafers = { "STACK", 1, params.wafers or 2 }, back = which == "back" and "STACK" or nil } },
  routes = { R = routes[which] } }
expect(told["end"] == "done", "each wafer is at its end")
