-- Two blades at a prealigner that is never empty: a wafer in and another one out each cycle.
cell "../../../lua/layouts/dual.lua"
get("A", 1) put("P", 1)
cycle "in with the second"
get("A", 2) swap("P", 1) put("A", 1, { gripper = "BACK" })
cycle "in with the first"
get("A", 1) swap("P", 1) put("A", 2, { gripper = "BACK" })
