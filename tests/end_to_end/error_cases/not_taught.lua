cell "cell.lua"
get("U", 1)
