-- Motions at a station, and its owner, case by case: params.case names one.
local cases = {}

local function fails(name, word, ...)
  local ok, problem = pcall(word, ...)
  local found = not ok and type(problem) == "table" and problem.name or tostring(problem)
  expect(found == name, ("%s: %s"):format(name, found))
  return problem
end

local function is_near(text, ...)
  local values = { ... }
  for i = 1, #values, 2 do
    expect(math.abs(values[i] - values[i + 1]) < 1e-6, ("%s: %.9g, not %.9g"):format(text, values[i], values[i + 1]))
  end
end

-- A wafer that pins lift is still in its slot, above it by the pins' height, and comes down at its old place.
function cases.pins()
  cell "together_layout.lua"
  get("A", 1)
  put("P", 1)
  local x, y, z = offset("W01", "P", 1)
  is_near("put down", x, 1.5, y, -0.8)
  lift("P", "up")
  local x1, y1, z1 = offset("W01", "P", 1)
  is_near("lifted", x1, x, y1, y)
  expect(z1 > 4 and z1 < 5.5, "as far up as the pins are")
  fails("PINS_UP", get, "P", 1)
  get("A", 2)
  fails("PINS_UP", put, "P", 1)
  lift("P", "down")
  expect_offset("W01", "P", 1, x, y, 1e-6)
  is_near("settled", select(3, offset("W01", "P", 1)), z)
  fails("WAFER_ALREADY_THERE", put, "P", 1)
  put("A", 3)
  get("P", 1)
  put("A", 1)
  expect_offset("W01", "A", 1, 1.5, -0.8, 1e-6)
end

-- GET and PUT wait for pins that move: one that was asked for before, and one that was not.
function cases.waits()
  cell "together_layout.lua"
  get("A", 1)
  put("P", 1)
  lift("P", "up")
  local lowering = task(function() lift("P", "down") end)
  wait(0.01)
  get("P", 1)
  join(lowering)
  local raising = task(function() lift("P", "up") end)
  wait(0.01)
  fails("PINS_UP", put, "P", 1)
  join(raising)
  local late = task(function() wait(0.1) lift("P", "down") end)
  fails("PINS_UP", put, "P", 1)
  join(late)
  put("P", 1, { stop = "extended" })
  fails("DEADLOCK", lift, "P", "up")   -- it would wait for its own robot
  continue()
  expect_offset("W01", "P", 1, 1.5, -0.8, 1e-6)
end

-- A slot that the stage has shifted: the wafer's offset goes along, the book knows it, and the next PUT brings it home.
function cases.stage()
  cell "together_layout.lua"
  get("A", 1)
  put("P", 1)
  local found = align("P", { mode = "stage", angle = 90 })
  is_near("after", found.after_dx, 0, found.after_dy, 0)
  local aside = measure("P/1", "PA")
  expect(math.sqrt(aside.dx ^ 2 + aside.dy ^ 2) > 1.6, "the stage has gone aside")
  expect_offset("W01", "P", 1, 0, 0, 2e-3)
  get("A", 2)
  fails("WAFER_ALREADY_THERE", put, "P", 1)
  put("A", 2)
  lift("P", "up")
  local x, y = offset("W01", "P", 1)
  expect(math.abs(x) < 2e-3 and math.abs(y) < 2e-3, "the pins have it where it was")
  lift("P", "down")
  expect_offset("W01", "P", 1, 0, 0, 2e-3)
  get("P", 1)
  put("A", 1)
  expect_offset("W01", "A", 1, 0, 0, 2e-3)
  get("A", 2)
  put("P", 1)
  local home = measure("P/1", "PA")
  is_near("the stage is home", home.dx, 0, home.dy, 0)
  expect_offset("W02", "P", 1, 0, 0, 1e-6)
end

-- A MAP waits for its door like a GET, and a shut door is seen ahead from within the station, too.
function cases.map()
  cell "../../../lua/layouts/load_lock.lua"
  local opening = task(function() open "DOOR" end)
  wait(0.1)
  local codes = map("LL")
  join(opening)
  expect(#codes == 2 and codes[1] == 0, "mapped through the open door")
  local mapping = task(function() return map("LL") end)
  wait(0.1)
  close "DOOR"
  expect(#join(mapping) == 2, "the door has waited for the MAP")
  fails("DOOR_SHUT", map, "LL")
  ready("LL", 1)
  fails("COLLISION_AHEAD", line, { dy = -350 })
end

-- In a phase a robot keeps its station, and the other one waits until CONTINUE has brought it out.
function cases.phase()
  cell "../../../lua/layouts/two_robots.lua"
  local ATM, VAC, order = robot "ATM", robot "VAC", {}
  ATM:get("FROM", 1)
  ATM:put("IN", 1)
  ATM:get("FROM", 2)
  VAC:get("IN", 1, { stop = "extended" })
  expect(fails("DEADLOCK", function() ATM:put("IN", 1) end).text:find("VAC stands in station IN", 1, true) ~= nil,
    "who stands there")
  local putting = task(function() ATM:put("IN", 1) order[#order + 1] = "put" end)
  wait(0.5)
  fails("IN_PHASE", function() VAC:ready("PM", 1) end)
  VAC:continue()
  order[#order + 1] = "taken"
  join(putting)
  expect(table.concat(order, " ") == "taken put", table.concat(order, " "))
  expect(holder("W1") == "VAC blade", "VAC has it")
  expect_offset("W2", "IN", 1, 0, 0, 1e-6)
end

-- A STOP of one robot leaves it in the station, and the other one waits for its RECOVER; a STOP of all ends its wait.
function cases.stopped()
  cell "../../../lua/layouts/two_robots.lua"
  local ATM, VAC = robot "ATM", robot "VAC"
  ATM:get("FROM", 1)
  local entering = task(function() VAC:get("IN", 1) end)
  stop_in(1.6, "VAC")
  fails("STOPPED", join, entering)
  local putting = task(function() ATM:put("IN", 1) end)
  wait(0.5)
  expect(holder("W1") == "ATM blade", "it waits")
  stop_in(0.3)
  fails("STOPPED", wait, 1)
  fails("STOPPED", join, putting)
  -- A WAIT has no robot, and ATM has only waited: neither leaves it where RECOVER would have to come first.
  putting = task(function() ATM:put("IN", 1) end)
  wait(0.2)
  expect(holder("W1") == "ATM blade", "it waits again")
  VAC:recover()
  join(putting)
  expect_offset("W1", "IN", 1, 0, 0, 1e-6)
end

cases[params.case]()
