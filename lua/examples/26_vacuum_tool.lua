-- A tool in vacuum: passive blades lift wafers off shelves and pins, and let them down there. No valve is switched
-- except that of the aligner's chuck.
cell "../layouts/vacuum_tool.lua"

-- The wafer goes by way of the aligner, where pins lift it off the chuck and lay it back.
get("LL", 1)       put("AL", 1)
rotate("AL", 90)
lift("AL", "up")   lift("AL", "down")
get("AL", 1)

-- The empty blade takes the wafer on the chamber's pins, the other one lays its wafer there.
swap("PM1", 1)
put("LL", 1, { gripper = "B" })
get("LL", 2)       put("PM2", 1)

expect_offset("W1", "PM1", 1, 0, 0.4, 1e-6)
expect_offset("W2", "PM2", 1, 0, -0.3, 1e-6)
expect_offset("W3", "LL", 1, 0, 0, 1e-6)

-- A wafer lies on the pads like on its support, and a blade with one cannot take another.
get("PM2", 1)
expect(math.abs(measure("A", "W2").dz) < 1e-9, "W2 lies on the pads of A")
local good, problem = pcall(get, "PM1", 1, { gripper = "A" })
expect(not good and problem.name == "WAFER_ON_GRIPPER", tostring(problem))
put("LL", 2)
expect(holder("W2") == nil, "W2 lies on its shelf")
