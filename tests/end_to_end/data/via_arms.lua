-- To stations by their points with an elbow, with either of two wrists, and with either of two arms.
cell "via_arms_layout.lua"
local other = params.robot == "scara" and "LO" or "UP"
get("A", 1, { gripper = "LO" })
put("B", 1, { gripper = "LO" })
get("B", 3, { gripper = other })
put("A", 2, { gripper = other })
ready("C", 1, { gripper = "LO" })
ready("A", 1, { gripper = other })
home()
expect_offset("W1", "B", 1, 0, 0, 0.5)
expect_offset("W2", "A", 2, 0, 0, 0.5)
