cell "cell.lua"
get("A", 1, { vacuum_check = "sometimes" })
