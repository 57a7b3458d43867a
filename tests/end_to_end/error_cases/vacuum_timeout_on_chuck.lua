-- The chuck's sensor is broken: the wafer was handed over, and the MCS cannot know.
cell "cell.lua"
get("A", 1)
fault { kind = "sensor_off", gripper = "PA" }
put("P", 1)
