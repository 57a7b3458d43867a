-- The word that marks the beginning of a cycle, for wafers per hour: see lib/record/throughput.h.

-- Local copies: a script may set globals of these names.
local type = type

return function(native, lookup)
  local cycles = {}

  -- cycle() or cycle "name"; it lasts until the next one.
  function cycles.cycle(name)
    if name ~= nil and type(name) ~= "string" then
      native.fail("BAD_ARGUMENT", ("cycle: %s (expected a name, or nothing)"):format(lookup.quote(name)))
    end
    native.cycle(name or "")
  end

  return cycles
end
