-- A wafer that lies 3.25 mm beside the middle of its slot is in the plunger's way: the command reports the distance, the wafer
-- stays there, and a GET that goes there takes it. Then other failures of a plunger follow.
cell "../layouts/edge.lua"

local good, problem = pcall(get, "A", 3)
print(problem)
expect(not good and problem.name == "WAFER_JAMMED" and tostring(problem):find("by 0.750 mm", 1, true) ~= nil)
expect_offset("W03", "A", 3, -3, 1.25, 1e-9)
get("A", 3, { dx = -3, dy = 1.25 })   put("B", 3)

-- No wafer is there, the plunger stands, or creeps, and the sensor is broken.
local function fails(name, fault_kind, value)
  local number = fault_kind and fault { kind = fault_kind, value = value }
  local good, problem = pcall(get, "B", 3)
  expect(not good and problem.name == name, name .. ": " .. tostring(problem))
  print(problem)
  if number then
    clear_fault(number)
  end
  wait(1)
end
fails("PLUNGER_STUCK", "plunger_stuck")
fails("GRIP_TIMEOUT", "plunger_slow", 5)
fails("SENSORS_DISAGREE", "sensor_off")
good, problem = pcall(get, "B", 4)
expect(not good and problem.name == "WAFER_MISSING", tostring(problem))
print(problem)
get("B", 3)   put("A", 3)
expect_offset("W03", "A", 3, 0, 0, 1e-9)
