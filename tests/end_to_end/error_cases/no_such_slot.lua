cell "cell.lua"
put("A", 6)
