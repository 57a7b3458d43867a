-- Scripts that do what no operator would: params.case names one.
local cases = {}

-- A metamethod runs a command in the middle of another one: that is refused, and both are on record.
function cases.nested_command()
  cell "../../../lua/layouts/paper.lua"
  local evil = setmetatable({}, { __tostring = function() pcall(wait, 0.1) return "evil" end })
  local ok = pcall(valve, "EE", evil)
  expect(not ok, "the valve has no such level")
  wait(0.1)
end

-- A script may use the names of Lua's own functions for its own things.
function cases.globals()
  cell "../../../lua/layouts/paper.lua"
  pairs, ipairs, type, tostring, error = 1, 2, 3, 4, 5
  get("A", 1)
  put("B", 2)
  expect_offset("Wafer 1", "B", 2, 0, 0)
end

-- Errors from within a pattern name the script's line.
function cases.error_lines()
  cell "../../../lua/layouts/paper.lua"
  local _, far = pcall(get, "A", 1, { retract = 5000 })
  expect(far.name == "OUT_OF_REACH" and far.line == 25, "the first: " .. tostring(far))
  local _, high = pcall(line, { dz = 1000 })
  expect(high.name == "LIMIT_EXCEEDED" and high.line == 27, "the second: " .. tostring(high))
end

