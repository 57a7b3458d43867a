-- The wafer is there, but farther aside than the tolerance allows.
cell "cell.lua"
get("A", 4, { retries = 1 })
