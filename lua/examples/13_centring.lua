-- Centring on the way: the beams at a load lock's door measure the wafer's offset on the blade, and the PUT corrects it.
cell "../layouts/centring.lua"

local function place(wafer, station, slot)
  local dx, dy = offset(wafer, station, slot)
  return ("%s lies in %s with dX %.3f, dY %.3f mm"):format(wafer, station, dx, dy)
end

get("A", 1)
local seen = put("LL", 1)
print(("W1 came %.3f mm along and %.3f mm across the way, give or take %.4f"):format(seen.dx, seen.dy, seen.sd))
expect(math.abs(seen.dx - 1.5) < 0.02 and math.abs(seen.dy + 0.8) < 0.02 and seen.used == 4, "as the layout has it")
print(place("W1", "LL", 1))
expect_offset("W1", "LL", 1, 0, 0, 0.02)

-- A beam meets the rim of this wafer at its notch: the crossing would spoil the centre, so it is left out.
get("A", 2)
seen = put("LL", 2)
for _, crossing in ipairs(seen.crossings) do
  print(("beam %d, %-3s at %9.3f, %8.3f: %s"):format(crossing.beam, crossing.edge, crossing.x, crossing.y, crossing.use))
end
expect(seen.used == 3, "the notch is found")
expect_offset("W2", "LL", 2, 0, 0, 0.02)

-- If two places of the wafer explain the crossings, nothing is corrected and nothing is put down: the blade brings the wafer
-- out again. The script decides what to do then.
get("A", 3)
local ok, problem = pcall(put, "OLD", 1)
expect(not ok and problem.name == "CENTRE_NOT_SURE" and holder("W3") == "EE", "it is still held")
expect(#centring().candidates == 2, "both places are told")
put("OLD", 1, { centre = false })
print(place("W3", "OLD", 1))
expect_offset("W3", "OLD", 1, 0.4, 0.3, 0.01)
