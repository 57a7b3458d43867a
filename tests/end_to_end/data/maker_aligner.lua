-- An aligner at a noisy line: STX, a body with DLE before each mark, ETX, and the exclusive or of body and ETX as one byte. It answers ACK
-- (06) or NAK (15 hex) and an error's number at once, and tells each end as an event, `E` and the command, or `X` and the error's number.
local function chuck(level)
  return function()
    return ("VALVE %s %d"):format(host.arm("chuck"), level)
  end
end

return {
  name = "ACK, NAK and an LRC",
  mechanism = "aligner",
  framing = {
    start = "\x02", ends = { "\x03" }, escape = "\x10", sum = "xor", sum_as = "bytes", sum_at = "behind", sums_end = true, timeout = 0.5,
  },
  units = { angle = 0.1 },
  arms = { chuck = "PA" },
  decode = function(frame)
    return { command = frame:sub(1, 2), rest = frame:sub(3) }
  end,
  commands = {
    AL = { does = "ALIGN", run = function(request) return ("ALIGN %s %.17g"):format(host.mechanism(), host.degrees(request.rest)) end },
    RO = { does = "ROTATE", run = function(request) return ("ROTATE %s %.17g"):format(host.mechanism(), host.degrees(request.rest)) end },
    VN = { does = "VALVE", run = chuck(0) },
    VF = { does = "VALVE", run = chuck(1) },
    WF = { does = "LOCAL", run = function(_, now) return now.sensors[host.arm("chuck")] and "1" or "0" end },
    AB = { does = "STOP" },
  },
  encode = {
    acknowledge = function() return "\x06" end,
    answer = function(request, result) return result.ok and "\x06" .. (request.command == "WF" and result.answer or "") or "\x15" .. result.code end,
    complete = function(request, result) return result.ok and "E" .. request.command or "X" .. result.code end,
    refuse = function(_, failure) return "\x15" .. failure.code end,
    bad = function(reason) return reason == "bad sum" and "\x1501" or "\x1502" end,
  },
  errors = { BUSY = "03", NO_SUCH_COMMAND = "04", STOPPED = "05", PINS_UP = "06", BAD_ARGUMENT = "07" },
  other_error = "99",
}
