cell "cell.lua"
get("Q", 1)
