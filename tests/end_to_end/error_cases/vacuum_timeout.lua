-- The sensor's wire is broken: the wafer is on the pads, and the MCS cannot know.
cell "cell.lua"
fault { kind = "sensor_off", gripper = "FRONT" }
get("A", 1, { retries = 1 })
