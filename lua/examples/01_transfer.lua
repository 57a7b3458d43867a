-- The paper's first run: one wafer from a tilted station to a level one, another within it.
cell "../layouts/paper.lua"

get("A", 1)   put("B", 2)
get("B", 1)   put("B", 10)

expect_offset("Wafer 1", "B", 2, 0, 0)
expect_offset("Wafer 2", "B", 10, 13.794, 7.2385)
