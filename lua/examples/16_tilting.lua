cell "../layouts/tilting.lua"

get("A", 1)   put("B", 2)

expect_offset("Wafer 1", "B", 2, 0, 0)
