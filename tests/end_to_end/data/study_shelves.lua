-- Wafers that go from shelf to shelf, which are higher or lower than they were taught.
cell "study_cell.lua"

get("A", 1)
put("B", 1)
get("A", 2)
put("B", 3)
get("B", 3)
put("A", 2)
