-- Makes the operator's words out of what the host offers (`native`) and sets them as globals. Returns what
-- makes the same words of typed lines: a session calls it before it sets up the cell, a script's run never
-- does.

-- Kept, for a script may set globals of these names.
local error, ipairs, pairs, setmetatable, tostring, type = error, ipairs, pairs, setmetatable, tostring, type

return function(native)
  -- native.layout: the cell's layout, a value that `cell` sets. Before that whoever reads it hears what is
  -- missing.
  setmetatable(native, { __index = function(_, name)
    return name == "layout" and native.fail("NO_LAYOUT", 'begin the script with cell "LAYOUT.lua"')
  end })

  -- Raises the numbered error of that name. The numbers are kept, for a script may change wh.errors.
  local fail, numbers = native.fail, {}
  for name, entry in pairs(wh.errors) do
    numbers[name] = entry.number
  end
  function native.fail(name, detail)
    fail(numbers[name], detail)
  end

  local lookup = native.module("mcs/lookup.lua")(native, wh.errors)
  local commands = native.module("mcs/commands.lua")(native, native.module("mcs/patterns.lua"), lookup)
  local queries = native.module("mcs/queries.lua")(native, lookup)
  local rehearse, run = commands.rehearse, commands.run
  commands.rehearse, commands.run = nil, nil
  native.module("mcs/faults.lua")(native, commands, run, lookup)
  local cycles = native.module("mcs/cycles.lua")(native, lookup)

  -- cell "LAYOUT.lua", relative to the script: every slot's ends must be in reach.
  function cell(path)
    if type(path) ~= "string" then
      error(("cell: %s (expected a layout's path)"):format(tostring(path)), 0)
    end
    native.layout = native.cell(path)
    for name, station in pairs(native.layout.stations) do
      for _, slot in ipairs(station.taught and { 1, station.slots } or {}) do
        native.reach(station.index, slot)
        local problem = rehearse(name, slot)
        if problem then
          local reason = type(problem) == "table" and problem.text or tostring(problem)
          local message = "%s: stations.%s: slot %d (expected one in reach: %s)"
          error(message:format(native.layout.path, name, slot, reason), 0)
        end
      end
    end
    native.reach()
    native.connect()
  end

  -- study { placement = { dx = 0.3 }, ... }, before cell: what a study draws, in place of the layout's own.
  function study(errors)
    if type(errors) ~= "table" then
      error(("study: %s (expected a table)"):format(tostring(errors)), 0)
    end
    native.study(errors)
  end

  for _, group in ipairs({ commands, queries, cycles }) do
    for word, action in pairs(group) do
      _G[word] = action
    end
  end

  return function()
    local tokens = native.module("mcs/tokens.lua")(native)
    local make_commands = native.module("mcs/prompt_commands.lua")
    local prompt_commands = make_commands(native, commands, queries, lookup, tokens)
    local execute = native.module("mcs/prompt.lua")(native, prompt_commands, tokens, lookup)
    return execute, native.module("mcs/completion.lua")(prompt_commands, tokens)
  end
end
