-- Stays of wafers that are lifted and set down, moved, or brought past the commands: params.case names one.
local cases = {}

local function fails(name, word, ...)
  local ok, problem = pcall(word, ...)
  local found = not ok and type(problem) == "table" and problem.name or tostring(problem)
  expect(found == name, ("%s: %s"):format(name, tostring(problem)))
  return tostring(problem)
end

local function says(text, part)
  expect(text:find(part, 1, true) ~= nil, ("%s: %s"):format(part, text))
end

local function process(slot)
  get("A", slot) open "SLIT" put("PM", 1) close "SLIT" wait_for "PM" open "SLIT"
end

-- A GET that ends with an error has set the wafer down again: it was not taken.
function cases.lifted()
  process(1)
  fault { error = 57 }
  fails("VACUUM_TIMEOUT", get, "PM", 1)
  close "SLIT"
  local begun = now()
  wait_for "PM"
  expect(now() == begun, "it is not processed again")
  open "SLIT"
  wait(10)
  get("PM", 1)
  put("A", 1)
  close "SLIT"
  wait_for "PM"
  expect(now() - begun < 20, "one wafer was there, and no clean is due")
end

-- The blade holds it up inside: until CONTINUE it stays there.
function cases.held()
  process(1)
  get("PM", 1, { stop = "up" })
  wait(10)
  expect_within("W1", "PM", 12)
  continue()
  put("A", 1)
end

-- A fault moves it for a moment, and it comes back: away from its slot, or askew in it.
function cases.moved()
  process(1)
  fault { kind = "wafer_shifted", wafer = "W1", dx = 300, lasting = 0.5 }
  wait(5)
  fault { kind = "wafer_tilted", wafer = "W1", rpy = { 3, 0, 0 }, lasting = 0.5 }
  wait(5)
  get("PM", 1)
  put("A", 1)
end

-- A stop and RECOVER: it has left, and what follows outside does not count.
function cases.left()
  process(1)
  get("PM", 1, { stop = "up" })
  stop()
  recover()
  wait(20)
  expect_within("W1", "PM", 4)
  put("A", 1)
end

-- A wafer beyond the tolerance of its slot is there: no process, no GET, and a load lock is not empty.
function cases.badly()
  get("A", 1) open "SLIT" put("PM", 1)
  local fault_there = fault { kind = "wafer_shifted", wafer = "W1", dx = 60 }
  close "SLIT"
  says(fails("STATION_TIMEOUT", wait_for, "PM"), "W1 in slot 1 has not begun, for it lies badly, 60.000 mm aside")
  open "SLIT"
  says(fails("PROCESS_RUNNING", get, "PM", 1), "it lies badly, 60.000 mm aside")
  clear_fault(fault_there)
  wait(0.1)
  close "SLIT"
  wait_for "PM"
  open "SLIT"
  get("PM", 1) close "SLIT"
  open "AIR" put("L", 1)
  fault { kind = "wafer_shifted", wafer = "W1", dx = 60 }
  close "AIR"
  local begun = now()
  pump("L", "vacuum")
  expect(math.abs(now() - begun - 4) < 1e-9, "it pumps as with a wafer")
end

-- expect_within looks at the last stay, even if that was without a process.
function cases.last()
  process(1)
  get("PM", 1)
  put("PM", 1)
  expect_within("W1", "PM", 4)
  get("PM", 1, { force = true })
  put("A", 1)
  expect_within("W1", "PM", 4)
end

-- A pattern of one's own is prepared, and refused, as a GET or a PUT.
function cases.patterns()
  get("A", 1) open "SLIT" put("PM", 1)
  fails("PROCESS_RUNNING", pattern, "fetch", "PM", 1)
  close "SLIT" wait_for "PM" open "SLIT"
  pattern("fetch", "PM", 1)
  put("A", 1)
  process(2)
  get("PM", 1)
  fails("CLEANING", pattern, "bring", "PM", 1)
end

-- Past all commands a wafer comes into a running clean, and another one is taken before its process.
function cases.past()
  process(1) get("PM", 1) put("A", 1)
  process(2) get("PM", 1) put("A", 2)
  get("A", 3)
  close "SLIT" open "SLIT"
  ready("PM", 1)
  line { dy = 350 } line { dz = -3 } valve("EE", 1) wait(0.2) line { dz = -3 } line { dy = -350 }
  line { dy = 350 } valve("EE", 0) line { dz = 6 } wait(0.2) line { dy = -350 }
end

-- A clean without wafers is due: a PUT waits for it, and one that was begun in time does not.
function cases.idle()
  open "SLIT"
  get("A", 1)
  put("PM", 1)
  close "SLIT"
  wait_for "PM"
  open "SLIT"
  get("PM", 1)
  wait(20)
  fails("CLEANING", put, "PM", 1)
  says(fails("STATION_TIMEOUT", wait_for, "PM", 1), "SLIT is not shut")
  close "SLIT"
  wait_for "PM"
  open "SLIT"
  local ended = now()
  wait(params.idle - 1 - (now() - ended))
  put("PM", 1, { stop = "extended" })
  wait(20)
  continue()
end

-- Around the wafer a clean follows its process: its stay has begun with that.
function cases.around()
  process(1)
  expect_within("W1", "PM", 4)
  get("PM", 1)
  put("A", 1)
end

-- A station that is slow takes its times at least once.
function cases.slow()
  fault { kind = "station_slow", station = "PM", value = 0.5 }
end

if params.case == "patterns" then patterns "chamber_patterns.lua" end
cell(params.layout or "chamber_layout.lua")
cases[params.case]()
