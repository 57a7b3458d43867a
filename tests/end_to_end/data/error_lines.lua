-- Errors from within a pattern name the script's line.
cell "../../../lua/layouts/paper.lua"
local _, far = pcall(get, "A", 1, { retract = 5000 })
expect(far.name == "OUT_OF_REACH" and far.line == 3, "the first: " .. tostring(far))
local _, slow = pcall(line, { dz = 1, speed = 1e-300 })
expect(slow.name == "BAD_SEGMENT" and slow.line == 5, "the second: " .. tostring(slow))
