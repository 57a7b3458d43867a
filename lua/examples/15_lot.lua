-- A lot goes by way of the prealigner from one FOUP to another; the script prints each wafer's place before and after.
local wafers = { "W01", "W02", "W03", "W04" }

study {
  shape = "uniform", placement = { dx = 1.5, dy = 1.5, turn = 45 },
  stations = { P = { x = 0.014, y = 0.014, yaw = 0.03 }, B = { x = 0.014, y = 0.014, yaw = 0.03 } },
}
cell "../layouts/lot.lua"

print("")
print("wafer    before: dx      dy   notch   after: dx      dy    notch  seconds")
for slot, wafer in ipairs(wafers) do
  get("A", slot)   put("P", 1)
  local found = align("P")
  get("P", 1)   put("B", slot)

  -- Its true place includes the robot's own error, and with `waferhand study` the error of teaching.
  local slot_frame = ("B/%d"):format(slot)
  local dx, dy = offset(wafer, "B", slot)
  local notch = measure(slot_frame, wafer).heading
  print(("%s      %8.3f%8.3f%8.2f   %8.4f%8.4f%9.4f%9.3f"):format(
    wafer, found.dx, found.dy, found.notch, dx, dy, notch, found.seconds))
  expect(math.sqrt(dx * dx + dy * dy) <= 0.05, wafer .. " lies in the middle, to 0.05 mm")
  expect(math.abs(notch) <= 0.1, wafer .. " points to 0 degrees, to 0.1")
end
print("")
