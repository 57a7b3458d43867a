-- Load ports, case by case: params.case names one.
local cases = {}

local function fails(name, word, ...)
  local before = now()
  local ok, problem = pcall(word, ...)
  local found = not ok and type(problem) == "table" and problem.name or tostring(problem)
  expect(found == name, ("%s: %s"):format(name, tostring(problem)))
  return now() - before, tostring(problem)
end

-- Refused before anything moves.
local function refused(name, word, ...)
  local took, said = fails(name, word, ...)
  expect(took == 0, name .. " comes before anything moves")
  return said
end

local function near(value, expected)
  expect(math.abs(value - expected) < 1e-9, ("%.10g, expected %.10g"):format(value, expected))
end

local function codes(station)
  return table.concat(port_map(station), "")
end

-- A robot enters an open one alone.
function cases.states()
  get("A", 1)
  for _, word in ipairs { { put, "LP1", 1 }, { ready, "LP1", 1 }, { map, "LP1" }, { get, "LP1", 1, { gripper = "EE" } } } do
    refused("PORT_NOT_OPEN", table.unpack(word))
  end
  refused("NO_CARRIER", port, "LP1", "open")
  refused("NO_CARRIER", take_away, "LP1")
  refused("BAD_ARGUMENT", port, "A", "open")
  refused("BAD_ARGUMENT", port, "LP2", "absent")
  refused("BAD_ARGUMENT", take_away, "A")
  refused("BAD_ARGUMENT", port_map, "A")
  -- A layout's wafers lie in a carrier that is open when a run begins.
  put("LP2", 1)
  local begun = now()
  port("LP2", "docked")
  near(now() - begun, 2.5)
  refused("PORT_NOT_OPEN", get, "LP2", 1)
  port("LP2", "mapped")
  near(now() - begun, 2.5 + 2 + 1.5)
  expect(codes "LP2" == "110", codes "LP2")
  refused("WAFER_MISSING", get, "LP2", 3)
  port("LP2", "open")
  get("LP2", 1)
  put("LP2", 3)
  port("LP2", "placed")
  near(port_map("LP2")[3], 0)
  -- One that comes now begins with the next slice: the port waits for it, though nothing else takes time before.
  take_away "LP2"
  carrier("LP2", { name = "C2" })
  port("LP2", "clamped")
end

-- A carrier that comes late, by vehicle; what lies in it goes with it, and comes again.
function cases.late()
  expect(carrier("LP1", { name = "C1", wafers = { 1, 3 }, at = 30 }) == "C1", "its name")
  refused("CARRIER_THERE", carrier, "LP2", { name = "C1" })
  refused("PORT_NOT_OPEN", get, "LP1", 1)
  get("A", 1)
  wait_for "LP1"
  near(now(), 30 + 0.5 + 0.5 + 10 + 1 + 0.5 + 1 + 3 + 5 + 4)
  expect(codes "LP1" == "10100", codes "LP1")
  expect_offset("C1.1", "LP1", 1, 0, 0)
  put("LP1", 2)
  get("LP1", 1)
  put("A", 2)
  take_away "LP1"
  refused("PORT_NOT_OPEN", get, "LP1", 2)
  refused("NO_CARRIER", take_away, "LP1")
  expect_offset("C1.1", "A", 2, 0, 0)
  local dz = select(3, offset("W1", "LP1", 2))
  expect(dz < -1e4, "W1 is no longer in the cell")
  -- Those that were left out stay away, until they are asked for; a slot whose wafer is in the cell has none.
  carrier("LP1", { name = "C1" })
  wait_for "LP1"
  expect(codes "LP1" == "01100", codes "LP1")
  get("LP1", 2)
  put("A", 3)
  expect_offset("W1", "A", 3, 0, 0)
  take_away "LP1"
  refused("BAD_ARGUMENT", carrier, "LP1", { name = "C1", wafers = { 1 } })
  carrier("LP1", { name = "C1", wafers = { 4, 5 } })
  wait_for "LP1"
  expect(codes "LP1" == "00011", codes "LP1")
end

