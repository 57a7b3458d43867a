-- A GET that enters 2 mm too high scrapes the wafer. The run fails, as it should, and names both parts.
cell "../layouts/scrape.lua"

-- At the taught height, 2.1 mm below the slot, the blade passes beneath a wafer whose front lies 0.5 mm low.
get("C", 2)   put("C", 10)
expect(#hits() == 0, "nothing is hit on the way in that was taught")
local gap, limit = clearance("blade_wafer_above")
expect(gap > 1.5 and gap > limit, "the blade keeps 1.5 mm from the wafer above")

-- 0.1 mm below the slot the blade has no room; where it comes to rest, the vacuum takes the wafer too early.
local ok, problem = pcall(get, "C", 4, { stroke = 2 })
expect(not ok and problem.name == "VACUUM_BEFORE_PICK", "the sensor is on before the stroke")
local hit = hits()[1]
expect(hit.parts[1]:find("^EE ") and hit.parts[2] == "W04", "the blade hits W04")
print(("%.3f s: %s hits %s at x %.1f, y %.1f, z %.2f"):format(hit.time, hit.parts[1], hit.parts[2], table.unpack(hit.at)))
