-- Tasks of typed lines: TASK begins a command that goes on beside the next ones, JOIN waits for its answer.
-- Simulated time passes while a command waits, and not between lines.

-- Local copies: a script may set globals of these names.
local error, ipairs, math, pairs, pcall = error, ipairs, math, pairs, pcall
local table, tostring, type = table, tostring, type

return function(native, commands, lookup, tokens, states, is_any_alive)
  local background = {}

  -- The most tasks that may wait to be joined.
  local MOST = 64

  -- By number: { handle, name, line: as typed, is_over, number: of its error }.
  local begun, count = {}, 0

  local function numbers()
    local list = {}
    for number in pairs(begun) do
      list[#list + 1] = number
    end
    table.sort(list)
    return list
  end

  background.is_any = is_any_alive

  function background.check_none(name)
    if is_any_alive() then
      native.fail("BUSY", ("%s while a task is alive: JOIN or STOP comes first"):format(name))
    end
  end

  -- Begins a task; its command's answer or error is kept for JOIN.
  function background.begin(name, line, action)
    if native.has_jobs() then
      native.fail("BUSY", "TASK: of several ports each goes on by itself")
    elseif count == MOST then
      native.fail("BUSY", ("TASK: %d tasks were not joined (expected no more: JOIN comes first)"):format(MOST))
    end
    local entry = { name = name, line = line }
    entry.handle = commands.task(function()
      local results = table.pack(pcall(action))
      entry.is_over = true
      if not results[1] then
        local problem = results[2]
        entry.error = type(problem) == "table" and problem.number or lookup.errors.BAD_ARGUMENT.number
        entry.problem = problem
      end
      return entry, results[2]
    end)
    local number = math.tointeger(tostring(entry.handle):match("%d+"))
    begun[number], count = entry, count + 1
    states.forget(("since task %d was begun: UNDO takes back nothing from before a task's end"):format(number))
    return tokens.pairs { { "task", number } }
  end

  local function find(number)
    local entry = begun[number]
    if not entry then
      local known = numbers()
      local text = "task %s (expected %s)"
      native.fail("BAD_ARGUMENT", text:format(lookup.quote(number),
        known[1] and "one that was not joined: " .. lookup.listed(known) or "one that TASK has begun; there is none"))
    end
    return entry
  end

  -- Gives the commands' answers, one after another; the first error is JOIN's error.
  function background.join(arguments)
    local entries, texts, problem = {}, {}, nil
    for place, number in ipairs(arguments) do
      entries[place] = find(number)
    end
    for place, entry in ipairs(entries) do
      local _, text = commands.join(entry.handle)
      if begun[arguments[place]] then
        begun[arguments[place]], count = nil, count - 1
      end
      texts[#texts + 1] = not entry.error and type(text) == "string" and text ~= "" and text or nil
      problem = problem or entry.problem
    end
    if problem then
      error(problem, 0)
    end
    return table.concat(texts, "; ")
  end

  function background.list()
    local texts = {}
    for place, number in ipairs(numbers()) do
      local entry = begun[number]
      local how = not entry.is_over and "running" or entry.error and ("error %d"):format(entry.error) or "done"
      texts[place] = tokens.pairs { { "task" .. number, entry.name }, { "is", how } }
    end
    return table.concat(texts, " ")
  end

  -- The tasks that go on, as STATUS tells them: task1.command=..., or nil.
  function background.running()
    local list = {}
    for _, number in ipairs(numbers()) do
      local entry = begun[number]
      list[#list + 1] = not entry.is_over and { ("task%d.command"):format(number), entry.line } or nil
    end
    return list[1] and tokens.pairs(list)
  end

  function background.signal(arguments)
    commands.signal(arguments[1], math.tointeger(arguments[2]) or arguments[2])
  end

  function background.await(arguments)
    return tokens.pairs { { "taken", commands.await(arguments[1], arguments[2]) and "yes" or "no" } }
  end

  -- Ends all tasks where they are; true if there was one.
  function background.stop()
    if not is_any_alive() then
      return false
    end
    native.stop_in(0, nil, true)
    for _, number in ipairs(numbers()) do
      pcall(commands.join, begun[number].handle)
    end
    return true
  end

  return background
end
