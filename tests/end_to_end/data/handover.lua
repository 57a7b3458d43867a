cell "handover_layout.lua"
get("B", 1) put("P", 1)
expect(holder("Wafer") == "PA", "the chuck holds the wafer")
