cell "cell.lua"
get("A", 1)
get("A", 2)
