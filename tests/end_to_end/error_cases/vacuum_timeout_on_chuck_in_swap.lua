-- The same in a SWAP, which has taken the other wafer by then.
cell "cell.lua"
get("A", 2, { gripper = "FRONT" })
put("P", 1)
get("A", 1, { gripper = "BACK" })
fault { kind = "sensor_off", gripper = "PA" }
swap("P", 1)
