-- Decides by a measured number: what a tape cannot have.
cell "study_cell.lua"

get("A", 1)
local dx = offset("Wafer 1", "A", 1)
put("B", dx > 0 and 1 or 2)
