cell "cell.lua"
stop_in(0.7)
pcall(get, "A", 1)
get("A", 1)
