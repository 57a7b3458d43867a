-- A run with everything that the state has beside the grasp table: delayed vacuum, slips, faults of layout and script.
cell "delayed_layout.lua"
get("A", 1)
local stuck = fault { kind = "sensor_on", gripper = "PA", after = 0.2, lasting = 1 }
put("P", 1)
wait(0.1)
fault { kind = "wafer_tilted", wafer = "Wafer 2", rpy = { 0, 0, 30 } }
fault { kind = "no_vacuum", after = 0.3, lasting = 0.4 }
rotate("P", 90)
clear_fault(2)
wait(0.3)
get("P", 1)
put("B", 3)
expect(stuck == 5, "four faults are the layout's")
expect_offset("Wafer 1", "B", 3, 0, 0, 0.1)
