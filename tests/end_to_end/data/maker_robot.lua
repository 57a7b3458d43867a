-- A robot that ends its answers with a prompt: `OK`, values, or `?NN`, then CR, LF and `>`. Stations are letters, angles 0.01 degrees,
-- lengths 0.01 mm. A motion is answered at its end; `STA`, `POS` and `STOP` are answered meanwhile.
local function with(word)
  return function(request)
    return ("%s %s %d"):format(word, host.station(request[1] or ""), host.slot(request[2] or ""))
  end
end

local function bits(now)
  local word = now.is_held and 4 or 0
  word = word | (now.state == "B" and 1 or 0) | (now.controller.power == "on" and 2 or 0) | (now.status.error ~= 0 and 8 or 0)
  for _, is_on in pairs(now.sensors) do
    word = word | (is_on and 16 or 0)
  end
  return ("%04X"):format(word)
end

local function told(request, result)
  return result.ok and (result.reply or "OK") or "?" .. result.code
end

return {
  name = "a prompt",
  mechanism = "robot",
  framing = { ends = { "\r" }, reply_ends = { "\r\n>" }, longest = 80 },
  units = { length = 0.01, angle = 0.01 },
  stations = { A = "LP1", B = "LP2", C = "ALIGN" },
  begins = "CONTROLLER power=off",
  connected = function() return "READY" end,
  gone = function() return "CONTROLLER power=off" end,
  decode = function(frame)
    local request = {}
    for word in frame:gmatch("[^ ,]+") do
      request[#request + 1] = word
    end
    request.command = table.remove(request, 1)
    return request.command and request or nil
  end,
  commands = {
    PWR = { does = "CONTROLLER", run = function(request) return "CONTROLLER power=" .. (request[1] == "1" and "on" or "off") end },
    HOM = { does = "HOME" },
    GET = { does = "GET", run = with("GET") },
    PUT = { does = "PUT", run = with("PUT") },
    RET = { does = "RECOVER" },
    MTS = { does = "READY", run = with("READY") },
    MVA = { does = "MOVE", run = function(request)
      local axis = ({ T = "theta", R = "r", Z = "z" })[request[1]] or host.refuse("BAD_ARGUMENT", request[1])
      return ("MOVE %s=%.17g"):format(axis, (axis == "theta" and host.degrees or host.mm)(request[2] or "", axis))
    end },
    SPD = { does = "CONTROLLER", run = function(request) return ("CONTROLLER override=%g"):format((tonumber(request[1]) or 0) / 100) end },
    STOP = { does = "STOP" },
    STA = { does = "LOCAL", run = function(_, now) return bits(now) end, answer = function(_, result) return result.answer end },
    POS = { does = "STATUS", answer = function(_, result)
      return ("%.0f,%.0f,%.0f"):format(result.position.theta, result.position.r, result.position.z)
    end },
  },
  encode = {
    answer = told,
    complete = told,
    refuse = function(_, failure) return "?" .. failure.code end,
    bad = function() return "?01" end,
  },
  errors = { NO_SUCH_COMMAND = "02", BUSY = "03", NO_POWER = "10", EMERGENCY_STOP = "11", NOT_HOMED = "12", STOPPED = "13",
    NO_SUCH_STATION = "20", NO_SUCH_SLOT = "21", WAFER_MISSING = "30", WAFER_ON_GRIPPER = "31", NO_WAFER_ON_GRIPPER = "32", WAFER_ALREADY_THERE = "33" },
  other_error = "99",
  states = { idle = "I", running = "B", held = "H" },
}
