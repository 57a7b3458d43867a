cell "cell.lua"
put("A", 5)
