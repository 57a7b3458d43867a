cell "cell.lua"
map("C")
get("C", 4)
