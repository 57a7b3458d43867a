-- Both robots keep wafers on two arms, by lists that name the wafers.
cell "flow_keep.lua"
flow {
  lots = { { wafers = { "STACK", 1, 3 }, back = "STACK" } },
  routes = { A = { "L", "PM", "PM2", "L" } },
  rule = {
    order = {
      ATM = {
        { "STACK", "keep", params.first or "W1" }, { "keep", "L" }, { "STACK", "keep", "X" }, { "L", "keep", "W1" }, { "keep", "STACK", "W1" }, { "keep", "L", "X" },
        { "STACK", "keep", "W3" }, { "L", "keep", "X" }, { "keep", "STACK" }, { "keep", "L", "W3" }, { "L", "STACK", "W3" },
      },
      VAC = {
        { "L", "keep", "W1" }, { "keep", "PM", "W1" }, { "PM", "keep" }, { "keep", "PM2" }, { "PM2", "L" }, { "L", "keep" }, { "keep", "PM", "X" }, { "PM", "PM2" }, { "PM2", "L" },
        { "L", "PM", "W3" }, { "PM", "PM2" }, { "PM2", "keep", "W3" }, { "keep", "L" },
      },
    },
  },
}
expect_offset("W1", "STACK", 3, 0, 0, 1e-6)
expect_offset("W3", "STACK", 1, 0, 0, 1e-6)
