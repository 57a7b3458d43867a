-- One line, one answer, numbered, as numbered.lua, of a load port: `0 ...` or `-NNNN text`. Commands are read in either case. Three ports
-- share one state: `status` asks and halts, `motion` also moves, `events` tells what befalls the port: `1 STATE CARRIER STEP`, with `-` for
-- none. A motion is answered at its end. It goes one state up or down: `clamp`, `dock`, `open`, `map`, `close`, `undock`, `unclamp`; `load` and
-- `unload` go all the way, and `remove` until the carrier is gone, by hand or by a vehicle. `waitcarrier SECONDS` waits for one that is to
-- come. `carrierid` reads the tag of a carrier that is there. `maprd` tells the last map. `e84` tells the lines of the handshake, and
-- `e84error` which of its timers has run out.

local STATES = { absent = 0, placed = 1, clamped = 2, docked = 3, open = 4, mapped = 5 }
local CODES = { ["0"] = "0", ["1"] = "1", ["2"] = "2", ["3"] = "5", ["4"] = "4", ["5"] = "2", ["6"] = "3" } -- empty, one, two, out, crossed, thick, thin

local function fail(code, text)
  host.refuse("BAD_ARGUMENT", text, tostring(code))
end

-- A field of STATUS of this load port: is, does, carrier, failed.
local function own(status, field)
  return status[host.mechanism() .. "." .. field]
end

local function state_of(now)
  return own(now.status, "is") or fail(-3206, "Not a load port: " .. host.mechanism())
end

-- To a state, from one of these only: another one is out of order.
local function step(to, ...)
  local from = {}
  for _, state in ipairs({ ... }) do
    from[state] = true
  end
  return { does = "PORT", run = function(request, now)
    local state = state_of(now)
    if request.port ~= "motion" then
      fail(-1009, "No motion at this port")
    elseif state ~= "absent" and not from[state] then -- without a carrier our own error says so
      fail(-3201, ("Wrong state: the port is %s"):format(state))
    end
    return ("PORT %s %s"):format(host.mechanism(), to)
  end }
end

local function ask(answer)
  return { does = "STATUS", answer = answer }
end

-- The lines of E84 by the step of the handshake: ours, then the vehicle's. A carrier comes if none is there up to TP3, and has come behind it.
local function lines_of(status)
  local step, is = own(status, "does") or "", own(status, "is")
  local number = tonumber(step:match("^TP([1-5])$") or "0")
  local comes = (number <= 3) == (is == "absent")
  local failed = own(status, "failed") ~= nil
  local function on(condition)
    return condition and 1 or 0
  end
  local list = {
    { "L_REQ", on(number >= 1 and number <= 3 and comes) }, { "U_REQ", on(number >= 1 and number <= 3 and not comes) },
    { "READY", on(number >= 2 and number <= 4) }, { "HO_AVBL", on(not failed) }, { "ES", 1 },
    { "VALID", on(number >= 1) }, { "CS_0", on(number >= 1) }, { "TR_REQ", on(number >= 2 and number <= 4) },
    { "BUSY", on(number >= 3 and number <= 4) }, { "COMPT", on(number == 5) },
  }
  for place, line in ipairs(list) do
    list[place] = line[1] .. " " .. line[2]
  end
  return table.concat(list, " ")
end

local commands = {
  nop = { does = "LOCAL", run = function() return "" end },
  version = { does = "VERSION", answer = function() return "Waferhand" end },
  state = ask(function(_, result)
    local status = result.status
    return ("%d %s %s"):format(STATES[own(status, "is")] or fail(-3206, "Not a load port"), own(status, "is"), own(status, "does") or "-")
  end),
  carrierid = ask(function(_, result)
    local is = own(result.status, "is")
    return is ~= "absent" and own(result.status, "carrier") or fail(-3200, "No carrier")
  end),
  maprd = { does = "PORT_MAP", run = function() return "PORT_MAP " .. host.mechanism() end, answer = function(_, result)
    return (tostring(result.values.codes or host.refuse("NOT_MAPPED")):gsub(".", CODES))
  end },
  e84 = ask(function(_, result) return lines_of(result.status) end),
  e84error = ask(function(_, result) return own(result.status, "failed") or "-" end),

  clamp = step("clamped", "placed"), dock = step("docked", "clamped"), open = step("open", "docked"), map = step("mapped", "open"),
  close = step("docked", "open", "mapped"), undock = step("clamped", "docked"), unclamp = step("placed", "clamped"),
  load = step("mapped", "placed", "clamped", "docked", "open", "mapped"), unload = step("placed", "placed", "clamped", "docked", "open", "mapped"),
  remove = { does = "TAKE_AWAY", run = function(request)
    return request.port == "motion" and "TAKE_AWAY " .. host.mechanism() or fail(-1009, "No motion at this port")
  end },
  waitcarrier = { does = "WAIT_FOR", run = function(request)
    local seconds = tonumber(request.words[1] or "0")
    if not seconds or not (seconds >= 0 and seconds <= 86400) then
      fail(-712, "Invalid syntax: " .. request.words[1])
    end
    return ("WAIT_FOR %s%s"):format(host.mechanism(), request.words[1] and (" %.17g"):format(seconds) or "")
  end },
  halt = { does = "STOP" },
  exit = { does = "LOCAL", closes = true, run = function() return "" end },
}

local function decode(frame, client)
  local words = {}
  for word in frame:gmatch("%S+") do
    words[#words + 1] = word
  end
  local name = table.remove(words, 1)
  return name and { command = name:lower(), words = words, port = client.port } or nil
end

local function told(request, result)
  if request.command == "exit" then
    return nil
  elseif not result.ok then
    return ("%s %s"):format(result.code, result.text)
  end
  return result.reply and "0 " .. result.reply or "0"
end

return {
  name = "one line, one answer, numbered, of a load port",
  mechanism = "load_port",
  ports = { "status", "motion", "events" },
  in_order = true,
  second_client = "share",
  events = { "port" },
  framing = { ends = { "\r\n", "\n" }, longest = 512 },
  decode = decode,
  commands = commands,
  encode = {
    answer = told,
    complete = told,
    refuse = function(_, failure)
      return ("%s %s"):format(failure.code, failure.detail ~= "" and failure.detail or failure.text)
    end,
    bad = function(reason) return "-712 Invalid syntax: " .. reason end,
    event = function(event)
      local port = event.load_port
      return port and event.port == "events" and ("1 %s %s %s"):format(port.is, port.carrier or "-", port.failed or port.does or "-") or nil
    end,
  },
  errors = {
    NO_SUCH_COMMAND = -2805, BUSY = -1050, STOPPED = -1045, NO_CARRIER = -3200, PORT_ENTERED = -3202, CARRIER_THERE = -3203,
    NOT_MAPPED = -3204, HANDSHAKE_TIMEOUT = -3205, STATION_TIMEOUT = -3207, NO_SUCH_STATION = -3206,
  },
  other_error = "-1000",
  states = { idle = "0", running = "1", held = "2" },
}
