-- A wafer whose notch cannot be found: the error lists what was seen. The wafer, only centred, goes back to its slot.
cell "../layouts/lot.lua"

get("A", 5)   put("P", 1)
local ok, problem = pcall(align, "P")
expect(not ok and problem.name == "NO_NOTCH", "the rim has no notch")
print(problem.text)

-- The scan has measured its middle nevertheless.
local found = align("P", { mark = "none" })
expect(found.mark == "none" and found.notch == nil, "nothing is said of its turn")
get("P", 1)   put("A", 5)
expect_offset("W05", "A", 5, 0, 0, 0.001)
expect(math.abs(measure("A/5", "W05").heading - 60) < 0.21, "it was turned by no more than the two samples that the first scan went beyond its turn")
