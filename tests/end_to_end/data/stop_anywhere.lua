-- A STOP after `at` seconds of carrying a wafer from slot 1 of A; then HOME, and the wafer gets to `to` after all.
cell "../../../lua/layouts/paper.lua"
local slot = params.to == "P" and 1 or 3
stop_in(params.at)
local finished = pcall(function()
  get("A", 1)
  put(params.to, slot)
end)
expect(not finished, "the STOP comes in time")
local entered, problem = pcall(get, "A", 2)
expect(not entered and problem.name == "STOPPED", "nothing goes into a station before HOME")
home()
local dx, _, dz = offset("Wafer 1", "A", 1)
if holder("Wafer 1") == nil and math.abs(dx) < 1 and math.abs(dz) < 1 then
  get("A", 1)
end
if holder("Wafer 1") == "EE" then
  put(params.to, slot)
end
expect_offset("Wafer 1", params.to, slot, 0, 0, 0.01)
