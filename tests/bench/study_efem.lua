-- A study of a cell with collisions: a wafer goes from a FOUP to the aligner and on to the other FOUP.
study { placement = { dx = 0.3, dy = 0.3 }, teaching = { x = 0.1, y = 0.1, z = 0.05 } }
cell "../../lua/layouts/efem.lua"
get("FOUP1", 1)   put("ALIGN", 1)
get("ALIGN", 1)   put("FOUP2", 1)
