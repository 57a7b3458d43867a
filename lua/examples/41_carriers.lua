-- Lots whose carriers come and go while a flow goes on. C1 stands open at its port, and goes when its wafers are back. A vehicle
-- brings C2 to the other port, late: C2 is placed, clamped, docked, opened and mapped, and the flow goes on with its wafers. One of them stands
-- out too far: it is left in its carrier. Earlier or later: `--set arrives=5`.
cell "../layouts/load_ports.lua"

carrier("LP2", { name = "C2", at = params.arrives or 30, slots = { [3] = "protruded" } })

local told = flow {
  lots = {
    { name = "A", wafers = { "LP1", 1, 2 }, back = "LP1", leaves = true },
    { name = "B", wafers = { "LP2", 1, 1 }, back = "LP2" },
    { name = "C", wafers = { "LP2", 3, 3 }, back = "LP2" },
    { name = "D", wafers = { "LP2", 25, 25 }, back = "LP2", leaves = true },
  },
  routes = { through = { "ALIGN" } },
  on_error = function(tool, problem)
    return problem.kind == "map" and "skip" or nil
  end,
}

expect(told["end"] == "done" and told.wafers == 4, "four wafers are back")
expect(told.skipped == 1, "one is left in its carrier")
