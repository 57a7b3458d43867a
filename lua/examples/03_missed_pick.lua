-- A GET that takes nothing, and reports the reason.
cell "../layouts/shifted.lua"

local ok, problem = pcall(get, "A", 1)
expect(not ok and problem.name == "WAFER_MISSING", "GET A 1 finds no wafer on the blade")
expect(holder("Wafer 1") == nil, "Wafer 1 stays where it is")

local p = proximity("Wafer 1", "EE")
expect(p.failed.projxy, "it lies too far aside")
print(problem)

get("A", 3)
expect(holder("Wafer 2") == "EE", "the next one is taken")
