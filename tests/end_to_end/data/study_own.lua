-- Says itself what is drawn.
study { placement = { dx = 0.1, dy = 0.1 } }
cell "study_cell.lua"
get("A", 1) put("B", 1)
expect_offset("Wafer 1", "B", 1, 0, 0, 1)
