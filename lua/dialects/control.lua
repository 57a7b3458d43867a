-- The port of a tester beside the hosts, `waferhand serve --control ADDRESS:PORT`: a JSON object a line, one answer each.
--
--     {"id": 1, "line": "WHERE \"Wafer 1\""}        a line of the prompt
--     {"rate": 10}                                  the pace of simulated time; 0: as fast as possible
--     {"subscribe": ["picked", "sensor", "error"]}  events that are told here from now on; [] none
--     {"tell": "estop on"}                          to the controllers whose dialect has a function `tester`
--
-- Answers have `ok`, `answer` and, of an error, `number`, `name` and `text`; `id` comes back. An event is {"event": "picked", ...}.

local escapes = { b = "\b", f = "\f", n = "\n", r = "\r", t = "\t" }
local subscribed = {} -- by a client's number, the kinds of events that it wants

-- ------------------------------------------------------------------------------------------------------------- reading

local read

local function fail(what)
  host.refuse("BAD_ARGUMENT", ("%s (expected a JSON object such as {\"line\": \"STATUS\"})"):format(what))
end

local function read_text(text, at)
  local parts = {}
  while true do
    local stop = text:find('["\\]', at) or fail("a text without an end")
    parts[#parts + 1] = text:sub(at, stop - 1)
    if text:sub(stop, stop) == '"' then
      return table.concat(parts), stop + 1
    end
    local sign = text:sub(stop + 1, stop + 1)
    local code = sign == "u" and text:match("^%x%x%x%x", stop + 2)
    if sign == "u" and not code then
      fail("\\u without four digits")
    end
    parts[#parts + 1] = code and utf8.char(tonumber(code, 16)) or escapes[sign] or sign
    at = stop + (code and 6 or 2)
  end
end

local function skip(text, at)
  return text:find("[^ \t\r]", at) or #text + 1
end

-- The items of a list or an object up to its closing sign; each(at) reads one and returns where it ends.
local function read_items(text, at, closing, each)
  at = skip(text, at)
  if text:sub(at, at) == closing then
    return at + 1
  end
  while true do
    at = skip(text, each(at))
    local sign = text:sub(at, at)
    if sign == closing then
      return at + 1
    elseif sign ~= "," then
      fail(("%s or a comma is missing at byte %d"):format(closing, at))
    end
    at = skip(text, at + 1)
  end
end

local WORDS = { { "true", true }, { "false", false }, { "null", nil } }

-- A value and where it ends. Nothing lies deeper than a list in an object.
function read(text, at, depth)
  local sign = text:sub(at, at)
  if sign == '"' then
    return read_text(text, at + 1)
  elseif sign == "[" and depth < 3 then
    local list = {}
    return list, read_items(text, at + 1, "]", function(from)
      local value, to = read(text, from, depth + 1)
      list[#list + 1] = value
      return to
    end)
  elseif sign == "{" and depth < 3 then
    local object = {}
    return object, read_items(text, at + 1, "}", function(from)
      if text:sub(from, from) ~= '"' then
        fail(("a name is missing at byte %d"):format(from))
      end
      local name, to = read_text(text, from + 1)
      to = skip(text, to)
      if text:sub(to, to) ~= ":" then
        fail(("a colon is missing at byte %d"):format(to))
      end
      object[name], to = read(text, skip(text, to + 1), depth + 1)
      return to
    end)
  end
  for _, word in ipairs(WORDS) do
    if text:find(word[1], at, true) == at then
      return word[2], at + #word[1]
    end
  end
  local number = text:match("^-?%d+%.?%d*[eE]?[+-]?%d*", at)
  if not number or not tonumber(number) then
    fail(("no value at byte %d"):format(at))
  end
  return tonumber(number), at + #number
end

-- ------------------------------------------------------------------------------------------------------------- writing

local signs = { ['"'] = '\\"', ["\\"] = "\\\\", ["\b"] = "\\b", ["\f"] = "\\f", ["\n"] = "\\n", ["\r"] = "\\r", ["\t"] = "\\t" }

local function write(value)
  if type(value) == "string" then
    return '"' .. value:gsub('[%c"\\\127]', function(sign)
      return signs[sign] or ("\\u%04x"):format(sign:byte())
    end) .. '"'
  end
  return math.type(value) == "float" and ("%.15g"):format(value) or tostring(value)
end

-- Fields in their order; those without a value are left out.
local function object(...)
  local fields, list = table.pack(...), {}
  for place = 1, fields.n, 2 do
    if fields[place + 1] ~= nil then
      list[#list + 1] = write(fields[place]) .. ":" .. write(fields[place + 1])
    end
  end
  return "{" .. table.concat(list, ",") .. "}"
end

-- The longest answer, bytes: a frame has 4,096.
local LONGEST = 4000

local function told(request, result)
  local error = not result.ok
  local text = object("id", request.id, "ok", result.ok, "answer", result.ok and (result.reply or result.answer) or nil,
    "number", error and result.number or nil, "name", error and result.name or nil, "text", error and result.answer or nil)
  if #text > LONGEST then
    return object("id", request.id, "ok", false, "number", 48, "name", "BAD_ARGUMENT",
      "text", ("an answer of %d bytes (expected one for less, at most %d)"):format(#text, LONGEST))
  end
  return text
end

-- ------------------------------------------------------------------------------------------------------------ requests

local KINDS = { line = "string", rate = "number", subscribe = "table", tell = "string" }

local function decode(frame, client)
  local at = skip(frame, 1)
  if frame:sub(at, at) ~= "{" then
    fail(frame:sub(1, 100))
  end
  local given, to = read(frame, at, 1)
  if skip(frame, to) <= #frame then
    fail(("more behind the object, at byte %d"):format(skip(frame, to)))
  end
  local what
  for name, value in pairs(given) do
    if name ~= "id" then
      if what or KINDS[name] == nil or type(value) ~= KINDS[name] then
        fail(("%s (one of line, rate, subscribe, tell)"):format(name))
      end
      what = name
    elseif type(value) ~= "number" and (type(value) ~= "string" or #value > 64) then
      fail("id: no number, and no text of at most 64 bytes")
    end
  end
  if what == "line" then
    local line = given.line:match("^%s*(.-)%s*$")
    if line == "" then
      fail("line: no word")
    end
    return { command = line:match("^%S+"):upper(), line = line, id = given.id }
  end
  return { command = what or fail("no line, rate, subscribe or tell"), value = given[what], id = given.id, client = client.number }
end

local kinds = {}
for _, kind in ipairs(known.kinds) do
  kinds[kind] = true
end

local commands = {
  rate = { does = "RATE", run = function(request) return ("RATE %.17g"):format(request.value) end },
  tell = { does = "TELL", run = function(request) return "TELL " .. request.value:gsub("[%c]", " ") end },
  subscribe = { does = "LOCAL", run = function(request)
    local wanted = {}
    for _, kind in ipairs(request.value) do
      if type(kind) ~= "string" then
        fail("subscribe: no list of kinds of events")
      elseif not kinds[kind] then
        host.refuse("BAD_ARGUMENT", ("subscribe: %s (expected some of %s%s)"):format(kind, table.concat(known.kinds, ", "), known.meant(kind, known.kinds)))
      end
      wanted[kind] = true
    end
    subscribed[request.client] = wanted
    return "OK"
  end },
}

-- A tester moves nothing but carriers, which people and vehicles bring: the rest is the hosts' part.
local WORDS_OF_THE_PROMPT = [[FAULT ALARM CLEAR CONTROLLER WAIT CARRIER TAKE_AWAY STATUS VERSION OFFSET HOLDER PROXIMITY MEASURE DISTANCE ANGLE WHERE AXES STATIONS STATION PORT_MAP HELP]]
for word in WORDS_OF_THE_PROMPT:gmatch("%S+") do
  commands[word] = { does = word, run = function(request) return request.line end }
end

-- ALARM WAFER_MISSING: an error by its name, in any case.
commands.ALARM.run = function(request)
  local name = request.line:match("^%S+%s+(%a[%w_]*)$")
  local entry = wh.errors[(name or ""):upper()]
  if name and not entry then
    host.refuse("BAD_ARGUMENT", ("ALARM: %s (expected the number or the name of an error%s)"):format(name, known.meant(name, known.errors)))
  end
  return entry and ("ALARM %d"):format(entry.number) or request.line
end

local errors = {}
for name, entry in pairs(wh.errors) do
  errors[name] = name ~= "OK" and entry.number or nil
end

return {
  name = "JSON lines of a tester",
  framing = { ends = { "\n", "\r\n" }, longest = 4096 },
  second_client = "share",
  events = { "wafer", "sensor", "valve", "hold", "position", "error", "door", "mode", "port", "grip" },
  decode = decode,
  commands = commands,
  gone = function(client) subscribed[client.number] = nil end,

  encode = {
    answer = told,
    complete = told,
    refuse = function(request, failure)
      local detail = failure.detail ~= "" and "; " .. failure.detail or ""
      return object("id", request.id, "ok", false, "number", failure.number, "name", failure.name, "text", (failure.text .. detail):sub(1, 500))
    end,
    bad = function(reason) return object("ok", false, "number", 48, "name", "BAD_ARGUMENT", "text", "no line: " .. reason) end,
    event = function(event)
      if not (subscribed[event.client] or {})[event.kind] then
        return nil
      end
      local own, load_port = event.controller or {}, event.load_port or {}
      return object("event", event.kind, "seconds", event.seconds, "wafer", event.wafer ~= "" and event.wafer or nil,
        "gripper", event.gripper ~= "" and event.gripper or nil, "value", event.value, "port", event.at, "door", event.door, "power", own.power, "brakes", own.brakes, "estop", own.estop,
        "servo", own.servo, "mode", own.mode, "exceeded", own.exceeded, "override", own.override,
        "is", load_port.is, "does", load_port.does, "carrier", load_port.carrier, "failed", load_port.failed,
        "grip", event.grip, "excess", event.grip == "jammed" and event.excess or nil)
    end,
  },
  errors = errors,
  other_error = 48,
  states = { idle = "idle", running = "running", held = "held" },
}
