-- Lots of 25 wafers (--set lots=N) through a cell with axes: carriers come and go at two load ports, one robot, two modules.
cell "real_flow_tool.lua"
local lots = {}
for i = 1, params.lots do
  local port = i % 2 == 1 and "LP1" or "LP2"
  lots[i] = { name = "L" .. i, wafers = { port, 1, 25 }, back = port, carrier = "C" .. i }
end
local told = flow { lots = lots, routes = { through = { { "PM1", "PM2" } } } }
expect(told["end"] == "done", "each wafer is in its carrier again")
