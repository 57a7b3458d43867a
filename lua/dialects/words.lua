-- Frames as words with blanks between them, each line ended by a carriage return. An action is answered when it has
-- ended, `_RDY` or `_ERR n`; in background mode `_RDY` when it begins, and `_BKGRDY` or `_BKGERR n` when it has ended.
-- A complaint of the cell is told at once, `_EVT SLOT_OCCUPIED Wafer 1`.
-- Lengths are whole um, angles whole 0.001 degrees.

local background = false
local found = {} -- the results of the last command of each name

-- Their value as a field of our line: in mm, or in degrees. The axes of RQ POS have a sign of their own.
local function mm(field, axis)
  return function(word) return ("%s=%.17g"):format(field, host.mm(word, axis)) end
end

local function degrees(field, axis)
  return function(word) return ("%s=%.17g"):format(field, host.degrees(word, axis)) end
end

-- Percents of the limits, as a part of them.
local function share(field)
  return function(word)
    return ("%s=%.17g"):format(field, (tonumber(word) or host.refuse("BAD_ARGUMENT", word)) / 100)
  end
end

-- The options behind a command's first words: their word, and its form in our line.
local OPTIONS = {
  SLOT = function() end,
  ARM = function(word) return "gripper=" .. host.arm(word) end,
  SPEED = share("speed"), ACCEL = share("acceleration"),
  RO = mm("dx"), TO = mm("dy"), ZO = mm("dz"),
  STOP = function(word)
    local phases = { EXTENDED = "extended", UP = "up" }
    return "stop=" .. (phases[word:upper()] or host.refuse("BAD_ARGUMENT", "STOP " .. word))
  end,
}

-- The axes that may have a sign of their own.
local SIGNED = { theta = "theta", r = "r", z = "z", yaw = "yaw" }

-- Their letters of the axes, in the order of the answer; a robot has some of them. F is the forearm of an arm that
-- folds, X the rail, R2 and W2 belong to a second arm, TX and TY tilt the column, FL turns the blade over.
local LETTERS = { "T", "R", "Z", "W", "F", "X", "R2", "W2", "TX", "TY", "FL" }
local NAMES = { T = "theta", R = "r", Z = "z", W = "yaw", F = "forearm", X = "rail", R2 = "r2", W2 = "yaw2", TX = "tilt_x",
                TY = "tilt_y", FL = "flip" }
local LENGTHS = { R = true, Z = true, X = true, R2 = true }
local AXES = { T = degrees("theta", "theta"), R = mm("r", "r"), Z = mm("z", "z"), W = degrees("yaw", "yaw"), F = degrees("forearm"),
               X = mm("rail"), R2 = mm("r2"), W2 = degrees("yaw2"), TX = degrees("tilt_x"), TY = degrees("tilt_y"), FL = degrees("flip") }
local WAYS = { X = mm("dx"), Y = mm("dy"), Z = mm("dz"), SPEED = mm("speed") }

-- The options for the positions of the arm's axes in a station, and for the arm.
local STANDING = { ARM = OPTIONS.ARM }
for letter, axis in pairs(AXES) do
  STANDING[letter] = axis
end

