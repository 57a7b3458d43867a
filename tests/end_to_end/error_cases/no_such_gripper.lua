cell "cell.lua"
get("A", 1, { gripper = "PA" })
