-- The sensor is stuck: it is on behind a closed valve.
cell "cell.lua"
fault { kind = "sensor_on", gripper = "FRONT" }
wait(0.1)
get("A", 1)
