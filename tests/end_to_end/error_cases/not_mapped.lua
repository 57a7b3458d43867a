cell "cell.lua"
get("B", 1)
