-- Frames as object.verb(arguments), each ended by a carriage return: `oROB1.GETW(A,1)`. The controller answers at once,
-- `aROB1.GETW:` and values, or `nROB1.GETW:` and a code; the end of an action is an event, `eROB1.GETW(0000,1.965)`,
-- and so is an event of a wafer: `eROB1.WAFR(picked,1.123,Wafer 1,EE)`. Lengths in mm, angles in degrees, times in s.

local OBJECT = "ROB1"

local subscribed = { wafer = true } -- kinds of events: EVNT changes them
local last_verb = "----" -- of the last frame: a refusal is answered under it
local maps = {}
local found = {} -- the results of the last command of each verb

-- The axes in their order. An axis that the robot does not have is an empty field. From the forearm on, which arms that fold
-- have, empty fields at the end are left out.
local AXES = { "theta", "r", "z", "yaw", "forearm", "rail", "r2", "yaw2", "tilt_x", "tilt_y", "flip" }
local TURNS = { theta = true, yaw = true, forearm = true, yaw2 = true, tilt_x = true, tilt_y = true, flip = true }
local SIGNED = { theta = "theta", r = "r", z = "z", yaw = "yaw" }

local function number(value)
  return ("%.3f"):format(value)
end

-- A name as one argument: marks of the frames would break it up.
local function field(name)
  return (name:gsub("[(),%c]", ";"))
end

-- The most arguments of a verb. Verbs that are not listed hand all arguments to motion control, which checks each.
local MOST = {
  ORGN = 0, GETW = 7, PUTW = 7, EXCH = 7, CONT = 0, GOTO = 7, PLAY = 3, RETR = 0, WMAP = 1, ALGN = 3, TURN = 2, SCAN = 1, CALB = 1,
  TECH = 2, LIFT = 2, FLIP = 1, OPEN = 1, CLOS = 1, PUMP = 2, AWAT = 2, CARR = 2, PORT = 2, TAKE = 1,
  MOVE = 11, LINE = 4, VALV = 2, RSET = 0, SAVE = 1, REST = 1, UNDO = 0, ALRM = 1, STOP = 0, PAUS = 0, RESM = 0, GMAP = 1, GFND = 1, GPOS = 0, STAT = 0, GWAF = 1, GSTN = 2, SSTN = 13, GAXS = 0, GLOC = 1,
  GVER = 0, EVNT = 2,
}