-- The pairs of words from `first` on, each a name of `known` and its value: the words of our line, and the values
-- by name.
local function options(words, first, known)
  local list, values = {}, {}
  for place = first, #words, 2 do
    local name, value = words[place]:upper(), words[place + 1]
    if not known[name] or not value or values[name] then
      host.refuse("BAD_ARGUMENT", words[place])
    end
    values[name] = value
    list[#list + 1] = known[name](value)
  end
  return table.concat(list, " "), values
end

-- "PICK 1 SLOT 3 ARM A" as "GET A 3 gripper=EE".
local function with_slot(word)
  return function(request)
    local station = host.station(request.words[2] or "")
    local text, values = options(request.words, 3, OPTIONS)
    return ("%s %s %d %s"):format(word, station, values.SLOT and host.slot(values.SLOT) or 1, text)
  end
end

-- A command with a station alone.
local function with_station(word)
  return function(request)
    return word .. " " .. host.station(request.words[2] or "")
  end
end

-- TEACH A; after TEACH A KEEP the arm goes to the taught place.
local function teach(request)
  local keep = request.words[3]
  if keep and keep:upper() ~= "KEEP" then
    host.refuse("BAD_ARGUMENT", keep)
  end
  return with_station("TEACH")(request) .. (keep and " keep=true" or "")
end

-- A command with a station and an angle. Without an angle it takes `by_itself`, if it has one.
local function with_angle(word, by_itself)
  return function(request)
    local theirs = request.words[3] or by_itself or host.refuse("BAD_ARGUMENT", word)
    return ("%s %s %.17g"):format(word, host.station(request.words[2] or ""), host.degrees(theirs))
  end
end

-- How an aligner makes good what it finds.
local MODES = { ROBOT = "robot", STAGE = "stage", PINS = "pins" }

-- A command with a door alone.
local function with_door(word)
  return function(request)
    return word .. " " .. host.door(request.words[2] or "")
  end
end

-- A command whose words are ours.
local function as_said(word)
  return function(request)
    return word .. " " .. table.concat(request.words, " ", 2)
  end
end

-- A command with a name, which may have blanks: the words from `first` on. `may_lack`: the name may be missing.
local function with_name(word, first, may_lack)
  return function(request)
    local name = table.concat(request.words, " ", first)
    return may_lack and name == "" and word or word .. " " .. host.typed(name)
  end
end

-- VAC EE ON opens the valve.
local function valve(request)
  local levels = { ON = 0, OFF = 1 }
  local switch = (request.words[3] or ""):upper()
  return ("VALVE %s %d"):format(host.arm(request.words[2] or ""), levels[switch] or host.refuse("BAD_ARGUMENT", switch))
end

local function whole(number)
  return ("%d"):format(math.floor(number + 0.5))
end

-- An axis that the robot does not have is not told.
local function position(_, result)
  local list = { "POS ABS" }
  for _, letter in ipairs(LETTERS) do
    local at = result.position[NAMES[letter]]
    list[#list + 1] = at and letter .. " " .. whole(at)
  end
  return table.concat(list, " ")
end

local function held(request, result)
  local arm = host.arm(request.words[4] or request.words[3] or "")
  local sensor = result.sensors[arm]
  return "LOAD " .. (sensor == nil and host.refuse("NO_SUCH_GRIPPER", arm) or sensor and "ON" or "OFF")
end

-- The state of each arm's sensor: EE ON PA OFF.
local function arms(result)
  local list = {}
  for name, is_on in pairs(result.sensors) do
    list[#list + 1] = (host.name("arms", name) or name) .. (is_on and " ON" or " OFF")
  end
  table.sort(list)
  return table.concat(list, " ")
end

local function map(_, result)
  return "MAP " .. tostring(result.values.codes):gsub(".", "%0 "):sub(1, -2)
end

-- The answer of a query, behind this word.
local function told(word)
  return function(_, result)
    return word .. " " .. result.answer:gsub("^OK ?", "")
  end
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

-- RQ PORT LP1: what a load port does, which carrier it has and what is left of the step: PORT CARRIER C1 STEP TP3 OPEN.
local function port(name, status)
  local list = { "PORT" }
  for _, field in ipairs({ { "CARRIER", "carrier" }, { "STEP", "does" }, { "IS", "is" }, { "LEFT", "left" } }) do
    local value = status[name .. "." .. field[2]]
    list[#list + 1] = value and ("%s %s"):format(field[1], tostring(value):upper())
  end
  return table.concat(list, " ")
end

-- SET POWER OFF: what the robot's own controller has from now on.
local function controller(name)
  return { does = "CONTROLLER", run = function(request)
    local value = (request.words[3] or ""):match("^%a+$") or host.refuse("BAD_ARGUMENT", name)
    return ("CONTROLLER %s=%s"):format(name, value:lower())
  end }
end

-- RQ STN tells all stations; RQ STN A ARM EE tells where the arm's axes stand in A.
local function station(request)
  local words = request.words
  return words[3] and ("STATION %s %s"):format(host.station(words[3]), options(words, 4, { ARM = OPTIONS.ARM })) or "STATIONS"
end

local function place(request, result)
  if not request.words[3] then
    return told("STN")(request, result)
  end
  local list = { "STN", request.words[3] }
  for _, letter in ipairs(LETTERS) do
    local name = NAMES[letter]
    local at = result.values[name]
    local theirs = at and (LENGTHS[letter] and host.length or host.angle)(at, SIGNED[name])
    list[#list + 1] = theirs and letter .. " " .. whole(theirs)
  end
  return table.concat(list, " ")
end

-- Keeps the result for RQ FOUND.
local function keep(request, result)
  found[request.command] = result.answer:gsub("^OK ", "")
end

-- The most words behind a command's own words; for other commands their options tell.
local MOST = {
  HOME = 0, GO = 0, MAP = 1, TEACH = 2, RETRACT = 0, ALIGN = 3, ROTATE = 2, SCAN = 1, CALIB = 1, LIFT = 2, FLIP = 1,
  OPEN = 1, CLOSE = 1, VAC = 2, WAIT = 1, AWAIT = 2, PUMP = 2, CARRIER = 2, PORT = 2, REMOVE = 1, RESET = 0, UNDO = 0, HALT = 0, HOLD = 0, RESUME = 0, ALARM = 1,
  ["SET BKG"] = 1, ["SET POWER"] = 1, ["SET BRAKES"] = 1, ["SET ESTOP"] = 1, ["SET SERVO"] = 1, ["SET MODE"] = 1, ["SET SPEED"] = 1,
  ["RQ CTRL"] = 0, ["RQ MAP"] = 1, ["RQ PORT"] = 1, ["RQ POS"] = 0, ["RQ LOAD"] = 2, ["RQ STATUS"] = 0, ["RQ VERSION"] = 0, ["RQ STN"] = 3,
  ["RQ AXES"] = 0, ["RQ FOUND"] = 1,
}

-- Without RQ, the first word names a command; with it, the second.
local function decode(frame)
  local words = {}
  for word in frame:gmatch("%S+") do
    words[#words + 1] = word
  end
  local name = (words[1] or ""):upper()
  if name == "RQ" or name == "SET" then
    name = name .. " " .. (words[2] or ""):upper()
  end
  local extra = MOST[name] and words[MOST[name] + (name:find(" ", 1, true) and 3 or 2)]
  if extra then
    host.refuse("BAD_ARGUMENT", extra)
  end
  return words[1] and { command = name, words = words }
end

local function ended(result)
  local prefix = background and "_BKG" or "_"
  return prefix .. (result.ok and "RDY" or "ERR " .. result.code)
end

return {
  name = "frames as words, _RDY and _ERR",
  framing = { ends = { "\r", "\r\n" }, longest = 512 },
  units = { length = 0.001, angle = 0.001 },
  decode = decode,

  commands = {
    HOME = { does = "HOME", run = function() return "HOME" end },
    PICK = { does = "GET", run = with_slot("GET") },
    PLACE = { does = "PUT", run = with_slot("PUT") },
    SWAP = { does = "SWAP", run = with_slot("SWAP") },
    GOTO = { does = "READY", run = with_slot("READY") },
    PLAY = { does = "PATTERN", run = function(request)
      local text, values = options(request.words, 4, OPTIONS)
      return ("PATTERN %s %s %d %s"):format(host.typed(request.words[2] or ""), host.station(request.words[3] or ""),
        values.SLOT and host.slot(values.SLOT) or 1, text)
    end },
    GO = { does = "CONTINUE" },
    MAP = { does = "MAP", run = with_station("MAP"), answer = map },
    TEACH = { does = "TEACH", run = teach, answer = keep },
    RETRACT = { does = "RECOVER" },
    ALIGN = { does = "ALIGN", run = function(request)
      local mode = request.words[4]
      if mode and not MODES[mode] then
        host.refuse("BAD_ARGUMENT", mode)
      end
      return with_angle("ALIGN", 0)(request) .. (mode and " mode=" .. MODES[mode] or "")
    end, answer = keep },
    ROTATE = { does = "ROTATE", run = with_angle("ROTATE") },
    SCAN = { does = "EDGE_SCAN", run = with_station("EDGE_SCAN"), answer = keep },
    CALIB = { does = "CALIBRATE", run = with_station("CALIBRATE"), answer = keep },
    LIFT = { does = "LIFT", run = function(request)
      return ("LIFT %s %s"):format(host.station(request.words[2] or ""), request.words[3] or "")
    end },
    FLIP = { does = "FLIP", run = function(request) return "FLIP " .. host.arm(request.words[2] or "") end },
    OPEN = { does = "OPEN", run = with_door("OPEN") },
    CLOSE = { does = "CLOSE", run = with_door("CLOSE") },
    VAC = { does = "VALVE", run = valve },
    MOVE = { does = "MOVE", run = function(request) return "MOVE " .. options(request.words, 2, AXES) end },
    LINE = { does = "LINE", run = function(request) return "LINE " .. options(request.words, 2, WAYS) end },
    WAIT = { does = "WAIT", run = function(request)
      return "WAIT " .. ((request.words[2] or ""):match("^%d+%.?%d*$") or host.refuse("BAD_ARGUMENT", "WAIT"))
    end },
    AWAIT = { does = "WAIT_FOR", run = function(request)
      local seconds = request.words[3] or ""
      return ("WAIT_FOR %s %s"):format(host.station(request.words[2] or ""),
        seconds:match("^%d*%.?%d*$") or host.refuse("BAD_ARGUMENT", seconds))
    end },
    CARRIER = { does = "CARRIER", run = function(request)
      local name = request.words[3] or ""
      return ("CARRIER %s%s"):format(host.station(request.words[2] or ""), name ~= "" and " name=" .. host.typed(name) or "")
    end },
    PORT = { does = "PORT", run = function(request)
      local state = (request.words[3] or ""):match("^%u+$") or host.refuse("BAD_ARGUMENT", "PORT")
      return ("PORT %s %s"):format(host.station(request.words[2] or ""), state:lower())
    end },
    REMOVE = { does = "TAKE_AWAY", run = function(request)
      return "TAKE_AWAY " .. host.station(request.words[2] or "")
    end },
    PUMP = { does = "PUMP", run = function(request)
      local sides, side = { VACUUM = "vacuum", ATMOSPHERE = "atmosphere" }, request.words[3] or ""
      return ("PUMP %s %s"):format(host.station(request.words[2] or ""), sides[side] or host.refuse("BAD_ARGUMENT", side))
    end },
    RESET = { does = "RESET", answer = function()
      found = {}
    end },
    SAVE = { does = "SAVE", run = with_name("SAVE", 2) },
    RESTORE = { does = "RESTORE", run = with_name("RESTORE", 2) },
    UNDO = { does = "UNDO" },
    HALT = { does = "STOP" },
    HOLD = { does = "HOLD" },
    RESUME = { does = "RESUME" },
    CLEAR = { does = "CLEAR", run = as_said("CLEAR") },
    FAULT = { does = "FAULT", run = as_said("FAULT"), answer = keep },
    ALARM = { does = "ALARM", run = function(request) return "ALARM " .. host.alarm(request.words[2] or "") end,
              answer = keep },
    ["SET STN"] = { does = "SET_STATION", run = function(request)
      return ("SET_STATION %s %s"):format(host.station(request.words[3] or ""), options(request.words, 4, STANDING))
    end },
    ["SET BKG"] = { does = "LOCAL", run = function(request)
      local switch = (request.words[3] or ""):upper()
      if switch ~= "ON" and switch ~= "OFF" then
        host.refuse("BAD_ARGUMENT", switch)
      end
      background = switch == "ON"
      return ""
    end },
    ["SET POWER"] = controller("power"),
    ["SET BRAKES"] = controller("brakes"),
    ["SET ESTOP"] = controller("estop"),
    ["SET SERVO"] = controller("servo"),
    ["SET MODE"] = controller("mode"),
    ["SET SPEED"] = { does = "CONTROLLER", run = function(request) return "CONTROLLER " .. share("override")(request.words[3] or "") end },
    ["RQ CTRL"] = { does = "CONTROLLER", answer = told("CTRL") },
    ["RQ POS"] = { does = "STATUS", answer = position },
    ["RQ LOAD"] = { does = "STATUS", answer = held },
    ["RQ STATUS"] = { does = "STATUS", answer = function(_, result) 
      return "STATUS " .. result.state .. " " .. arms(result)
    end },
    ["RQ VERSION"] = { does = "VERSION", answer = function(_, result)
      return "VERSION " .. result.values.version
    end },
    ["RQ STN"] = { does = "STATIONS STATION", run = station, answer = place },
    ["RQ MAP"] = { does = "PORT_MAP", run = function(request) return "PORT_MAP " .. host.station(request.words[3] or "") end,
                   answer = function(request, result)
      return result.values.codes and map(request, result) or host.refuse("NOT_MAPPED", request.words[3])
    end },
    ["RQ PORT"] = { does = "STATUS", answer = function(request, result)
      return port(own_port(request.words[3] or "", result.status), result.status)
    end },
    ["RQ AXES"] = { does = "AXES", answer = told("AXES") },
    ["RQ WAFERS"] = { does = "WHERE", run = with_name("WHERE", 3, true), answer = told("WAFERS") },
    ["RQ FOUND"] = { does = "LOCAL", run = function(request)
      local name = (request.words[3] or ""):upper()
      return "FOUND " .. (found[name] or host.refuse("BAD_ARGUMENT", "no " .. name .. " has found anything"))
    end, answer = function(_, result) return result.answer end },
  },

  encode = {
    -- In background mode the host hears at once that it began.
    acknowledge = function() return background and "_RDY" or nil end,
    answer = function(_, result)
      if not result.ok then
        return "_ERR " .. result.code
      end
      return result.reply and { result.reply, "_RDY" } or "_RDY"
    end,
    complete = function(_, result)
      return result.reply and { result.reply, ended(result) } or ended(result)
    end,
    refuse = function(_, failure) return "_ERR " .. failure.code end,
    bad = function() return "_ERR 0100" end,
    event = function(event)
      return event.is_complaint and "_EVT " .. event.kind:upper() .. " " .. event.wafer or nil
    end,
  },

  errors = {
    NO_SUCH_COMMAND = "0101", BAD_ARGUMENT = "0102", BUSY = "0103", STOPPED = "0104", OUT_OF_BUDGET = "0105",
    NOT_IN_PHASE = "0106", IN_PHASE = "0107", BAD_VALVE = "0108", NO_SUCH_SAVE = "0109", NOTHING_TO_UNDO = "0110",
    NOT_RESTORED = "0111", RUN_OVER = "0112", NO_ANSWER = "0113", DEADLOCK = "0114",
    NO_SUCH_STATION = "0201", NO_SUCH_SLOT = "0202", NO_SUCH_GRIPPER = "0203", NOT_TAUGHT = "0204",
    NOT_A_PREALIGNER = "0205", NOT_MAPPED = "0206", BAD_SLOT = "0207", CORRECTION_TOO_LARGE = "0208",
    NO_SUCH_WAFER = "0209", NO_SUCH_ROBOT = "0210", AMBIGUOUS_ROBOT = "0211",
    BAD_LIMITS = "0301", OUT_OF_REACH = "0302", LIMIT_EXCEEDED = "0303", NOT_LEVEL = "0304", NOT_HOMED = "0305",
    COLLISION_AHEAD = "0306", NOT_ALONG_ARM = "0307", SLIP_AHEAD = "0308",
    WAFER_MISSING = "0401", NO_WAFER_ON_GRIPPER = "0402", WAFER_ON_GRIPPER = "0403", WAFER_LOST = "0404",
    WAFER_ALREADY_THERE = "0405", VACUUM_TIMEOUT = "0406", VACUUM_BEFORE_PICK = "0407", WAFER_LOST_ON_WAY = "0408",
    WAFER_JAMMED = "0409", PLUNGER_STUCK = "0410", GRIP_TIMEOUT = "0411", UNGRIP_TIMEOUT = "0412",
    SENSORS_DISAGREE = "0413", WRONG_FACE = "0414", WRONG_SLOT = "0415",
    TOO_FEW_SAMPLES = "0501", NO_NOTCH = "0502", TWO_NOTCHES = "0503", OFF_SENSOR = "0504", TOO_ECCENTRIC = "0505",
    CENTRE_NOT_SURE = "0506", NOTCH_NOT_SURE = "0507", BAD_SCAN = "0508", NOT_TOUCHED = "0509",
    PINS_UP = "0601", DOOR_SHUT = "0602", DOOR_BLOCKED = "0603", DOOR_TIMEOUT = "0604", FLIP_TIMEOUT = "0605",
    FLIP_NOT_CLAMPED = "0606", PROCESS_RUNNING = "0607", CLEANING = "0608", STATION_TIMEOUT = "0609",
    WRONG_PRESSURE = "0610", BOTH_OPEN = "0611", DOOR_OPEN = "0612",
    PORT_NOT_OPEN = "0613", PORT_ENTERED = "0614", NO_CARRIER = "0615", CARRIER_THERE = "0616",
    HANDSHAKE_TIMEOUT = "0617",
    NO_POWER = "0701", BRAKES_SET = "0702", EMERGENCY_STOP = "0703", SERVO_ERROR = "0704", SOFT_LIMIT = "0705", WRONG_MODE = "0706",
  },
  other_error = "0999",
  states = { idle = "IDLE", running = "BUSY", held = "HELD" },
}