-- One carrier after another at one port: the second vehicle waits until the first carrier is gone.
function cases.queue()
  take_away "LP2"
  local begun = now()
  carrier("LP2", { name = "C2" })
  carrier("LP2", { name = "LP2", at = begun + 1 })
  wait_for "LP2"
  near(now() - begun, 0.001 + 2 + 0.5 + 1 + 2)
  get("LP2", 3)
  carrier("LP1", { name = "C1" })
  refused("NO_CARRIER", carrier, "LP1")
  take_away "LP2"
  wait_for "LP2"
  put("LP2", 3)
  expect_offset("C2.3", "LP2", 3, 0, 0)
  expect_offset("W2", "LP2", 2, 0, 0)
  take_away "LP2"
  take_away "LP1"
  carrier("LP1", { name = "LP2" })
  wait_for "LP1"
  expect(codes "LP1" == "01100", codes "LP1")
  expect_offset("C2.3", "LP1", 3, 0, 0)
end

-- The codes that the mapper gives, by limits of its own.
function cases.mapper()
  carrier("LP1", { slots = { [1] = "protruded", [2] = "double", [4] = "crossed", [5] = "empty" } })
  wait_for "LP1"
  expect(codes "LP1" == "32044", codes "LP1")
  local said = refused("BAD_SLOT", get, "LP1", 1)
  expect(said:find("protruded", 1, true) ~= nil, said)
  refused("BAD_SLOT", get, "LP1", 3)
  refused("BAD_SLOT", get, "LP1", 5)
  take_away "LP1"
  -- It comes again as it went.
  carrier("LP1", { name = "C1" })
  wait_for "LP1"
  expect(codes "LP1" == "32044", codes "LP1")
end

-- A wafer that stands out by 20 mm is protruded by a limit of 10 mm, and not by that of MAP, which is 30.
function cases.limit()
  fault { kind = "wafer_shifted", wafer = "W2", dx = -20 }
  port("LP2", "mapped")
  expect(codes "LP2" == "010", codes "LP2")
  carrier("LP1", { name = "C2" })
  wait_for "LP1"
  fault { kind = "wafer_shifted", wafer = "C2.3", dx = -20 }
  port("LP1", "docked")
  port("LP1", "mapped")
  expect(codes "LP1" == (params.protruded and "10300" or "10100"), codes "LP1")
end

-- A blade inside keeps the carrier where it is.
function cases.entered()
  get("LP2", 2, { stop = "extended" })
  stop()
  refused("PORT_ENTERED", take_away, "LP2")
  refused("PORT_ENTERED", port, "LP2", "docked")
  recover()
  get("LP2", 2)
  take_away "LP2"
  expect(holder "W2" == "EE", "a wafer on the blade is not in the carrier")
  put("A", 2)
end

-- Each step of the handshake, stuck: its timer runs out, coming and going. Late by more than its timer, too.
function cases.handshake()
  local limits, begins = { 2, 2, 60, 60, 2 }, { 0, 0.5, 1, 11, 12 }
  for step = 1, 5 do
    local stuck = fault { kind = "e84_stuck", station = "LP1", step = "tp" .. step }
    local begun = now()
    carrier("LP1", { name = "C1" })
    local took, said = fails("HANDSHAKE_TIMEOUT", wait_for, "LP1")
    near(took, 0.001 + begins[step] + limits[step])
    expect(said:find("TP" .. step, 1, true) ~= nil, said)
    clear_fault(stuck)
    if step > 3 then
      port("LP1", "mapped")
      expect(codes "LP1" == "11111", codes "LP1")
      take_away "LP1"
    end
  end
  carrier("LP1", { name = "C1" })
  wait_for "LP1"
  for step = 1, 5 do
    local stuck = fault { kind = "e84_late", station = "LP1", step = "tp" .. step, value = 100 }
    local took, said = fails("HANDSHAKE_TIMEOUT", take_away, "LP1")
    expect(said:find("TP" .. step, 1, true) ~= nil, said)
    clear_fault(stuck)
    if step > 3 then
      refused("NO_CARRIER", take_away, "LP1")
      carrier("LP1", { name = "C1" })
      wait_for "LP1"
    end
  end
  fault { kind = "e84_late", station = "LP1", step = "tp1", value = 1 }
  local begun = now()
  take_away "LP1"
  near(now() - begun, 5 + 3 + 1 + 0.5 + 1 + 0.5 + 10 + 1 + 0.5)
  refused("BAD_ARGUMENT", function() fault { kind = "e84_late", station = "LP2", step = "tp1", value = 1 } end)
