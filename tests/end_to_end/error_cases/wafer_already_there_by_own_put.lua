cell "cell.lua"
get("A", 1)
put("A", 5)
get("A", 2)
put("A", 5)
