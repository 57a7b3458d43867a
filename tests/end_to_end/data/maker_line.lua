-- Fixed widths without commas, `$1MTRGC101GAA` and a sum: a robot, unit 1, and an aligner, unit 2, on one line. `$` and the unit acknowledge,
-- `!` tells the end, which the host answers with ACKN, `?` refuses. INIT clears errors and switches on: the robot goes home with it.
local last = "0000" -- the error that is told until an INIT

local function head(code)
  return host.unit("1") .. (last == "0000" and "00" or "80") .. (code or "0000")
end

-- Station, slot, what is meant, arm and posture: C1 01 G A A.
local function transfer(word)
  return function(request)
    local station, slot, arm = request.rest:match("^(%u%d)(%d%d)%u(%u)A$")
    if not station then
      host.refuse("BAD_ARGUMENT", request.rest)
    end
    return ("%s %s %d gripper=%s"):format(word, host.station(station), host.slot(slot), host.arm(arm))
  end
end

return {
  name = "fixed widths, two units",
  framing = { start = "$", replies = { "$", "!", "?" }, ends = { "\r" }, sum = "add", longest = 80, timeout = 2 },
  units = { angle = 0.01 },
  stations = { C1 = "LP1", C2 = "LP2", P1 = "ALIGN" },
  arms = { A = "EE", P = "PA" },
  unit_of = function(frame) return frame:sub(1, 1) end,
  decode = function(frame)
    local command, rest = frame:match("^%d(%u%u%u%u)(.*)$")
    return { command = command or frame, rest = rest or "" }
  end,
  commands = {
    INIT = { does = "CONTROLLER HOME WAIT", run = function()
      last = "0000"
      return host.unit("1") == "1" and { "CONTROLLER power=on", "HOME" } or "WAIT 0.1"
    end },
    MTRS = { does = "READY", run = transfer("READY") },
    MTRG = { does = "GET", run = transfer("GET") },
    MTRP = { does = "PUT", run = transfer("PUT") },
    MALN = { does = "ALIGN", run = function(request)
      return ("ALIGN %s %.17g"):format(host.mechanism(), host.degrees(request.rest:sub(2)))
    end },
    CSOL = { does = "VALVE", run = function(request)
      local arm, on = request.rest:match("^(%u)([01])$")
      return ("VALVE %s %d"):format(host.arm(arm or ""), on == "1" and 0 or 1)
    end },
    RSTS = { does = "STATUS", answer = function() return last end },
    CSTP = { does = "STOP" },
    ACKN = { does = "ACKN" },
  },
  encode = {
    acknowledge = function() return head(), "$" end,
    answer = function(_, result) return head(not result.ok and result.code or nil) .. (result.reply or ""), "$" end,
    complete = function(request, result)
      last = result.ok and last or result.code
      return head(not result.ok and result.code or nil) .. request.command, "!"
    end,
    refuse = function(_, failure) return failure.code, "?" end,
    bad = function() return "1001", "?" end,
  },
  errors = { NO_SUCH_COMMAND = "1020", BAD_ARGUMENT = "1021", BUSY = "1030", NO_SUCH_STATION = "1040", NO_SUCH_SLOT = "1041", STOPPED = "3002",
    NO_POWER = "3003", WAFER_MISSING = "3741", EMERGENCY_STOP = "4922" },
  other_error = "3999",
  timing = { ackn = 5 },
}
