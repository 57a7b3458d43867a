-- An edge grip pushes each wafer onto its rests, so that all lie alike on the blade, except for their diameters and for a notch
-- over a rest. The aligner turns notches away from the rests; the GET after it needs no correction.
cell "../layouts/edge.lua"

-- The offset of a gripped wafer of this radius from the blade's middle: rests of 1.5 mm at 30 degrees, nominal radius 150.
local function seated(radius)
  local out, across = 151.5 * math.cos(math.rad(30)), 151.5 * math.sin(math.rad(30))
  return out - math.sqrt((radius + 1.5) ^ 2 - across ^ 2)
end

-- Its notch points to a rest: the wafer sinks in there, and so moves not only along the blade.
get("A", 2)   put("B", 3)
local dx, dy = offset("W02", "B", 3)
expect(math.abs(dx - seated(149.95)) > 0.1 and math.abs(dy) > 0.1, "a notch over a rest")
get("B", 3)   put("A", 2)

for slot, radius in ipairs { 150.1, 149.95 } do
  local name = ("W%02d"):format(slot)
  get("A", slot)   put("P", 1)
  local found = align("P", { angle = 90 })
  get("P", 1)   put("B", slot)
  local dx, dy = offset(name, "B", slot)
  print(("%s: its notch was at %.2f degrees; dX %.6f mm, by its diameter"):format(name, found.notch, dx))
  expect(math.abs(dx - seated(radius)) < 1e-9 and math.abs(dy) < 1e-9, "it lies as its diameter has it")
  expect(math.abs(measure("B/" .. slot, name).heading - 90) < 0.01, "its notch points to 90 degrees")
end
