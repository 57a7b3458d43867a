-- A lot whose carrier arrives late: the robot carries the first lot, from carrier C1, while a vehicle brings C2 to the other load
-- port. C1 goes as soon as its wafers are back. One wafer of C2 stands out too far, and stays.
cell "../layouts/load_ports.lua"

-- Each wafer goes by the aligner and back into its slot.
local function align(from, slot)
  get(from, slot)
  put("ALIGN", 1)
  rotate("ALIGN", 45)
  get("ALIGN", 1)
  put(from, slot)
end

carrier("LP2", { name = "C2", at = params.arrives or 12, slots = { [3] = "protruded" } })

-- Nobody enters a port that is not open.
local ok, problem = pcall(get, "LP2", 1)
expect(not ok and problem.name == "PORT_NOT_OPEN", "LP2 is not open yet")

align("LP1", 1)
align("LP1", 2)
local first = task(function() take_away "LP1" end)

wait_for "LP2"                       -- until it is mapped
for slot, code in ipairs(port_map "LP2") do
  if code == 1 then align("LP2", slot) end
end
ok, problem = pcall(get, "LP2", 3)
expect(not ok and problem.name == "BAD_SLOT", "a wafer that stands out is left")
join(first)

expect_offset("C2.1", "LP2", 1, 0, 0, 0.05)
expect_offset("C2.25", "LP2", 25, 0, 0, 0.05)
expect(select(3, offset("C1.1", "LP1", 1)) < -1000, "C1 has gone with its wafers")
