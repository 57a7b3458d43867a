-- Frames as `$`-comma telegrams: `$,unit,sequence,COMMAND,arguments,sum` and a carriage return. The controller
-- acknowledges at once, `$,unit,sequence,status,code,sum`; an action ends with a second telegram,
-- `!,unit,sequence,status,code,COMMAND,ms,theta,r,z,yaw,sum`, which the host answers with ACKN. An event of a wafer is
-- told as `>,unit,EVNT,...,sum`. The sum counts all bytes from the first comma to the one before the sum, as two hex
-- digits. Lengths are whole um, angles whole 0.001 degrees, times whole ms of the simulated clock.

local UNIT = host.unit("1")

local subscribed = { wafer = true } -- kinds of events: CEVT changes them

local status = "0"         -- 0 idle, 1 running, 2 held
local last_sequence = "00" -- of the last telegram: a refusal is answered under it
local maps = {}            -- the last map of each station
local found = {}           -- the results of the last command of each name

-- The axes in their order. An axis that the robot does not have is an empty field. From the forearm on, which arms that fold
-- have, empty fields at the end are left out.
local AXES = { "theta", "r", "z", "yaw", "forearm", "rail", "r2", "yaw2", "tilt_x", "tilt_y", "flip" }
local TURNS = { theta = true, yaw = true, forearm = true, yaw2 = true, tilt_x = true, tilt_y = true, flip = true }
local SIGNED = { theta = "theta", r = "r", z = "z", yaw = "yaw" }

local function whole(number)
  return ("%d"):format(math.floor(number + 0.5))
end