-- Every argument of every word, and every field of those that are tables, with values of each wrong kind: the error
-- has its number, and names the field, the value and what was expected. Words and fields are those that there are.
function cases.wrong_values()
  cell "../../../lua/layouts/paper.lua"
  local NIL, tried, wrong_errors = {}, 0, {}
  local kinds = { "1", {}, true, 0/0, 1/0, -1/0 }

  local function with(...)
    local list = { ... }
    for _, value in ipairs(kinds) do
      list[#list + 1] = value
    end
    return list
  end

  local function quoted(value)
    return type(value) == "string" and ('"%s"'):format(value) or tostring(value)
  end

  local function try(word, names, value, ...)
    local ok, found = pcall(_G[word], ...)
    local text = not ok and type(found) == "table" and found.text or "no numbered error: " .. tostring(found)
    local good = text:find("^error") and text:find(quoted(value), 1, true) and text:find("expected", 1, true)
    for _, name in ipairs(names) do
      good = good and text:find(name, 1, true)
    end
    tried = tried + 1
    if not good then
      wrong_errors[#wrong_errors + 1] = ("%s %s %s: %s"):format(word, names[1], quoted(value), text)
    end
  end

  -- Arguments: what the error names, a good value, wrong ones.
  local station = { "NO_SUCH_STATION", "P", { "Q", "", 5, {}, true, NIL } }
  local slot = { "NO_SUCH_SLOT", 1, with(0, 2, -1, 1.5, 1e300, NIL) }
  local gripper = { "NO_SUCH_GRIPPER", "EE", { "Q", 5, {}, NIL } }
  local wafer = { "NO_SUCH_WAFER", "Wafer 1", { "Q", 5, {}, NIL } }
  local door = { "door: ", "D", { "Q", 5, {}, true, NIL } }
  local function frames(word)
    local frame = { word .. ": ", "base", { "Q", 5, {}, NIL } }
    return { frame, frame }
  end
  local function number(name, good, ...)
    return { name .. ": ", good, with(NIL, ...) }
  end
  local description = { "", { kind = "leak" }, { 5, true, "leak", NIL } }
  local options = { "options: ", nil, { 5, true, "force" } }

  local words = {
    get = { station, slot, options }, put = { station, slot, options }, swap = { station, slot, options },
    ready = { station, slot, options },
    pattern = { { "pattern: ", "look", { 5, "", {}, true, NIL } }, station, slot, options }, map = { station, options }, home = { options }, recover = { options },
    controller = { { "controller: ", nil, { 5, true, "off" } } },
    continue = {}, stop = {}, centring = {}, teach = { station, options }, rotate = { station, number("degrees", 5) },
    station = { station, options }, set_station = { station, { "axes: ", { z = 950 }, { 5, true, "z", NIL } } },
    edge_scan = { station }, align = { station, { "options: ", nil, { 5, true, "90" } } },
    calibrate = { station, options }, lift = { station, { "where: ", "up", { "left", 5, {}, NIL } } },
    valve = { gripper, number("level", 1, 2, -1, 0.5) }, flip = { gripper, options },
    open = { door }, close = { door },
    move = { { "move: ", {}, { 5, true, "z", NIL } } }, line = { { "line: ", {}, { 5, true, "dz", NIL } } },
    wait_for = { station, { "timeout: ", 0, with(-1, 1e7) } }, now = {},
    pump = { station, { "state: ", "vacuum", { "air", 5, {}, NIL } } },
    carrier = { station, options }, port = { station, { "state: ", "open", { "absent", 5, {}, NIL } } },
    take_away = { station }, port_map = { station },
    late = { { "how: ", "tell", { "never", 5, {}, NIL } } }, expect_within = { wafer, station, number("seconds", 1, -1, 1e7) },
    wait = { number("seconds", 1, -1, 1e7) }, stop_in = { number("seconds", 1, -1, 1e7), { "mechanism: ", nil, { 5, "", "EE", "B", true, {} } } },
    fault = { description }, clear_fault = { number("number", 1, 0, 99, 1.5, 1e300) },
    offset = { wafer, station, slot }, holder = { wafer }, face = { wafer }, proximity = { wafer, gripper },
    measure = frames("measure"), distance = frames("distance"), angle = frames("angle"), hits = {},
    clearance = { { "kind: ", "blade_other", { "blade_others", 5, {}, NIL } } }, expect = {},
    cycle = { { "cycle: ", "A", { 5, {}, true } } },
    robot = { { "NO_SUCH_ROBOT", "robot", { "VAC", 5, true, {}, NIL } } },
    task = { { "body: ", print, { 5, "get", true, {}, NIL } } },
    join = { { "task 1: ", nil, { 5, "get", true, {} } } },
    signal = { { "name: ", "x", { 5, true, {}, NIL } }, { "n: ", 1, with(0, -1, 1.5, 1e7) } },
    await = { { "name: ", "x", { 5, true, {}, NIL } }, { "timeout: ", 0, with(-1, 1e7) } },
    expect_offset = { wafer, station, slot, number("dx", 0), number("dy", 0, 1e7),
      { "tolerance: ", 1, with(0, -1) } },
  }
  -- `flow` has a cell of its own kind: see tests/end_to_end/flows.
  local no_commands = { cell = true, flow = true, patterns = true, study = true, assert = true, error = true, getmetatable = true, ipairs = true,
    load = true, next = true, pairs = true, pcall = true, print = true, rawequal = true, rawget = true, rawlen = true, require = true,
    rawset = true, select = true, setmetatable = true, tonumber = true, tostring = true, type = true, xpcall = true }
  for name, value in pairs(_G) do
    if type(value) == "function" and not words[name] and not no_commands[name] then
      wrong_errors[#wrong_errors + 1] = name .. " is not tried"
    end
  end

  for word, arguments in pairs(words) do
    for place, argument in ipairs(arguments) do
      for _, value in ipairs(argument[3]) do
        local given = {}
        for other, good in ipairs(arguments) do
          given[other] = good[2]
        end
        given[place] = value
        if value == NIL then
          given[place] = nil
        end
        try(word, { argument[1] }, given[place], table.unpack(given, 1, #arguments))
      end
    end
  end

  -- The fields that a command has, as it says itself when there is none of that name; each with no value that any has.
  local function try_fields(word, ...)
    local before = table.pack(...)
    local function call(fields)
      before[before.n + 1] = fields
      return table.unpack(before, 1, before.n + 1)
    end
    local near = ({ move = "thetta", line = "sped", align = "angel" })[word] or "strok"
    try(word, { near .. ": ", "did you mean " }, 5, call { [near] = 5 })
    local _, unknown = pcall(_G[word], call { q = 5 })
    local known = 0
    for name in unknown.text:match("expected ([%w_, ]+)%)"):gmatch("[%w_]+") do
      known = known + 1
      for _, value in ipairs { {}, 0/0, 1/0, -1/0, "wrong" } do
        local number = name == "gripper" and "NO_SUCH_GRIPPER" or name == "robot" and "NO_SUCH_ROBOT"
        try(word, { number or name .. ": " }, value, call { [name] = value })
      end
    end
    return known
  end
  for word, count in pairs { get = 26, put = 25, swap = 31, ready = 19 } do
    expect(try_fields(word, "A", 1) == count, ("%s has %d fields"):format(word, count))
  end
  expect(try_fields("map", "A") == 19 and try_fields("align", "P") == 6 and try_fields("move") == 8 and try_fields("line") == 8, "and so on")
  for field, values in pairs { stroke = with(0, -1, 2000), retract = with(0.5), timeout = with(-1), wait = with(-1),
    release = with(4, -4), retries = with(0.5, -1, 101), pickup_speed = with(0, 501), map_speed = with(0),
    pickup_acceleration = with(-1, 1e-7), offset = with(-1, 7), vacuum_delay = with(3601) } do
    for _, value in ipairs(values) do
      try("get", { field .. ": " }, value, "A", 1, { [field] = value })
    end
  end
  for _, value in ipairs(with(0, -3, 1e-300, 1e5)) do
    try("line", { "speed: ", "mm/s" }, value, { dz = 1, speed = value })
  end
  for _, value in ipairs(with(1e7)) do
    try("line", { "dx: ", "mm" }, value, { dx = value })
  end
  for _, value in ipairs { 1000, -5 } do
    try("move", { "; r: ", "(expected 300 to 900 mm)" }, value, { r = value })
    try("move", { "; yaw: ", "(expected -270 to 270 degrees)" }, value * 300, { yaw = value * 300 })
  end

  -- Faults are read as a layout's are.
  for field, kind in pairs { value = "leak", after = "leak", lasting = "leak", dx = "wafer_shifted", dy = "wafer_shifted" } do
    for _, value in ipairs { "1", true, 0/0, 1/0, -1/0, -2000 } do
      local given = kind == "leak" and { kind = kind, value = 0.5 } or { kind = kind, wafer = "Wafer 1" }
      given[field] = value
      try("fault", { "fault: ", field }, value, given)
    end
  end
  expect(tried > 500, "tried " .. tried)
  expect(#wrong_errors == 0, table.concat(wrong_errors, "\n"))
end

-- The record lies outside of Lua's memory: it must not grow without end.
function cases.endless_record()
  local text = ("x"):rep(1000000)
  while true do
    expect(true, text)
  end
end

-- A STOP after `at` seconds of carrying a wafer from slot 1 of A; then HOME, and the wafer gets to `to` after all.
function cases.stop_anywhere()
  cell "../../../lua/layouts/paper.lua"
  local slot = params.to == "P" and 1 or 3
  stop_in(params.at)
  local finished = pcall(function()
    get("A", 1)
    put(params.to, slot)
  end)
  expect(not finished, "the STOP comes in time")
  local entered, problem = pcall(get, "A", 2)
  expect(not entered and problem.name == "STOPPED", "nothing goes into a station before HOME")
  home()
  local dx, _, dz = offset("Wafer 1", "A", 1)
  if holder("Wafer 1") == nil and math.abs(dx) < 1 and math.abs(dz) < 1 then
    get("A", 1)
  end
  if holder("Wafer 1") == "EE" then
    put(params.to, slot)
  end
  expect_offset("Wafer 1", params.to, slot, 0, 0, 0.01)
end

cases[params.case]()
