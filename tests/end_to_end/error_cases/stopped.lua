cell "cell.lua"
stop_in(0.7)
get("A", 1)
