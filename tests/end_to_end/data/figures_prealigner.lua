-- A wafer over the prealigner and back to where it was, one that is dropped, and a GET that finds nothing.
cell "figures_layout.lua"
cycle "over the prealigner"
get("A", 1) put("P", 1) rotate("P", 90) get("P", 1) put("A", 1)
cycle "dropped"
get("A", 2)
valve("EE", 1)
pcall(get, "B", 1)
