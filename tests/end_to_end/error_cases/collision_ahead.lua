-- Nothing moves: the hit is found before it happens.
cell "walled_cell.lua"
get("B", 1)
put("B", 1)
get("A", 1)
