-- Decides by a distance of frames: what a tape cannot have.
cell "study_cell.lua"

get("A", 1)
put("B", distance("A/1", "B/1") > 950 and 1 or 2)
