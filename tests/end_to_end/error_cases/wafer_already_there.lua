cell "cell.lua"
map("A")
get("A", 1)
put("A", 2)