local function decode(frame)
  local object, verb, inside = frame:match("^o(%w+)%.(%w+)%((.*)%)$")
  last_verb = verb or "----"
  if not verb then
    host.refuse("BAD_ARGUMENT", "no oOBJECT.VERB(ARGUMENTS)", "0011")
  end
  if object ~= OBJECT then
    host.refuse("BAD_ARGUMENT", "object " .. object, "0012")
  end
  local arguments = {}
  for field in (inside ~= "" and inside .. "," or ""):gmatch("([^,]*),") do
    arguments[#arguments + 1] = field:match("^%s*(.-)%s*$")
  end
  if #arguments > (MOST[verb] or #arguments) then
    host.refuse("BAD_ARGUMENT", arguments[#arguments], "0011")
  end
  return { command = verb, arguments = arguments }
end

-- (station, slot, arm, phase, dx, dy, dz): the arguments behind the slot may be left out, or empty.
local function transfer(word, prefix)
  return function(request)
    local fields, list = request.arguments, {}
    if (fields[3] or "") ~= "" then
      list[1] = "gripper=" .. host.arm(fields[3])
    end
    local phases = { [""] = "", all = "", extended = "extended", up = "up" }
    local phase = phases[fields[4] or ""] or host.refuse("BAD_ARGUMENT", "phase " .. fields[4])
    if phase ~= "" then
      list[#list + 1] = ("%sstop=%s"):format(prefix, phase)
    end
    for place, name in ipairs({ "dx", "dy", "dz" }) do
      local field = fields[4 + place] or ""
      if field ~= "" then
        list[#list + 1] = ("%s%s=%.17g"):format(prefix, name, host.mm(field))
      end
    end
    return ("%s %s %d %s"):format(word, host.station(fields[1] or ""), host.slot(fields[2] or ""),
      table.concat(list, " "))
  end
end

local function at_station(word)
  return function(request)
    return word .. " " .. host.station(request.arguments[1] or "")
  end
end

local function at_door(word)
  return function(request)
    return word .. " " .. host.door(request.arguments[1] or "")
  end
end

-- (station, angle): without an angle the verb takes `by_itself`, if it has one.
local function turn(word, by_itself)
  return function(request)
    local theirs = request.arguments[2] or by_itself or host.refuse("BAD_ARGUMENT", word)
    return ("%s %s %.17g"):format(word, host.station(request.arguments[1] or ""), host.degrees(theirs))
  end
end

-- (theta, r, z, yaw), (dx, dy, dz, speed), from the first on: each may be empty; `turns` names the angles.
local function values(word, names, turns, axes, first)
  return function(request)
    local list = { word }
    for place, name in ipairs(names) do
      local field, unit = request.arguments[(first or 1) + place - 1] or "", turns[name] and host.degrees or host.mm
      if field ~= "" then
        list[#list + 1] = ("%s=%.17g"):format(name, unit(field, axes and SIGNED[name] or nil))
      end
    end
    return table.concat(list, " ")
  end
end

-- A name, which may have blanks; `may_lack`: it may be missing.
local function with_name(word, may_lack)
  return function(request)
    local name = request.arguments[1] or ""
    return may_lack and name == "" and word or word .. " " .. host.typed(name)
  end
end

-- (station, arm): the arm may be missing.
local function at_station_with(word)
  return function(request)
    local arm = request.arguments[2] or ""
    return ("%s %s%s"):format(word, host.station(request.arguments[1] or ""), arm ~= "" and " gripper=" .. host.arm(arm) or "")
  end
end

-- The values of axes, by name and in their units, as fields.
local function axes_as_fields(at)
  local list, last = {}, 4
  for place, name in ipairs(AXES) do
    list[place] = at[name] and number(at[name]) or ""
    last = at[name] and place > last and place or last
  end
  return table.concat(list, ",", 1, last)
end

-- The positions of the axes in a station.
local function standing(axes)
  local theirs = {}
  for _, name in ipairs(AXES) do
    theirs[name] = axes[name] and (TURNS[name] and host.angle or host.length)(axes[name], SIGNED[name])
  end
  return axes_as_fields(theirs)
end

local function as_typed(word)
  return function(request)
    return word .. " " .. table.concat(request.arguments, " ")
  end
end

local function told(_, result)
  return field((result.answer:gsub("^OK ?", "")))
end

-- Keeps the result for GFND.
local function keep(request, result)
  found[request.command] = told(request, result)
end

-- The state of each arm's sensor: EE:1,PA:0.
local function arms(result)
  local list = {}
  for name, is_on in pairs(result.sensors) do
    list[#list + 1] = field(host.name("arms", name) or name) .. (is_on and ":1" or ":0")
  end
  table.sort(list)
  return table.concat(list, ",")
end

-- By the kinds of events that a host may ask for: what is told of those that befall no wafer, in one argument.
local function with_values(name, values, order)
  local list = { name }
  for _, key in ipairs(order) do
    list[#list + 1] = values[key] and key .. "=" .. tostring(values[key])
  end
  return table.concat(list, ";")
end

local function at_controller(event)
  return event.value and ("%s;%d"):format(event.at, event.value) or event.at
end

local function at_gripper(event)
  return ("%s;%d"):format(event.gripper, event.value)
end

local OF_KIND = {
  sensor = at_gripper, valve = at_gripper, hold = at_controller, position = at_controller,
  error = function(event) return event.at .. ";" .. host.code(event.value) end,
  door = function(event) return event.door .. ";" .. (event.value or "-") end,
  mode = function(event) return with_values(event.at, event.controller, { "power", "brakes", "estop", "servo", "mode", "exceeded" }) end,
  port = function(event) return with_values(event.at, event.load_port, { "is", "does", "carrier", "failed" }) end,
  grip = function(event) return event.gripper .. ";" .. event.grip end,
}

local function position(_, result)
  return axes_as_fields(result.position)
end

-- Our name of a load port that this controller may tell of: a load port's own controller knows no other.
local function own_port(theirs, status)
  local name = host.station(theirs)
  local own = host.mechanism(name)
  if not status[name .. ".is"] or own ~= name and status[own .. ".is"] then
    host.refuse("NO_SUCH_STATION", name)
  end
  return name
end

return {
  name = "frames as object.verb(arguments)",
  framing = { ends = { "\r", "\r\n" }, longest = 512, timeout = 5 },
  events = { "wafer", "sensor", "valve", "hold", "position", "error", "door", "mode", "port", "grip" },
  gone = function() subscribed = { wafer = true } end,
  decode = decode,

  commands = {
    ORGN = { does = "HOME" },
    GETW = { does = "GET", run = transfer("GET", "") },
    PUTW = { does = "PUT", run = transfer("PUT", "") },
    EXCH = { does = "SWAP", run = transfer("SWAP", "put_") },
    CONT = { does = "CONTINUE" },
    WAIT = { does = "WAIT", run = as_typed("WAIT") },
    PLAY = { does = "PATTERN", run = function(request)
      local fields = request.arguments
      return ("PATTERN %s %s %d"):format(host.typed(fields[1] or ""), host.station(fields[2] or ""), host.slot(fields[3] or ""))
    end },
    GOTO = { does = "READY", run = transfer("READY", "") },
    RETR = { does = "RECOVER" },
    WMAP = { does = "MAP", run = at_station("MAP"), answer = function(request, result)
      maps[request.arguments[1] or ""] = tostring(result.values.codes)
    end },
    ALGN = { does = "ALIGN", run = function(request)
      local mode = request.arguments[3] or ""
      if mode ~= "" and mode ~= "robot" and mode ~= "stage" and mode ~= "pins" then
        host.refuse("BAD_ARGUMENT", mode)
      end
      return turn("ALIGN", 0)(request) .. (mode ~= "" and " mode=" .. mode or "")
    end, answer = keep },
    TURN = { does = "ROTATE", run = turn("ROTATE") },
    SCAN = { does = "EDGE_SCAN", run = at_station("EDGE_SCAN"), answer = keep },
    CALB = { does = "CALIBRATE", run = at_station("CALIBRATE"), answer = keep },
    TECH = { does = "TEACH", run = function(request)
      local keeps, switch = { [""] = "", keep = " keep=true" }, request.arguments[2] or ""
      return at_station("TEACH")(request) .. (keeps[switch] or host.refuse("BAD_ARGUMENT", switch))
    end, answer = keep },
    LIFT = { does = "LIFT", run = function(request)
      return ("LIFT %s %s"):format(host.station(request.arguments[1] or ""), request.arguments[2] or "")
    end },
    FLIP = { does = "FLIP", run = function(request) return "FLIP " .. host.arm(request.arguments[1] or "") end },
    OPEN = { does = "OPEN", run = at_door("OPEN") },
    CLOS = { does = "CLOSE", run = at_door("CLOSE") },
    PUMP = { does = "PUMP", run = function(request)
      local sides, side = { vacuum = "vacuum", atmosphere = "atmosphere" }, request.arguments[2] or ""
      return ("PUMP %s %s"):format(host.station(request.arguments[1] or ""), sides[side] or host.refuse("BAD_ARGUMENT", side))
    end },
    AWAT = { does = "WAIT_FOR", run = function(request)
      local seconds = request.arguments[2] or ""
      return ("WAIT_FOR %s %s"):format(host.station(request.arguments[1] or ""),
        seconds:match("^%d*%.?%d*$") or host.refuse("BAD_ARGUMENT", seconds))
    end },
    CARR = { does = "CARRIER", run = function(request)
      local name = request.arguments[2] or ""
      return ("CARRIER %s%s"):format(host.station(request.arguments[1] or ""), name ~= "" and " name=" .. host.typed(name) or "")
    end },
    PORT = { does = "PORT", run = function(request)
      local state = (request.arguments[2] or ""):match("^%l+$") or host.refuse("BAD_ARGUMENT", "PORT")
      return ("PORT %s %s"):format(host.station(request.arguments[1] or ""), state)
    end },
    TAKE = { does = "TAKE_AWAY", run = function(request)
      return "TAKE_AWAY " .. host.station(request.arguments[1] or "")
    end },
    MOVE = { does = "MOVE", run = values("MOVE", AXES, TURNS, true) },
    LINE = { does = "LINE", run = values("LINE", { "dx", "dy", "dz", "speed" }, {}) },
    VALV = { does = "VALVE", run = function(request)
      local levels, switch = { on = 0, off = 1 }, request.arguments[2] or ""
      local level = levels[switch] or host.refuse("BAD_ARGUMENT", switch)
      return ("VALVE %s %d"):format(host.arm(request.arguments[1] or ""), level)
    end },
    RSET = { does = "RESET", answer = function()
      maps, found = {}, {}
    end },
    SAVE = { does = "SAVE", run = with_name("SAVE") },
    REST = { does = "RESTORE", run = with_name("RESTORE") },
    UNDO = { does = "UNDO" },
    FALT = { does = "FAULT", run = as_typed("FAULT"), answer = keep },
    ALRM = { does = "ALARM", run = function(request) return "ALARM " .. host.alarm(request.arguments[1] or "") end,
      answer = keep },
    CLER = { does = "CLEAR", run = as_typed("CLEAR") },
    STOP = { does = "STOP" },
    PAUS = { does = "HOLD" },
    RESM = { does = "RESUME" },
    GMAP = { does = "LOCAL", run = function(request)
      return maps[request.arguments[1] or ""] or host.refuse("NOT_MAPPED", request.arguments[1])
    end, answer = told },
    GFND = { does = "LOCAL", run = function(request)
      return found[request.arguments[1] or ""] or host.refuse("BAD_ARGUMENT", request.arguments[1])
    end, answer = function(_, result) return result.answer end },
    CTRL = { does = "CONTROLLER", run = function(request)
      local name, value = request.arguments[1] or "", request.arguments[2] or ""
      if not name:find("^%a+$") or not value:find("^%a+$") then
        host.refuse("BAD_ARGUMENT", name .. "," .. value)
      end
      return ("CONTROLLER %s=%s"):format(name, value)
    end },
    EVNT = { does = "LOCAL", run = function(request)
      local kind = request.arguments[1] or ""
      if kind ~= "wafer" and not OF_KIND[kind] then
        host.refuse("BAD_ARGUMENT", kind)
      end
      local on = request.arguments[2]
      if on ~= "on" and on ~= "off" then
        host.refuse("BAD_ARGUMENT", on)
      end
      subscribed[kind] = on == "on"
      return ""
    end },
    SPED = { does = "CONTROLLER", run = function(request)
      local percent = tonumber(request.arguments[1]) or host.refuse("BAD_ARGUMENT", request.arguments[1])
      return ("CONTROLLER override=%.17g"):format(percent / 100)
    end },
    GPMP = { does = "PORT_MAP", run = at_station("PORT_MAP"), answer = function(request, result)
      return tostring(result.values.codes or host.refuse("NOT_MAPPED", request.arguments[1]))
    end },
    GPRT = { does = "STATUS", answer = function(request, result)
      local name, list = own_port(request.arguments[1] or "", result.status), {}
      for place, part in ipairs({ "carrier", "does", "is", "left" }) do
        list[place] = field(tostring(result.status[name .. "." .. part] or ""))
      end
      return table.concat(list, ",")
    end },
    GCTL = { does = "CONTROLLER", answer = told },
    GPOS = { does = "STATUS", answer = position },
    STAT = { does = "STATUS", answer = function(_, result)
      return ("%s,%s,%s"):format(result.state, host.code(result.status.error) or "0000", arms(result))
    end },
    GWAF = { does = "STATUS", answer = function(request, result)
      local arm = host.arm(request.arguments[1] or "")
      local sensor = result.sensors[arm]
      return sensor == nil and host.refuse("NO_SUCH_GRIPPER", arm) or sensor and "1" or "0"
    end },
    GSTN = { does = "STATIONS STATION", run = function(request)
      return request.arguments[1] and at_station_with("STATION")(request) or "STATIONS"
    end, answer = function(request, result)
      return request.arguments[1] and standing(result.values) or told(request, result)
    end },
    SSTN = { does = "SET_STATION", run = function(request)
      local axes = values("", AXES, TURNS, true, 3)
      return at_station_with("SET_STATION")(request) .. axes(request)
    end },
    GAXS = { does = "AXES", answer = told },
    GLOC = { does = "WHERE", run = with_name("WHERE", true), answer = told },
    GVER = { does = "VERSION", answer = function(_, result) return result.values.version end },
  },

  encode = {
    acknowledge = function(request) return ("a%s.%s:"):format(OBJECT, request.command) end,
    answer = function(request, result)
      local text = result.ok and result.reply or result.code or ""
      return ("%s%s.%s:%s"):format(result.ok and "a" or "n", OBJECT, request.command, text)
    end,
    complete = function(request, result)
      local code = result.ok and "0000" or result.code
      return ("e%s.%s(%s,%s)"):format(OBJECT, request.command, code, number(result.seconds))
    end,
    -- An unknown verb is cut to the room that a line has beside the code.
    refuse = function(request, failure)
      return ("n%s.%s:%s"):format(OBJECT, (request.command or last_verb):sub(1, 60), failure.code)
    end,
    bad = function() return ("n%s.----:0010"):format(OBJECT) end,
    event = function(event)
      local own = OF_KIND[event.kind]
      if not subscribed[own and event.kind or "wafer"] then
        return nil
      elseif own then
        return ("e%s.EVNT(%s,%s,%s)"):format(OBJECT, event.kind, number(event.seconds), field(own(event)))
      end
      return ("e%s.WAFR(%s,%s,%s,%s)"):format(OBJECT, event.kind, number(event.seconds), field(event.wafer),
        field(event.gripper))
    end,
  },

  errors = {
    NO_SUCH_COMMAND = "0021", BAD_ARGUMENT = "0022", BUSY = "0023", STOPPED = "0024", OUT_OF_BUDGET = "0025",
    NOT_IN_PHASE = "0026", IN_PHASE = "0027", BAD_VALVE = "0028", NO_SUCH_SAVE = "0029", NOTHING_TO_UNDO = "0030",
    NOT_RESTORED = "0031", RUN_OVER = "0032", NO_ANSWER = "0033", DEADLOCK = "0034",
    NO_SUCH_STATION = "0041", NO_SUCH_SLOT = "0042", NO_SUCH_GRIPPER = "0043", NOT_TAUGHT = "0044",
    NOT_A_PREALIGNER = "0045", NOT_MAPPED = "0046", BAD_SLOT = "0047", CORRECTION_TOO_LARGE = "0048",
    NO_SUCH_WAFER = "0049", NO_SUCH_ROBOT = "0050", AMBIGUOUS_ROBOT = "0051",
    BAD_LIMITS = "0061", OUT_OF_REACH = "0062", LIMIT_EXCEEDED = "0063", NOT_LEVEL = "0064", NOT_HOMED = "0065",
    COLLISION_AHEAD = "0066", NOT_ALONG_ARM = "0067", SLIP_AHEAD = "0068",
    WAFER_MISSING = "0081", NO_WAFER_ON_GRIPPER = "0082", WAFER_ON_GRIPPER = "0083", WAFER_LOST = "0084",
    WAFER_ALREADY_THERE = "0085", VACUUM_TIMEOUT = "0086", VACUUM_BEFORE_PICK = "0087", WAFER_LOST_ON_WAY = "0088",
    WAFER_JAMMED = "0089", PLUNGER_STUCK = "0090", GRIP_TIMEOUT = "0091", UNGRIP_TIMEOUT = "0092",
    SENSORS_DISAGREE = "0093", WRONG_FACE = "0094", WRONG_SLOT = "0095",
    TOO_FEW_SAMPLES = "0101", NO_NOTCH = "0102", TWO_NOTCHES = "0103", OFF_SENSOR = "0104", TOO_ECCENTRIC = "0105",
    CENTRE_NOT_SURE = "0106", NOTCH_NOT_SURE = "0107", BAD_SCAN = "0108", NOT_TOUCHED = "0109",
    PINS_UP = "0121", DOOR_SHUT = "0122", DOOR_BLOCKED = "0123", DOOR_TIMEOUT = "0124", FLIP_TIMEOUT = "0125",
    FLIP_NOT_CLAMPED = "0126", PROCESS_RUNNING = "0127", CLEANING = "0128", STATION_TIMEOUT = "0129",
    WRONG_PRESSURE = "0130", BOTH_OPEN = "0131", DOOR_OPEN = "0132",
    PORT_NOT_OPEN = "0133", PORT_ENTERED = "0134", NO_CARRIER = "0135", CARRIER_THERE = "0136",
    HANDSHAKE_TIMEOUT = "0137",
    NO_POWER = "0141", BRAKES_SET = "0142", EMERGENCY_STOP = "0143", SERVO_ERROR = "0144", SOFT_LIMIT = "0145", WRONG_MODE = "0146",
  },
  other_error = "0999",
  states = { idle = "idle", running = "moving", held = "paused" },
}
