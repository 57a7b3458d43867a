-- A leak opens while a wafer is on its way: the sensor goes off, the command ends, and the wafer is brought home slowly.
cell "../layouts/leak.lua"

get("A", 1)
local leak = fault { kind = "leak", gripper = "EE", value = 0.1, after = 0.4 }

local ok, problem = pcall(put, "B", 2)
print(problem)
expect(not ok and problem.name == "WAFER_LOST_ON_WAY", "PUT B 2 ends when the vacuum is lost")
expect(holder("Wafer 1") == "EE", "the wafer still rests on the blade")

-- When the leak is closed, the open valve builds the vacuum up again.
clear_fault(leak)
wait(0.5)
put("B", 2)
expect_offset("Wafer 1", "B", 2, 0, 0)
