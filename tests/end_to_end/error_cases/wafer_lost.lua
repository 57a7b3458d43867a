-- The valves switch 2 mm above the chuck, which then has nothing within its reach.
cell "cell.lua"
get("A", 1)
put("P", 1, { release = 2 })
