-- One GET and PUT in a cell that is never quite as taught; a missed pick is tried again 0.4 mm higher.
-- waferhand study lua/examples/07_study.lua --trials 10000
cell "../layouts/study.lua"

local ok, problem = pcall(get, "A", 1)
if not ok then
  expect(problem.name == "WAFER_MISSING", "a GET fails for nothing but a wafer missing")
  get("A", 1, { offset = 3.4, stroke = 6.8 })
end
put("B", 2)
expect_offset("Wafer 1", "B", 2, 0, 0, 2.5)
