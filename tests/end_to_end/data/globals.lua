-- A script may use the names of Lua's own functions for its own things.
cell "../../../lua/layouts/paper.lua"
pairs, ipairs, type, tostring, error = 1, 2, 3, 4, 5
get("A", 1)
put("B", 2)
expect_offset("Wafer 1", "B", 2, 0, 0)
