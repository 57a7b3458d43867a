-- SAVE, RESTORE and UNDO: what simulator and motion control are, kept whole and put back.

-- Kept, for a script may set globals of these names.
local error, pairs, pcall, table = error, pairs, pcall, table

return function(native)
  local states = {}

  -- By name; and, the last one at the end, from before each command that changed something, with its line.
  local saved, before = {}, {}

  -- states.keep(), set by its owner: a function that puts back what Lua knows, and one that says if that is as
  -- it was.
  states.keep = nil

  local function take()
    local put_back, is_as_was = states.keep()
    return { host = native.save(), put_back = put_back, is_as_was = is_as_was }
  end

  -- The simulator first: what it refuses changes nothing.
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

  -- Takes back the last command that changed something: returns its line, and how many are left.
  function states.undo()
    local last = before[#before]
    if not last then
      native.fail("NOTHING_TO_UNDO", "since the layout was read")
    end
    put_back(last.state)
    before[#before] = nil
    return last.line, #before
  end

  -- What comes now cannot be taken back, and so nothing from before it.
  function states.forget()
    before = {}
  end

  -- Carries out the command of this line so that it can be taken back: also one that ends past all Lua.
  function states.follow(line, action, ...)
    local can_take, state = pcall(take)
    if not can_take then
      states.forget()
      return action(...)
    end
    local entry = { line = line, state = state }
    if #before == native.most_undone() then
      table.remove(before, 1)
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
