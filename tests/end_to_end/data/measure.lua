-- measure, distance and angle against closed forms, and their refusals.
cell "measure_layout.lua"

local function near(found, wanted, text)
  expect(math.abs(found - wanted) < 1e-9, ("%s: found %.17g, wanted %.17g"):format(text, found, wanted))
end

-- measured(first, second, { distance, dx, dy, dz, angle, turn }): by all three words.
local function measured(first, second, wanted)
  local found, text = measure(first, second), first .. " to " .. second
  for place, key in ipairs { "distance", "dx", "dy", "dz", "angle", "turn" } do
    near(found[key], wanted[place], text .. ": " .. key)
  end
  expect(distance(first, second) == found.distance and angle(first, second) == found.angle, text .. ": alone")
end

-- Before the first slice the robot is at home.
measured("base", "EE", { math.sqrt(300 * 300 + 900 * 900), 300, 0, 900, 0, 0 })
measured("A", "Wafer", { 5, 3, 4, 0, 0, 0 })
measured("Wafer", "A/3", { math.sqrt(25 + 400), -3, -4, 20, 0, 0 })
measured("P", "base", { math.sqrt(600 * 600 + 950 * 950), -600, 0, -950, 0, 180 })
local half = math.cos(math.rad(1.5)) * math.cos(math.rad(45))
local whole = math.deg(2 * math.atan(math.sqrt(1 - half * half), half))
local sine, cosine = math.sin(math.rad(3)), math.cos(math.rad(3))
measured("A", "B", { 650 * math.sqrt(2), -650, 650, 0, 3, whole })
measured("B", "A", { 650 * math.sqrt(2), -650 * cosine, -650, -650 * sine, 3, whole })

-- If names are equal, a slot or a station comes first; without such a slot it is the wafer.
near(distance("A/3", "A/1"), 20, "the slot A/3")
near(distance("B", "B/1"), 0, "the station B")
measured("B/3", "A/4", { 2, 0, 2, 0, 0, 0 })

-- Between commands: the blade with its wafer, a chuck that has turned.
get("A", 1)
local on_blade = measure("EE", "Wafer")
near(on_blade.dx, 3, "dx on the blade")
near(on_blade.dy, 4, "dy on the blade")
expect(on_blade.dz > 0 and on_blade.dz < 0.5, "within the tolerance")
put("P", 1)
rotate("P", 90)
measured("P", "PA", { 0, 0, 0, 0, 0, 90 })
local dx, dy, dz, tilt = offset("Wafer", "P", 1)
measured("P", "Wafer", { math.sqrt(dx * dx + dy * dy + dz * dz), dx, dy, dz, tilt, 90 })

-- The true place of the gripper, not the one that motion control assumes.
local stood = measure("base", "EE")
local fault_number = fault { kind = "axis_stopped", gripper = "EE" }
line { dx = -20, speed = 100 }
expect(measure("base", "EE").dx == stood.dx, "the blade stood")
clear_fault(fault_number)
wait(0.01)
near(measure("base", "EE").dx - stood.dx, -20, "the blade is where it should be")

local function refused(name, text, ...)
  local ok, problem = pcall(...)
  expect(not ok and problem.name == name and problem.line == 55 and problem.text:find(text, 1, true) ~= nil, tostring(problem))
end
refused("BAD_ARGUMENT", 'measure: "Q/1" (expected "base" or the name', measure, "base", "Q/1")
refused("BAD_ARGUMENT", "distance: 7 (expected", distance, 7, "base")
refused("BAD_ARGUMENT", "angle: nil (expected", angle, "base")
refused("BAD_ARGUMENT", '"B/01" (expected', measure, "B/01", "base")
refused("NO_SUCH_SLOT", "4 (expected 1 to 3 in B)", measure, "B/4", "base")
refused("NO_SUCH_SLOT", "0 (expected 1 to 3 in B)", measure, "B/0", "base")
refused("NO_SUCH_SLOT", '"99999999999999999999" (expected 1 to 3 in B', measure, "base", "B/99999999999999999999")
