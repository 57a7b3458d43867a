cell "cell.lua"
get("A", 1)
