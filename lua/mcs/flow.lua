-- The word that takes lots through a tool whose robots are times alone: see lib/flow/flow.h.

-- Local copies: a script may set globals of these names.
local rawget = rawget

return function(native)
  local flows = {}

  function flows.flow(description)
    return native.flow(description)
  end

  -- The words that such a cell has.
  local has = { flow = true, expect = true, cell = true, study = true, robot = true }

  -- Refuses the others: nothing stands anywhere in it.
  function flows.refuse(name)
    local layout = rawget(native, "layout")
    if layout and layout.timed and not has[name] then
      native.fail("BAD_ARGUMENT", name .. ": this cell's robots are times alone (expected flow, or robots with axes)")
    end
  end

  return flows
end
