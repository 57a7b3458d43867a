-- A cell that teaches itself by touch: a pin below the blade feels a block that is fixed to the station, at three of its faces.
-- Try it with a displaced station: waferhand run 30_touch.lua --error A.x=0.25 --error A.z=-0.2 --error A.yaw=0.15
cell "../layouts/touch.lua"

local taught = teach("A", { by = "touch" })
print("\nthe layout should say: " .. taught.text)
print(("standard deviations: %.4f %.4f %.4f mm, %.4f degrees\n"):format(taught.sd[1], taught.sd[2], taught.sd[3], taught.sd_yaw))

-- The simulator knows the true place.
local truth = measure("base", "A")
local off = math.max(math.abs(taught.at[1] - truth.dx), math.abs(taught.at[2] - truth.dy), math.abs(taught.at[3] - truth.dz))
expect(off < 0.02, ("x, y and z within 0.02 mm: off by %.4f"):format(off))
expect(math.abs(math.abs(taught.rpy[3]) - truth.turn) < 0.02, "yaw within 0.02 degrees")
