-- On a rail, with a wrist that tilts and a blade that turns over: a point says where the rail is.
cell "via_rail_layout.lua"
get("A", 1)
put("B", 1)
flip("EE")
ready("A", 1)
home()
expect_offset("W1", "B", 1, 0, 0, 1e-6)
