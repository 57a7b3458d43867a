-- The robot corrects for wafers that lie aside, and stops on its way if the script asks for that.
cell "../layouts/aside.lua"

-- W01 is taken at its true place, so it is in the middle of the blade, and then of its new slot.
local dx, dy = offset("W01", "A", 1)
get("A", 1, { dx = dx, dy = dy })
put("B", 1)
expect_offset("W01", "B", 1, 0, 0)

-- W02 lies turned: a blade that turns by this angle brings it back to the slots' direction.
get("A", 2, { turn = 8 })
put("B", 2)
expect(measure("B/2", "W02").turn < 1e-9, "W02 is no longer turned")

-- The blade stands below W03, and a sensor has time to look at it; then the wafer is lifted, and carried out.
get("A", 3, { stop = "extended" })
wait(0.2)
expect(holder("W03") == nil, "W03 still lies in its slot")
local ok, problem = pcall(home)
expect(not ok and problem.name == "IN_PHASE", "with the blade in a slot nothing else moves")
continue()

-- The PUT corrects the place of W03, and stops before it leaves.
put("B", 3, { dx = -1, stop = "up" })
expect_offset("W03", "B", 3, 0, 0)
continue()

-- A correction larger than the layout allows is refused before anything moves.
ok, problem = pcall(get, "B", 1, { dx = 8.5 })
expect(not ok and problem.name == "CORRECTION_TOO_LARGE", "8.5 mm are too many")
