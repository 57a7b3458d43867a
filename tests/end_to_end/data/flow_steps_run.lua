-- Each wafer is aligned, turned over, and centred on its way into B; A is mapped before, B behind.
cell "flow_steps.lua"
local figures = flow {
  lots = { { wafers = { "A", 1, 3 }, map = true } },
  routes = { R = { { "P", align = params.angle or 90 }, { "F", flip = true }, { "B", centre = true, map = true } } },
}
expect(figures["end"] == "done", "every wafer is in B")
for slot = 1, 3 do
  expect(face(("W%d"):format(slot)) == "down", "it is turned over")
  expect_offset(("W%d"):format(slot), "B", slot, 0, 0, 0.05)
end
