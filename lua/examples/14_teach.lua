-- A cell teaches itself: with the wafer in slot 1 and the beam at the station's door the robot finds the station's true place.
-- Try it with a displaced station: waferhand run 14_teach.lua --error A.x=0.25 --error A.z=-0.2 --error A.yaw=0.15
cell "../layouts/teach.lua"

local taught = teach("A", { by = "beam" })
print("the layout should say: " .. taught.text)

-- The simulator knows the true place.
local truth = measure("base", "A")
local off = math.max(math.abs(taught.at[1] - truth.dx), math.abs(taught.at[2] - truth.dy), math.abs(taught.at[3] - truth.dz))
expect(off < 0.02, ("x, y and z within 0.02 mm: off by %.4f"):format(off))
expect(math.abs(math.abs(taught.rpy[3]) - truth.turn) < 0.02, "yaw within 0.02 degrees")
expect(holder("W") == nil, "the wafer is back in its slot")
expect_offset("W", "A", 1, 0, 0, 1e-6)
