-- Doors and flippers, case by case: params.case names one.
local cases = {}

local function fails(name, word, ...)
  local ok, problem = pcall(word, ...)
  local found = not ok and type(problem) == "table" and problem.name or tostring(problem)
  expect(found == name, ("%s: %s"):format(name, found))
end

-- A shut door is reported before any motion through it; READY stays before it, and LINE and MOVE are checked.
function cases.shut()
  fails("DOOR_SHUT", get, "LL", 1)
  fails("DOOR_SHUT", put, "LL", 1)
  fails("DOOR_SHUT", map, "LL")
  ready("LL", 1)
  fails("COLLISION_AHEAD", line, { dy = -350 })
  open "DOOR"
  open "DOOR"
  ready("LL", 1)
  map("LL")
  close "DOOR"
end

-- A robot in a phase, or left by a STOP, keeps the door from closing.
function cases.blocked()
  open "DOOR"
  get("A", 1)
  put("FLIPPER", 1)
  flip "FLIPPER"
  get("FLIPPER", 1)
  put("LL", 1, { stop = "up" })
  fails("DOOR_BLOCKED", close, "DOOR")
  open "DOOR"
  continue()
  stop_in(0.5)
  fails("STOPPED", get, "LL", 1)
  fails("DOOR_BLOCKED", close, "DOOR")
  home()
  close "DOOR"
end

-- GET and PUT wait for a door that opens, and CLOSE waits for them; a GET that comes first does not wait.
function cases.waits()
  local opening = task(function() open "DOOR" end)
  wait(0.1)
  local before = task(function() get("LL", 1) end)
  wait(0.1)
  local closing = task(function() close "DOOR" end)
  fails("WAFER_MISSING", join, before)
  join(opening, closing)
  local late = task(function() wait(0.1) open "DOOR" end)
  fails("DOOR_SHUT", get, "LL", 1)
  join(late)
end

-- Faults, and each error by its number.
function cases.faults()
  fault { kind = "door_stuck", door = "DOOR", lasting = 2.5 }
  fails("DOOR_TIMEOUT", open, "DOOR")
  fails("DOOR_SHUT", get, "LL", 1)
  wait(2)
  open "DOOR"
  local slow = fault { kind = "door_slow", door = "DOOR", value = 60 }
  fails("DOOR_TIMEOUT", close, "DOOR")
  fails("DOOR_SHUT", get, "LL", 1)
  clear_fault(slow)
  close "DOOR"
  stop_in(0.2)
  fails("STOPPED", open, "DOOR")
  fails("DOOR_SHUT", get, "LL", 1)   -- no RECOVER comes first: no robot has moved
  open "DOOR"
  stop_in(0.2, "DOOR")
  fails("STOPPED", close, "DOOR")
  get("A", 1)
  put("A", 1)
  open "DOOR"
  for number, word in pairs { [97] = function() get("LL", 1) end, [98] = function() close "DOOR" end } do
    fault { error = number }
    fails(number == 97 and "DOOR_SHUT" or "DOOR_BLOCKED", word)
  end
  fault { error = 106 }
  fails("DOOR_TIMEOUT", close, "DOOR")
  close "DOOR"
  fails("BAD_ARGUMENT", open, "GATE")
  fails("BAD_ARGUMENT", fault, { kind = "door_stuck", door = "GATE" })
  fails("BAD_ARGUMENT", fault, { kind = "door_slow", door = "DOOR", value = -1 })
end

-- Two flips bring a wafer back to the bit; it is taken face down, and each reason that stops a flip has a number.
function cases.flips()
  fails("FLIP_NOT_CLAMPED", flip, "FLIPPER")
  get("A", 1)
  put("FLIPPER", 1)
  local x, y, z = offset("W01", "FLIPPER", 1)
  flip "FLIPPER"
  local x1, y1 = offset("W01", "FLIPPER", 1)
  expect(math.abs(x1 - x) < 1e-12 and math.abs(y1 + y) < 1e-12, "mirrored about x")
  expect(face("W01") == "down", "face down")
  flip "CLAMP"
  local x2, y2, z2 = offset("W01", "FLIPPER", 1)
  expect(x2 == x and y2 == y and z2 == z and face("W01") == "up", "back again")
  fails("WAFER_ALREADY_THERE", put, "FLIPPER", 1, { vacuum_check = "none" })
  stop_in(0.4)
  fails("STOPPED", flip, "FLIPPER")
  recover()
  fails("NOT_LEVEL", get, "FLIPPER", 1)
  flip "FLIPPER"
  fault { error = 104 }
  fails("FLIP_TIMEOUT", flip, "FLIPPER")
  fault { error = 105 }
  fails("FLIP_NOT_CLAMPED", flip, "FLIPPER")
  local held = fault { kind = "axis_stopped", gripper = "CLAMP" }
  wait(0.01)
  fails("FLIP_TIMEOUT", flip, "FLIPPER")
  fails("FLIP_TIMEOUT", get, "FLIPPER", 1)
  clear_fault(held)
  wait(0.01)
  fails("NOT_A_PREALIGNER", rotate, "FLIPPER", 5)
  get("FLIPPER", 1, { stop = "extended" })
  fails("IN_PHASE", flip, "FLIPPER")
  continue()
  put("A", 4)
end

-- Another task's GET waits until the flipper has turned.
function cases.turning()
  get("A", 1)
  put("FLIPPER", 1)
  local turning = task(function() flip "FLIPPER" end)
  wait(0.1)
  get("FLIPPER", 1)
  join(turning)
  expect(face("W01") == "down", "turned before it was taken")
end

cell "../../../lua/layouts/load_lock.lua"
cases[params.case]()
