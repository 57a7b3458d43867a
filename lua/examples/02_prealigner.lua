-- The paper's second run: a wafer goes to the prealigner, is turned, and keeps its distance from the chuck's axis.
cell "../layouts/paper.lua"

get("B", 1)   put("B", 10)      -- as the first run left it

-- The chuck's valve opens a slice before the end-effector's closes.
get("B", 10)  put("P", 1, { handover = "new_first" })
expect(holder("Wafer 2") == "PA", "the chuck holds Wafer 2")
expect_offset("Wafer 2", "P", 1, 13.794, 7.2385)

local apart = distance("PA", "Wafer 2")
rotate("P", 90)
expect_offset("Wafer 2", "P", 1, -7.2385, 13.794)
expect(math.abs(distance("PA", "Wafer 2") - apart) < 1e-9, "Wafer 2 stays as far from the middle of the chuck")
expect(math.abs(measure("P", "PA").turn - 90) < 1e-9, "the chuck stands at 90 degrees")

-- The wafer goes back to the blade, and to the chuck again; both valves switch in one slice.
get("P", 1, { handover = "same_slice" })
expect(holder("Wafer 2") == "EE", "the end-effector holds Wafer 2")
put("P", 1, { handover = "same_slice" })
expect(holder("Wafer 2") == "PA", "the chuck holds Wafer 2 again")
expect_offset("Wafer 2", "P", 1, -7.2385, 13.794)
