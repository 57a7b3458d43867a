-- The pump dies while the arm is under way with a wafer.
cell "cell.lua"
get("A", 1)
fault { kind = "no_vacuum", gripper = "FRONT", after = 0.5 }
put("C", 5)
