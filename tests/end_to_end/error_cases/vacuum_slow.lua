-- A tube is pinched: the vacuum would come, but not within the timeout.
cell "cell.lua"
fault { kind = "slow_vacuum", gripper = "FRONT", value = 10 }
get("A", 1)
