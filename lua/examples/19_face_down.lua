-- Wafers that lie face down: the blade takes them by their front faces, the aligner sees them mirrored.
cell "../layouts/face_down.lua"

map("D")
for slot = 1, 2 do
  get("D", slot)   put("P", 1)
  align("P", { angle = 90 })
  get("P", 1)      put("B", slot)
end

for slot = 1, 2 do
  local wafer = ("W%02d"):format(slot)
  expect(face(wafer) == "down", wafer .. " is face down")
  expect_offset(wafer, "B", slot, 0, 0, 0.01)
  expect(math.abs(measure("B/" .. slot, wafer).heading - 90) < 0.01, wafer .. "'s notch points to 90 degrees")
end

-- Nothing moves if the wafer would lie with the wrong face up.
get("U", 3)
local good, problem = pcall(put, "B", 3)
expect(not good and problem.name == "WRONG_FACE", tostring(problem))
