-- Makes the operator's words from the host's functions (`native`) and sets them as globals. Returns the
-- function that makes these words from typed lines: a session calls it before it sets up the cell, a script's
-- run never does. It also returns the function that checks stations for `waferhand layout`, and the one that
-- `waferhand definitions` prints.

-- Local copies: a script may set globals of these names.
local error, ipairs, math, pairs, pcall, rawget, rawset, select = error, ipairs, math, pairs, pcall, rawget, rawset, select
local setmetatable, table, tostring, type, wh = setmetatable, table, tostring, type, wh

return function(native)
  -- native.layout: the cell's layout, a value that `cell` sets. Before that a read raises the missing
  -- layout as an error.
  setmetatable(native, { __index = function(_, name)
    return name == "layout" and native.fail("NO_LAYOUT", 'begin the script with cell "LAYOUT.lua"')
  end })

  -- Raises the numbered error of that name. The numbers are copied, because a script may change wh.errors.
  local fail, numbers = native.fail, {}
  for name, entry in pairs(wh.errors) do
    numbers[name] = entry.number
  end
  function native.fail(name, detail)
    fail(numbers[name], detail)
  end

  local parts = native.module("mcs/parts.lua")(native, wh)
  local lookup, alarms, reach = parts.lookup, parts.alarms, parts.reach
  local commands, queries = parts.commands, parts.queries
  local cycles = native.module("mcs/cycles.lua")(native, lookup)
  local flows = native.module("mcs/flow.lua")(native, parts.tasks, parts.commands, lookup, parts.slot_map,
    native.module("mcs/flow_ports.lua")(native, parts.tasks, parts.commands, parts.ports, parts.slot_map))

  -- cell "LAYOUT.lua", relative to the script: every slot must be in reach.
  local function cell(path)
    if type(path) ~= "string" then
      error(("cell: %s (expected a layout's path)"):format(tostring(path)), 0)
    end
    if type(rawget(_G, "patterns")) == "string" then
      error('patterns: it was assigned (expected the call patterns "FILE.lua", before cell)', 0)
    end
    native.layout = native.cell(path)
    parts.own.open(native.layout)
    for name, station in pairs(native.layout.stations) do
      reach.check(station, function(slot, _, reason, robot)
        local message = "%s: stations.%s%s: slot %d (expected one in reach: %s)"
        local by = lookup.has_several() and ".by." .. native.layout.robots[robot].name or ""
        error(message:format(native.layout.path, name, by, slot, reason), 0)
      end)
      local unreached, why = native.unreached(station.index)
      if unreached then
        local message = "%s: stations.%s: slot %d (expected one in reach: %s)"
        error(message:format(native.layout.path, name, unreached, why), 0)
      end
    end
    native.connect()
    native.begin_clocks()
  end

  -- study { placement = { dx = 0.3 }, ... }, before cell: the errors that a study draws, in place of the
  -- layout's own.
  local function study(errors)
    if type(errors) ~= "table" then
      error(("study: %s (expected a table)"):format(tostring(errors)), 0)
    end
    native.study(errors)
  end

  -- Returns the results of an action. An error tells no place in these files.
  local function finish(ok, ...)
    if ok then
      return ...
    end
    local problem = ...
    error(type(problem) == "string" and native.outside(problem) or problem, 0)
  end

  local actions = {}

  -- Makes the word for scripts: it refuses arguments that the action does not use.
  local function word(name, action)
    local most, any = native.parameters(action)
    actions[name] = action
    return function(...)
      parts.own.refuse(name)
      native.begin_word(name)
      flows.refuse(name)
      for place = any and math.maxinteger or most + 1, select("#", ...) do
        local extra = select(place, ...)
        if extra ~= nil then
          local text = "%s: %s is one argument too many (expected at most %d)"
          native.fail("BAD_ARGUMENT", text:format(name, lookup.quote(extra), most))
        end
      end
      if queries[name] then
        alarms.check(name:upper())
      end
      return finish(pcall(action, ...))
    end
  end

  for _, group in ipairs({ commands, queries, cycles, { flow = flows.flow }, { cell = cell, study = study, patterns = parts.own.patterns } }) do
    for name, action in pairs(group) do
      rawset(_G, name, word(name, action))
    end
  end

  -- The words as lua/mcs/words.lua describes them: each action must take that.
  local words

  local function described()
    words = words or native.module("mcs/words.lua")
    for name, action in pairs(actions) do
      local known = words.scripts[name]
      local most, any = native.parameters(action)
      if not known or any ~= (known.any or false) or not any and most ~= #known.takes then
        error(("%s does not take what lua/mcs/words.lua says"):format(name), 0)
      end
    end
    return words
  end

  -- robot "VAC": the words bound to it, as in VAC:get("LL", 1).
  local function robot(name)
    local index, words_of_it, names = lookup.robot(name), {}, {}
    for _, known in ipairs(described().scripts) do
      local bound = known[1]
      local action = known.bound and _G[bound]
      names[#names + 1] = action and bound or nil
      words_of_it[bound] = action and function(self, ...)
        if self ~= words_of_it then
          native.fail("BAD_ARGUMENT", ("%s: called with a dot (expected a colon, as in ROBOT:%s(...))"):format(bound, bound))
        end
        return parts.bind(index, action, ...)
      end
    end
    return setmetatable(words_of_it, { __index = function(_, other)
      native.fail("BAD_ARGUMENT", ("%s: no word of a robot (expected %s)"):format(tostring(other), table.concat(names, ", ")))
    end })
  end

  rawset(_G, "robot", word("robot", robot))

  local function open_prompt()
    local tokens = native.module("mcs/tokens.lua")(native)
    local states = native.module("mcs/saved_states.lua")(native)
    local make_commands = native.module("mcs/prompt_commands.lua")
    local background = native.module("mcs/prompt_tasks.lua")(native, commands, lookup, tokens, states,
      parts.tasks.is_any_alive)
    local answers = native.module("mcs/prompt_answers.lua")(native, commands, queries, lookup, tokens, states, parts.keep, background)
    local prompt_commands = make_commands(native, commands, answers, lookup, tokens, states, background, parts.own)
    local execute = native.module("mcs/prompt.lua")(native, prompt_commands, tokens, lookup, states, alarms,
      parts.bind, background)
    return execute, native.module("mcs/completion.lua")(prompt_commands, tokens), parts.tasks.serve
  end

  -- For a layout that was already read: returns three functions with a station's name. They check a station, play
  -- there, and turn over there (without a name: at home). See lua/mcs/reach.lua.
  local function survey(layout)
    native.layout = layout
    parts.own.open(layout)
    return function(name, found, missed)
      reach.check(layout.stations[name], found)
      reach.check_later(layout.stations[name], found)
      reach.check_untaught(layout.stations[name], missed)
      reach.check_corrections(layout.stations[name], missed)
      reach.check_blades(layout.stations[name], missed)
    end, function(from, name, cell, failed, gripper)
      local station = layout.stations[name]
      if from then
        reach.play_carrying(layout.stations[from], station, cell, failed)
      else
        reach.play(station, cell, failed, gripper)
      end
    end, function(name, cell, failed)
      reach.play_flips(layout.stations[name], cell, failed)
    end
  end

  local function define()
    return native.module("mcs/definitions.lua")(native, lookup, parts.targets, described(), wh)()
  end

  return open_prompt, survey, define, parts.finish
end
