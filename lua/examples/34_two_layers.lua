-- A route that comes twice to the same stations: each wafer is coated and baked, and both again. Shipped rules begin no transfer
-- after which wafers would block each other; with `--set safe=false` nobody can go on, and the run says who waits for whom.
cell "../layouts/timed_coater.lua"

local told = flow {
  lots = { { name = "A", wafers = { "LP1", 1, 25 } } },
  routes = { layers = { "COAT", "BAKE", "COAT", "BAKE", "OUT" } },
  rule = params.rule or "backward",
  safe = params.safe,
}
expect(told.wafers == 25, "all wafers have both layers")
