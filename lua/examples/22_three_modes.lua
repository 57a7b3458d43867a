-- Three ways to correct a wafer's offset on a prealigner: the robot goes to its place, a stage shifts the chuck, or pins hold
-- the wafer while the stage brings the chuck below its middle, for a second grip.
cell "../layouts/stage.lua"

print("")
print("mode     eccentricity    after: dx      dy   off the chuck's axis   seconds")
for slot, mode in ipairs { "robot", "stage", "pins" } do
  get("A", slot)   put("P", 1)
  local found = align("P", { angle = 90, mode = mode })
  local on_chuck = measure("PA", ("W%02d"):format(slot))
  print(("%-8s %12.3f %11.4f %7.4f %21.4f %10.3f"):format(mode, found.eccentricity, found.after_dx, found.after_dy,
    math.sqrt(on_chuck.dx ^ 2 + on_chuck.dy ^ 2), found.seconds))
  get("P", 1)   put("A", slot)
  expect_offset(("W%02d"):format(slot), "A", slot, 0, 0, 0.001)
  expect(math.abs(measure("A/" .. slot, ("W%02d"):format(slot)).heading - 90) < 0.01, "its notch points to 90 degrees")
end
print("")
