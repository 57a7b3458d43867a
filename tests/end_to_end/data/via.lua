-- By via points from one station to another, back the same way, and home; within a station nothing goes by them.
cell "via_layout.lua"
get("A", 1)
put("B", 2)
get("B", 2)
put("B", 1)
get("B", 1)
put("C", 1)
get("C", 1)
put("A", 2)
home()
expect_offset("W1", "A", 2, 0, 0, 1e-6)
