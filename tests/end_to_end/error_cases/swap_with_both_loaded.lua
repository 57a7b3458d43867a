cell "cell.lua"
get("A", 1)
get("A", 2, { gripper = "BACK" })
swap("A", 4)
