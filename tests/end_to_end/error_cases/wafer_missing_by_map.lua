cell "cell.lua"
map("B")
get("B", 1)