end

-- Steps that are slow, or stand.
function cases.faults()
  fault { kind = "station_slow", station = "LP2", value = 3 }
  wait(0.01)
  local begun = now()
  port("LP2", "docked")
  near(now() - begun, 7.5)
  local stuck = fault { kind = "station_stuck", station = "LP2" }
  local took = fails("STATION_TIMEOUT", port, "LP2", "open")
  near(took, 62)
  clear_fault(stuck)
  wait_for "LP2"
end

-- A robot works while carriers come and go beside it; a port is left alone while a command uses it.
function cases.tasks()
  local gone, taken
  local operator = task(function()
    carrier("LP1", { name = "C1", wafers = 2 })
    wait_for "LP1"
    signal "there"
    take_away "LP2"
    gone = now()
  end)
  get("LP2", 2)
  taken = now()
  put("A", 2)
  await "there"
  get("LP1", 1)
  put("A", 3)
  join(operator)
  expect(gone > taken, "the carrier stayed until the wafer was out")
  expect_offset("W2", "A", 2, 0, 0)
  local both = task(function() take_away "LP1" end)
  wait(0.1)
  local ok, problem = pcall(get, "LP1", 2)   -- waits for the port, which is then empty
  expect(not ok and problem.name == "PORT_NOT_OPEN", tostring(problem))
  join(both)
end

-- A handshake that fails, and no word that tells it.
function cases.untold()
  fault { kind = "e84_stuck", station = "LP1", step = "tp2" }
  carrier("LP1", { name = "C1" })
  wait(10)
end

-- A carrier that is still to come when the script ends.
function cases.never()
  carrier("LP1", { name = "C1", at = 1000 })
  wait(1)
end

function cases.alarms()
  local function alarm(name, word, ...)
    fault { error = wh.errors[name].number }
    refused(name, word, ...)
  end
  alarm("PORT_NOT_OPEN", get, "A", 1)
  alarm("PORT_ENTERED", take_away, "LP2")
  alarm("NO_CARRIER", take_away, "LP2")
  alarm("CARRIER_THERE", carrier, "LP1")
  alarm("HANDSHAKE_TIMEOUT", wait_for, "LP2")
  wait(0.1)
end

-- Arguments that are no good.
function cases.arguments()
  refused("BAD_ARGUMENT", carrier, "A")
  refused("NO_SUCH_STATION", carrier, "LP3")
  refused("BAD_ARGUMENT", carrier, "LP1", { nam = "C1" })
  refused("BAD_ARGUMENT", carrier, "LP1", { name = "C3" })
  refused("BAD_ARGUMENT", carrier, "LP1", { at = -1 })
  refused("BAD_ARGUMENT", carrier, "LP1", { at = "soon" })
  refused("BAD_ARGUMENT", carrier, "LP1", { wafers = 6 })
  refused("BAD_ARGUMENT", carrier, "LP1", { wafers = { 6 } })
  refused("BAD_ARGUMENT", carrier, "LP1", { wafers = "all" })
  refused("BAD_ARGUMENT", carrier, "LP1", { slots = { [9] = "crossed" } })
  refused("BAD_ARGUMENT", carrier, "LP1", { slots = { [1] = "bent" } })
  refused("BAD_ARGUMENT", carrier, "LP1", { slots = { [5] = "double" } })
  refused("BAD_ARGUMENT", carrier, "LP1", { slots = "crossed" })
  refused("BAD_ARGUMENT", carrier, "LP2", { name = "C1" })
end

cell "ports_layout.lua"
cases[params.case]()
