-- SAVE, RESTORE and UNDO: the whole state of simulator and motion control, kept and put back.

-- Local copies: a script may set globals of these names.
local error, pairs, pcall, table = error, pairs, pcall, table

return function(native)
  local states = {}

  -- The states by name; and those from before each command that changed something, with its line, the
  -- latest at the end.
  local saved, before = {}, {}

  -- Since when, or why, nothing more can be taken back.
  local since = "since the layout was read"

  -- states.keep(), set by its owner: returns a function that puts back Lua's data, and one that tells whether
  -- it is unchanged.
  states.keep = nil

  local function take()
    local put_back, is_as_was = states.keep()
    return { host = native.save(), put_back = put_back, is_as_was = is_as_was }
  end

  -- Puts the simulator back first: if it refuses, nothing changes.
  local function put_back(state)
    native.restore(state.host)
    state.put_back()
  end

  function states.names()
    local list = {}
    for name in pairs(saved) do
      list[#list + 1] = name
    end
    return list
  end

  function states.save(name)
    saved[name] = take()
  end

  local function find(name)
    local names = states.names()
    if not saved[name] then
      local known = table.concat(names, ", ", 1, #names < 16 and #names or 16)
      local expected = #names > 0 and known or "a saved name; there is none"
      native.fail("NO_SUCH_SAVE", ('"%s" (expected %s)'):format(name, expected))
    end
    return saved[name]
  end

  function states.restore(name)
    put_back(find(name))
  end

  -- Takes back the last command that changed something: returns its line, and the number of those left.
  function states.undo()
    local last = before[#before]
    if not last then
      native.fail("NOTHING_TO_UNDO", native.has_jobs() and "of several ports at once nothing is taken back" or since)
    end
    put_back(last.state)
    before[#before] = nil
    return last.line, #before
  end

  -- The next change cannot be taken back, and so neither can earlier ones; `why` says so to UNDO.
  function states.forget(why)
    before, since = {}, why
  end

  -- Executes the command of this line so that it can be taken back, also if it ends outside of Lua.
  function states.follow(line, action, ...)
    local can_take, state = pcall(take)
    if not can_take then
      states.forget(("since %s: no state could be kept before it"):format(line))
      return action(...)
    end
    local entry = { line = line, state = state }
    if #before == native.most_undone() then
      table.remove(before, 1)
      since = ("of the last %d commands that changed something, which are taken back"):format(native.most_undone())
    end
    before[#before + 1] = entry
    local results = table.pack(pcall(action, ...))
    local is_same = not native.differs(entry.state.host) and entry.state.is_as_was()
    if is_same and before[#before] == entry then
      before[#before] = nil
    end
    if not results[1] then
      error(results[2], 0)
    end
    return table.unpack(results, 2, results.n)
  end

  return states
end