local function split(frame)
  local fields = {}
  for field in (frame .. ","):gmatch("([^,]*),") do
    fields[#fields + 1] = field
  end
  return fields
end

---------------------------------------------------------------------------------------------------------- requests

-- CSTP and MTRS are two commands each: their first argument says which.
local BY_ARGUMENT = { CSTP = true, MTRS = true }

-- The most arguments of a command. Commands that are not listed hand all arguments to motion control, which checks each.
local MOST = {
  INIT = 0, ["MTRS,G"] = 7, ["MTRS,P"] = 7, ["MTRS,E"] = 7, MTRN = 0, MRDY = 7, MPAT = 3, MRTR = 0, MMAP = 1, MALN = 3, MROT = 2,
  MSCN = 1, MCAL = 1, MTCH = 2, MLFT = 2, MFLP = 1, MDOP = 1, MDCL = 1, MABS = 11, MLIN = 4, CVAC = 2, MWAT = 1, MAWT = 2, MPMP = 2, MCAR = 2,
  MPRT = 2, MTKA = 1, CRST = 0,
  CSAV = 1, CRES = 1, CUND = 0, CEVT = 2, CALM = 1, ["CSTP,H"] = 0, ["CSTP,E"] = 0, CRSM = 0, ACKN = 0, RMAP = 1, RFND = 1, RPOS = 0,
  RSTS = 0, RWFR = 1, RSTN = 2, CSTN = 13, RAXS = 0, RLOC = 1, RVER = 0,
}

local function decode(frame)
  local fields = split(frame:sub(2)) -- the fields behind the comma that follows the start
  last_sequence = (fields[2] or ""):match("^%d%d$") or "00"
  if fields[1] ~= UNIT then
    host.refuse("BAD_ARGUMENT", "unit " .. tostring(fields[1]), "0014")
  end
  if fields[2] ~= last_sequence then
    host.refuse("BAD_ARGUMENT", "sequence number", "0015")
  end
  local name, first = fields[3] or "", 4
  if BY_ARGUMENT[name] then
    name, first = name .. "," .. (fields[4] or ""), 5
  end
  if #fields - first + 1 > (MOST[name] or #fields) then
    host.refuse("BAD_ARGUMENT", fields[#fields])
  end
  return { command = name, sequence = last_sequence, arguments = { table.unpack(fields, first) } }
end

-- The phase in which a transfer stops: G4 and P4, or none, mean the whole transfer.
local PHASES = { [""] = "", G4 = "", P4 = "", G2 = "extended", P2 = "extended", G3 = "up", P3 = "up" }

-- Offsets, and the phase in which it stops: "" for an empty field.
local function options(fields, prefix)
  local list = {}
  local phase = PHASES[fields[4] or ""] or host.refuse("BAD_ARGUMENT", "phase " .. fields[4])
  if phase ~= "" then
    list[1] = ("%sstop=%s"):format(prefix, phase)
  end
  for place, name in ipairs({ "dx", "dy", "dz" }) do
    local field = fields[4 + place]
    if field and field ~= "" then
      list[#list + 1] = ("%s%s=%.17g"):format(prefix, name, host.mm(field))
    end
  end
  return table.concat(list, " ")
end

-- station, slot, arm, phase, x, y, z as `WORD STATION SLOT gripper=ARM ...`.
local function transfer(word, prefix)
  return function(request)
    local fields = request.arguments
    local arm = (fields[3] or "") ~= "" and "gripper=" .. host.arm(fields[3]) or ""
    return ("%s %s %d %s %s"):format(word, host.station(fields[1] or ""), host.slot(fields[2] or ""), arm,
      options(fields, prefix))
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

-- station, angle: without an angle the command takes `by_itself`, if it has one.
local function turn(word, by_itself)
  return function(request)
    local theirs = request.arguments[2] or by_itself or host.refuse("BAD_ARGUMENT", word)
    return ("%s %s %.17g"):format(word, host.station(request.arguments[1] or ""), host.degrees(theirs))
  end
end

-- Fields from `first` on, which may be empty, as `NAME=VALUE ...`; `turns` names the angles. The axes have signs of their own.
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

local function as_said(word)
  return function(request)
    return word .. " " .. table.concat(request.arguments, " ")
  end
end

-- A station, and an arm, which may be missing.
local function at_station_with(word)
  return function(request)
    local arm = request.arguments[2] or ""
    return ("%s %s%s"):format(word, host.station(request.arguments[1] or ""), arm ~= "" and " gripper=" .. host.arm(arm) or "")
  end
end

-- One of two letters, as our word for it.
local function choose(field, choices)
  return choices[field or ""] or host.refuse("BAD_ARGUMENT", field)
end

--------------------------------------------------------------------------------------------------------- answers

local CODES = { ["0"] = "--", ["1"] = "OK", ["2"] = "DW", ["4"] = "CW" }

local function keep_map(request, result)
  local list = {}
  for code in tostring(result.values.codes):gmatch(".") do
    list[#list + 1] = ("%02d:%s"):format(#list + 1, CODES[code] or code)
  end
  maps[request.arguments[1] or ""] = table.concat(list, ",")
end

-- A text of ours as one field: marks of the frames would break it up.
local function field(text)
  return (tostring(text):gsub("[,$!>%c]", ";"))
end

local function telegram(mark, sequence, code, rest)
  local head = "," .. table.concat({ UNIT, sequence, status, code }, ",")
  return rest and head .. "," .. rest or head, mark
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

local function told(_, result)
  return field(result.answer:gsub("^OK ?", ""))
end

-- The values of axes, by name and in their units, as fields.
local function axes_as_fields(at)
  local list, last = {}, 4
  for place, name in ipairs(AXES) do
    list[place] = at[name] and whole(at[name]) or ""
    last = at[name] and place > last and place or last
  end
  return table.concat(list, ",", 1, last)
end

local function position(result)
  return axes_as_fields(result.position)
end

-- The positions of the axes in a station.
local function standing(axes)
  local theirs = {}
  for _, name in ipairs(AXES) do
    theirs[name] = axes[name] and (TURNS[name] and host.angle or host.length)(axes[name], SIGNED[name])
  end
  return axes_as_fields(theirs)
end

-- The kinds of events that a host may ask for, and what is told of those that befall no wafer, in one field.
local KINDS = { WAFER = "wafer", SENSOR = "sensor", VALVE = "valve", HOLD = "hold", POSITION = "position", ERROR = "error", DOOR = "door", MODE = "mode",
  PORT = "port", GRIP = "grip" }

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

-- Keeps the result for RFND.
local function keep(request, result)
  found[request.command] = told(request, result)
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
  name = "frames as $-comma telegrams",
  framing = {
    start = "$", replies = { "$", "!", ">" }, ends = { "\r", "\r\n" }, sum = "add", separator = ",",
    sums_separator = true, shortest = 4, longest = 512, timeout = 1,
  },
  units = { length = 0.001, angle = 0.001 },
  unit_of = function(frame) return split(frame:sub(2))[1] end,
  events = { "wafer", "sensor", "valve", "hold", "position", "error", "door", "mode", "port", "grip" },
  gone = function() subscribed = { wafer = true } end,
  decode = decode,

  commands = {
    INIT = { does = "HOME" },
    ["MTRS,G"] = { does = "GET", run = transfer("GET", "") },
    ["MTRS,P"] = { does = "PUT", run = transfer("PUT", "") },
    ["MTRS,E"] = { does = "SWAP", run = transfer("SWAP", "put_") },
    MTRN = { does = "CONTINUE" },
    MPAT = { does = "PATTERN", run = function(request)
      local fields = request.arguments
      return ("PATTERN %s %s %d"):format(host.typed(fields[1] or ""), host.station(fields[2] or ""), host.slot(fields[3] or ""))
    end },
    MRDY = { does = "READY", run = transfer("READY", "") },
    MRTR = { does = "RECOVER" },
    MMAP = { does = "MAP", run = at_station("MAP"), answer = keep_map },
    MALN = { does = "ALIGN", run = function(request)
      local mode = request.arguments[3] or ""
      return turn("ALIGN", 0)(request) .. (mode ~= "" and " mode=" .. choose(mode, { R = "robot", S = "stage", P = "pins" }) or "")
    end, answer = keep },
    MROT = { does = "ROTATE", run = turn("ROTATE") },
    MSCN = { does = "EDGE_SCAN", run = at_station("EDGE_SCAN"), answer = keep },
    MCAL = { does = "CALIBRATE", run = at_station("CALIBRATE"), answer = keep },
    MTCH = { does = "TEACH", run = function(request)
      local keep = choose(request.arguments[2] or "0", { ["0"] = "", ["1"] = " keep=true" })
      return at_station("TEACH")(request) .. keep
    end, answer = keep },
    MLFT = { does = "LIFT", run = function(request)
      local where = choose(request.arguments[2], { U = "UP", D = "DOWN" })
      return ("LIFT %s %s"):format(host.station(request.arguments[1] or ""), where)
    end },
    MFLP = { does = "FLIP", run = function(request) return "FLIP " .. host.arm(request.arguments[1] or "") end },
    MDOP = { does = "OPEN", run = at_door("OPEN") },
    MDCL = { does = "CLOSE", run = at_door("CLOSE") },
    MABS = { does = "MOVE",
      run = values("MOVE", AXES, TURNS, true) },
    MLIN = { does = "LINE", run = values("LINE", { "dx", "dy", "dz", "speed" }, {}) },
    CVAC = { does = "VALVE", run = function(request)
      local level = choose(request.arguments[2], { ["1"] = 0, ["0"] = 1 })
      return ("VALVE %s %d"):format(host.arm(request.arguments[1] or ""), level)
    end },
    MAWT = { does = "WAIT_FOR", run = function(request)
      local seconds = request.arguments[2] or ""
      return ("WAIT_FOR %s %s"):format(host.station(request.arguments[1] or ""),
        seconds:match("^%d*%.?%d*$") or host.refuse("BAD_ARGUMENT", seconds))
    end },
    MPMP = { does = "PUMP", run = function(request)
      local side = choose(request.arguments[2], { V = "vacuum", A = "atmosphere" })
      return ("PUMP %s %s"):format(host.station(request.arguments[1] or ""), side)
    end },
    MCAR = { does = "CARRIER", run = function(request)
      local name = request.arguments[2] or ""
      return ("CARRIER %s%s"):format(host.station(request.arguments[1] or ""), name ~= "" and " name=" .. host.typed(name) or "")
    end },
    MPRT = { does = "PORT", run = function(request)
      local state = choose(request.arguments[2], { P = "placed", C = "clamped", D = "docked", O = "open", M = "mapped" })
      return ("PORT %s %s"):format(host.station(request.arguments[1] or ""), state)
    end },
    MTKA = { does = "TAKE_AWAY", run = function(request)
      return "TAKE_AWAY " .. host.station(request.arguments[1] or "")
    end },
    MWAT = { does = "WAIT", run = function(request)
      local ms = (request.arguments[1] or ""):match("^%d+$") or host.refuse("BAD_ARGUMENT", "MWAT")
      return ("WAIT %.17g"):format(ms / 1000)
    end },
    CRST = { does = "RESET", answer = function()
      maps, found = {}, {}
    end },
    CSAV = { does = "SAVE", run = with_name("SAVE") },
    CRES = { does = "RESTORE", run = with_name("RESTORE") },
    CUND = { does = "UNDO" },
    CFLT = { does = "FAULT", run = as_said("FAULT"), answer = keep },
    CALM = { does = "ALARM", run = function(request) return "ALARM " .. host.alarm(request.arguments[1] or "") end,
      answer = keep },
    CCLR = { does = "CLEAR", run = as_said("CLEAR") },
    ["CSTP,H"] = { does = "HOLD" },
    ["CSTP,E"] = { does = "STOP" },
    CRSM = { does = "RESUME" },
    ACKN = { does = "ACKN" },
    RMAP = { does = "LOCAL", run = function(request)
      return maps[request.arguments[1] or ""] or host.refuse("NOT_MAPPED", request.arguments[1])
    end, answer = function(_, result) return result.answer end },
    RFND = { does = "LOCAL", run = function(request)
      return found[request.arguments[1] or ""] or host.refuse("BAD_ARGUMENT", request.arguments[1])
    end, answer = function(_, result) return result.answer end },
    CCTL = { does = "CONTROLLER", run = function(request)
      local name, value = request.arguments[1] or "", request.arguments[2] or ""
      if not name:find("^%a+$") or not value:find("^%a+$") then
        host.refuse("BAD_ARGUMENT", name .. "," .. value)
      end
      return ("CONTROLLER %s=%s"):format(name, value)
    end },
    CSPD = { does = "CONTROLLER", run = function(request)
      local percent = tonumber(request.arguments[1]) or host.refuse("BAD_ARGUMENT", request.arguments[1])
      return ("CONTROLLER override=%.17g"):format(percent / 100)
    end },
    CEVT = { does = "LOCAL", run = function(request)
      local kind = KINDS[request.arguments[1] or ""] or host.refuse("BAD_ARGUMENT", request.arguments[1])
      subscribed[kind] = choose(request.arguments[2], { ["1"] = "on", ["0"] = "off" }) == "on"
      return ""
    end },
    RPMP = { does = "PORT_MAP", run = at_station("PORT_MAP"), answer = function(request, result)
      if not result.values.codes then
        host.refuse("NOT_MAPPED", request.arguments[1])
      end
      keep_map(request, result)
      return maps[request.arguments[1] or ""]
    end },
    RPRT = { does = "STATUS", answer = function(request, result)
      local name, list = own_port(request.arguments[1] or "", result.status), {}
      for place, part in ipairs({ "carrier", "does", "is", "left" }) do
        list[place] = field(result.status[name .. "." .. part] or "")
      end
      return table.concat(list, ",")
    end },
    RCTL = { does = "CONTROLLER", answer = told },
    RPOS = { does = "STATUS", answer = function(_, result) return position(result) end },
    RSTS = { does = "STATUS", answer = function(_, result)
      return ("%s,%s,%s"):format(result.state, host.code(result.status.error) or "0000", arms(result))
    end },
    RWFR = { does = "STATUS", answer = function(request, result)
      local arm = host.arm(request.arguments[1] or "")
      local sensor = result.sensors[arm]
      return sensor == nil and host.refuse("NO_SUCH_GRIPPER", arm) or sensor and "1" or "0"
    end },
    RSTN = { does = "STATIONS STATION", run = function(request)
      return request.arguments[1] and at_station_with("STATION")(request) or "STATIONS"
    end, answer = function(request, result)
      return request.arguments[1] and standing(result.values) or told(request, result)
    end },
    CSTN = { does = "SET_STATION", run = function(request)
      local axes = values("", AXES, TURNS, true, 3)
      return at_station_with("SET_STATION")(request) .. axes(request)
    end },
    RAXS = { does = "AXES", answer = told },
    RLOC = { does = "WHERE", run = with_name("WHERE", true), answer = told },
    RVER = { does = "VERSION", answer = function(_, result) return result.values.version end },
  },

  encode = {
    acknowledge = function(request)
      status = "1"
      return telegram("$", request.sequence, "0000")
    end,
    answer = function(request, result)
      status = result.state
      return telegram("$", request.sequence, result.ok and "0000" or result.code, result.reply)
    end,
    complete = function(request, result)
      status = result.state
      local rest = ("%s,%s,%s"):format(request.command, whole(result.seconds * 1000), position(result))
      return telegram("!", request.sequence, result.ok and "0000" or result.code, rest)
    end,
    refuse = function(request, failure)
      return telegram("$", request.sequence or last_sequence, failure.code)
    end,
    bad = function(reason)
      local codes = { ["too long"] = "0011", short = "0011", ["no end"] = "0012", timeout = "0012", ["bad sum"] = "0013" }
      return codes[reason] and telegram("$", "00", codes[reason]) or nil
    end,
    event = function(event)
      local own = OF_KIND[event.kind]
      if not subscribed[own and event.kind or "wafer"] then
        return nil
      elseif own then
        return "," .. table.concat({ UNIT, "EVNT", event.kind, whole(event.seconds * 1000), field(own(event)) }, ","), ">"
      end
      return "," .. table.concat({ UNIT, "EVNT", event.kind, whole(event.seconds * 1000), field(event.wafer),
        field(event.gripper) }, ","), ">"
    end,
    unacknowledged = function()
      return "," .. UNIT .. ",EVNT,error,0016", ">"
    end,
  },

  errors = {
    NO_SUCH_COMMAND = "0021", BAD_ARGUMENT = "0022", BUSY = "0023", STOPPED = "0024", OUT_OF_BUDGET = "0025",
    NOT_IN_PHASE = "0026", IN_PHASE = "0027", BAD_VALVE = "0028", NO_SUCH_SAVE = "0029", NOTHING_TO_UNDO = "0030",
    NOT_RESTORED = "0031", RUN_OVER = "0032", NO_ANSWER = "0033", DEADLOCK = "0034",
    NO_SUCH_STATION = "0101", NO_SUCH_SLOT = "0102", NO_SUCH_GRIPPER = "0103", NOT_TAUGHT = "0104",
    NOT_A_PREALIGNER = "0105", NOT_MAPPED = "0106", BAD_SLOT = "0107", CORRECTION_TOO_LARGE = "0108",
    NO_SUCH_WAFER = "0109", NO_SUCH_ROBOT = "0110", AMBIGUOUS_ROBOT = "0111",
    BAD_LIMITS = "0201", OUT_OF_REACH = "0202", LIMIT_EXCEEDED = "0203", NOT_LEVEL = "0204", NOT_HOMED = "0205",
    COLLISION_AHEAD = "0206", NOT_ALONG_ARM = "0207", SLIP_AHEAD = "0208",
    NO_WAFER_ON_GRIPPER = "0730", WAFER_LOST = "0731", WAFER_ON_GRIPPER = "0740", WAFER_MISSING = "0741",
    WAFER_ALREADY_THERE = "0742", VACUUM_BEFORE_PICK = "0743", VACUUM_TIMEOUT = "0744", WAFER_LOST_ON_WAY = "0745",
    WAFER_JAMMED = "0746", PLUNGER_STUCK = "0747", GRIP_TIMEOUT = "0748", UNGRIP_TIMEOUT = "0749",
    SENSORS_DISAGREE = "0750", WRONG_FACE = "0751", WRONG_SLOT = "0752",
    TOO_FEW_SAMPLES = "0801", NO_NOTCH = "0802", TWO_NOTCHES = "0803", OFF_SENSOR = "0804", TOO_ECCENTRIC = "0805",
    CENTRE_NOT_SURE = "0806", NOTCH_NOT_SURE = "0807", BAD_SCAN = "0808", NOT_TOUCHED = "0809",
    PINS_UP = "0901", DOOR_SHUT = "0902", DOOR_BLOCKED = "0903", DOOR_TIMEOUT = "0904", FLIP_TIMEOUT = "0905",
    FLIP_NOT_CLAMPED = "0906", PROCESS_RUNNING = "0907", CLEANING = "0908", STATION_TIMEOUT = "0909",
    WRONG_PRESSURE = "0910", BOTH_OPEN = "0911", DOOR_OPEN = "0912",
    PORT_NOT_OPEN = "0913", PORT_ENTERED = "0914", NO_CARRIER = "0915", CARRIER_THERE = "0916",
    HANDSHAKE_TIMEOUT = "0917",
    NO_POWER = "0920", BRAKES_SET = "0921", EMERGENCY_STOP = "0922", SERVO_ERROR = "0923", SOFT_LIMIT = "0924", WRONG_MODE = "0925",
  },
  other_error = "0999",
  states = { idle = "0", running = "1", held = "2" },
  timing = { ackn = 5 },
}
