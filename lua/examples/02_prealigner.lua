-- The paper's second run: a wafer goes to the prealigner, is turned, and keeps its distance from the chuck's axis.
cell "../layouts/paper.lua"

get("B", 1)   put("B", 10)      -- as the first run left it

-- The chuck's valve opens a slice before the end-effector's closes.
get("B", 10)  put("P", 1, { handover = "new_first" })
expect(holder("Wafer 2") == "PA", "the chuck holds Wafer 2")
expect_offset("Wafer 2", "P", 1, 13.794, 7.2385)

rotate("P", 90)
expect_offset("Wafer 2", "P", 1, -7.2385, 13.794)

-- Back onto the blade and over again, both valves switching in one slice.
get("P", 1, { handover = "same_slice" })
expect(holder("Wafer 2") == "EE", "the end-effector holds Wafer 2")
put("P", 1, { handover = "same_slice" })
expect(holder("Wafer 2") == "PA", "the chuck holds Wafer 2 again")
expect_offset("Wafer 2", "P", 1, -7.2385, 13.794)
