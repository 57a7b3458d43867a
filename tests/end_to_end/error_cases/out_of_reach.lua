cell "cell.lua"
get("A", 1, { retract = 500 })
