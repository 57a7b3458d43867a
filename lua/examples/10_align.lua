-- A wafer lies beside its middle and turned: the prealigner measures that, turns the notch, and the next GET corrects the rest.
cell "../layouts/sensor.lua"

get("A", 1)   put("P", 1)
local found = align("P", { angle = 90 })
print(("it was %.3f mm off the axis, its notch at %.2f degrees"):format(found.eccentricity, found.notch))
expect(math.abs(found.dx - 1.5) < 0.001 and math.abs(found.dy + 0.8) < 0.001, "that is how it lay in A")
expect(math.abs(found.notch - 37) < 0.01 and math.abs(found.after_notch - 90) < 0.01, "the notch went from 37 to 90 degrees")

-- The chuck only turns, so the wafer's offset stays. The GET goes there, so it lies in the middle of the blade, and then of A.
expect(math.abs(found.correction - found.eccentricity) < 0.001, "it still is as far off the axis")
get("P", 1)   put("A", 1)
expect_offset("W01", "A", 1, 0, 0, 0.001)
expect(math.abs(measure("A/1", "W01").heading - 90) < 0.01, "its notch points to 90 degrees in A")
