-- The robot goes after wafers that lie aside, and stops on its way where the script asks for that.
cell "../layouts/aside.lua"

-- W01 is taken where it lies, so it is in the middle of the blade, and then of its new slot.
local dx, dy = offset("W01", "A", 1)
get("A", 1, { dx = dx, dy = dy })
put("B", 1)
expect_offset("W01", "B", 1, 0, 0)

-- W02 lies turned: a blade that turns as far brings it back to where slots point.
get("A", 2, { turn = 8 })
put("B", 2)
expect(measure("B/2", "W02").turn < 1e-9, "W02 is no longer turned")

-- The blade is in below W03; what looks at it there has time; then the wafer is lifted, and carried out.
get("A", 3, { stop = "extended" })
wait(0.2)
expect(holder("W03") == nil, "W03 still lies in its slot")
local ok, problem = pcall(home)
expect(not ok and problem.name == "IN_PHASE", "with the blade in a slot nothing else moves")
continue()

-- The PUT makes good for how W03 lay, and stops before it leaves.
put("B", 3, { dx = -1, stop = "up" })
expect_offset("W03", "B", 3, 0, 0)
continue()

-- What is farther than the layout allows is refused before anything moves.
ok, problem = pcall(get, "B", 1, { dx = 8.5 })
expect(not ok and problem.name == "CORRECTION_TOO_LARGE", "8.5 mm are too many")
