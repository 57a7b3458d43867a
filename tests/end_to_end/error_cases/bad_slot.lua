cell "cell.lua"
map("C")
get("C", 2)
