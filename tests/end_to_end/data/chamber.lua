-- Stations that take time, case by case: params.case names one.
local cases = {}

local function fails(name, word, ...)
  local before = now()
  local ok, problem = pcall(word, ...)
  local found = not ok and type(problem) == "table" and problem.name or tostring(problem)
  expect(found == name, ("%s: %s"):format(name, tostring(problem)))
  expect(now() == before, name .. " comes before anything moves")
end

local function near(value, expected)
  expect(math.abs(value - expected) < 1e-9, ("%.10g, expected %.10g"):format(value, expected))
end

local function bring(slot)
  get("A", slot) open "SLIT" put("PM", 1) close "SLIT"
end

local function fetch(slot)
  open "SLIT" get("PM", 1) close "SLIT" put("A", slot)
end

-- A process: no GET before it has begun, none before its end, to the slice.
function cases.process()
  get("A", 1)
  open "SLIT"
  put("PM", 1)
  fails("PROCESS_RUNNING", get, "PM", 1)
  close "SLIT"
  fails("DOOR_SHUT", get, "PM", 1)
  open "SLIT"
  fails("PROCESS_RUNNING", get, "PM", 1)
  wait_for "PM"
  wait_for "PM"
  get("PM", 1)
  put("A", 1)
  expect_within("W1", "PM", 2)
  -- A wafer whose process has not begun may be taken by force.
  get("A", 1)
  put("PM", 1)
  get("PM", 1, { force = true })
  put("A", 1)
  fails("BAD_ARGUMENT", wait_for, "A")
  fails("NO_SUCH_STATION", wait_for, "PN")
  fails("BAD_ARGUMENT", pump, "PM", "vacuum")
end

-- A stay beyond the window fails the run, unless the script says otherwise.
function cases.late()
  if params.tell then late "tell" end
  bring(1)
  wait_for "PM"
  wait(6)
  fetch(1)
  if params.lies then
    bring(2)
    wait_for "PM"
    wait(5)
  end
end

-- After two wafers comes a clean, with nothing inside and the slit shut.
function cases.clean()
  bring(1) wait_for "PM" fetch(1)
  bring(2) wait_for "PM" open "SLIT" get("PM", 1)
  fails("CLEANING", put, "PM", 1)
  fails("STATION_TIMEOUT", function() local ok, problem = pcall(wait_for, "PM", 0) error(problem, 0) end)
  close "SLIT"
  local begun = now()
  open "SLIT"
  fails("CLEANING", put, "PM", 1)
  wait_for "PM"
  put("PM", 1)
  close "SLIT"
end

-- Two blades: SWAP waits for the process, and leaves no time for a clean that is due.
function cases.swap()
  get("A", 1, { gripper = "EE" }) open "SLIT" put("PM", 1, { gripper = "EE" }) close "SLIT"
  get("A", 2, { gripper = "B2" })
  open "SLIT"
  fails("PROCESS_RUNNING", swap, "PM", 1)
  wait_for "PM"
  swap("PM", 1)
  close "SLIT"
  wait_for "PM"
  open "SLIT"
  fails("CLEANING", swap, "PM", 1)
  put("A", 1, { gripper = "EE" })
  late "tell"
end

-- A load lock: a door opens at its pressure alone, never both, and it pumps with both shut.
function cases.lock()
  fails("WRONG_PRESSURE", open, "VAC")
  open "AIR"
  fails("BOTH_OPEN", open, "VAC")
  fails("DOOR_OPEN", pump, "L", "vacuum")
  get("A", 1)
  put("L", 1)
  close "AIR"
  local begun = now()
  pump("L", "vacuum")
  near(now() - begun, 4)
  pump("L", "vacuum")
  near(now() - begun, 4)
  fails("WRONG_PRESSURE", open, "AIR")
  open "VAC"
  fails("DOOR_OPEN", pump, "L", "atmosphere")
  close "VAC"
  pump("L", "atmosphere")
  near(now() - begun, 8)
  open "AIR"
  get("L", 1)
  close "AIR"
  begun = now()
  pump("L", "vacuum")
  near(now() - begun, 2)
  fails("BAD_ARGUMENT", pump, "L", "air")
  pump("L", "atmosphere")
  put("A", 1)
  -- A door that a fault keeps from shutting: the pressure is right, and the other door must stay shut.
  open "AIR"
  local stuck = fault { kind = "door_stuck", door = "AIR" }
  expect(not pcall(close, "AIR"), "the door is stuck")
  fails("DOOR_OPEN", pump, "L", "vacuum")
  clear_fault(stuck)
  close "AIR"
end

-- Two tasks that open both doors at once: the second one waits for the first, and is refused.
function cases.both()
  local first = task(function() open "AIR" end)
  local second = task(function()
    local ok, problem = pcall(open, "VAC")
    expect(not ok and problem.name == "BOTH_OPEN", tostring(problem))
  end)
  join(first, second)
end

-- While the robot works, a task pumps; a process goes on beside both.
function cases.tasks()
  bring(1)
  local pumped
  local lock = task(function() pump("L", "vacuum") pumped = now() end)
  local opened = task(function()
    local ok, problem = pcall(open, "AIR")
    expect(not ok and problem.name == "WRONG_PRESSURE", tostring(problem))
  end)
  local begun = now()
  get("A", 2)
  join(lock, opened)
  near(pumped - begun, 2)
  put("A", 2)
  wait_for "PM"
  fetch(1)
end

-- Faults make a process and a pump long, or stop them.
function cases.faults()
  fault { kind = "station_slow", station = "L", value = 3 }
  local begun = now()
  pump("L", "vacuum")
  near(now() - begun, 6.001) -- the fault begins with the first slice after the pump has
  local stuck = fault { kind = "station_stuck", station = "PM" }
  bring(1)
  local ok, problem = pcall(wait_for, "PM")
  expect(not ok and problem.name == "STATION_TIMEOUT", tostring(problem))
  clear_fault(stuck)
  begun = now()
  wait_for "PM"
  expect(now() - begun > 4.8 and now() - begun < 5.1, "the whole process is still to come")
  ok, problem = pcall(fault, { kind = "station_slow", station = "A", value = 3 })
  expect(not ok and tostring(problem):find("takes time", 1, true) ~= nil, tostring(problem))
  fetch(1)
end

-- Each error on purpose, before anything moves.
function cases.alarms()
  local function alarm(name, word, ...)
    fault { error = wh.errors[name].number }
    fails(name, word, ...)
  end
  alarm("PROCESS_RUNNING", get, "A", 1)
  alarm("CLEANING", get, "A", 1)
  alarm("WRONG_PRESSURE", open, "AIR")
  alarm("BOTH_OPEN", open, "AIR")
  alarm("DOOR_OPEN", pump, "L", "vacuum")
  alarm("STATION_TIMEOUT", wait_for, "PM")
  wait(0.1)
end

-- A wafer that is taken away while it is processed.
function cases.cut()
  bring(1)
  wait(1)
  fault { kind = "wafer_missing", wafer = "W1" }
  wait(1)
end

cell "chamber_layout.lua"
cases[params.case]()
