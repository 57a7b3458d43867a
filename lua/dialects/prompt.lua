-- Lines as at the prompt: one line, one answer. HOLD and RESUME go beyond it.

local WORDS = [[GET PUT CONTINUE SWAP READY PATTERN MAP TEACH HOME RECOVER STOP RESET SAVE RESTORE UNDO STATUS VERSION ROTATE
  EDGE_SCAN ALIGN CALIBRATE LIFT VALVE MOVE FLIP LINE OPEN CLOSE WAIT WAIT_FOR PUMP CARRIER PORT TAKE_AWAY CONTROLLER FAULT ALARM CLEAR
  OFFSET HOLDER PROXIMITY MEASURE DISTANCE ANGLE WHERE AXES STATIONS STATION PORT_MAP SET_STATION HELP HOLD RESUME]]

local commands = {}
for word in WORDS:gmatch("%S+") do
  commands[word] = { does = word, run = function(request) return request.line end }
end

-- HELP of this port: it has HOLD and RESUME, and none of the words that it refuses, such as QUIT and TASK.
local OWN = { HOLD = "what runs stands still after the present slice, and the clock with it", RESUME = "what a HOLD holds goes on" }

local function help(_, result)
  if not result.answer:find("; HELP COMMAND", 1, true) then
    return nil
  end
  local list = result.answer:gsub(" HOLDER ", " HOLD HOLDER "):gsub(" RESTORE ", " RESTORE RESUME ")
  local words, rest = list:match("^(.-)(;.*)$")
  return words:gsub(" (%S+)", function(word) return not commands[word] and "" or nil end) .. rest
end

if commands.HELP then
  commands.HELP.answer = help
  for word, does in pairs(OWN) do
    commands["HELP " .. word] = { does = "LOCAL", run = function() return ("OK %s: %s"):format(word, does) end }
  end
end

-- The errors have our own numbers.
local errors = {}
for name, entry in pairs(wh.errors) do
  errors[name] = name ~= "OK" and entry.number or nil
end

local function answer(_, result)
  return result.reply or result.answer
end

return {
  name = "lines as at the prompt",
  framing = { ends = { "\n", "\r\n" }, longest = 1002 },
  commands = commands,

  -- It ignores blank lines and comments.
  decode = function(frame)
    local word, rest = frame:match("^%s*([^%s#]%S*)%s*(.-)%s*$")
    local own = word and (word .. " " .. rest):upper()
    local asked = own and own:match("^HELP (%S+)$")
    if asked and not commands[asked] then
      host.refuse("NO_SUCH_COMMAND", rest)
    end
    return word and { command = commands[own] and own or word:upper(), line = frame }
  end,

  encode = {
    answer = answer,
    complete = answer,
    refuse = function(_, failure)
      local detail = failure.detail ~= "" and "; " .. failure.detail or ""
      return ("ERROR %d %s: %s%s"):format(failure.number, failure.name, failure.text, detail)
    end,
    bad = function(reason)
      return ("ERROR 48 BAD_ARGUMENT: no line: %s"):format(reason)
    end,
  },

  errors = errors,
  other_error = 48,
  states = { idle = "idle", running = "running", held = "held" },
}
