-- The words for injected faults: fault { kind = , ... }, fault { error = } and clear_fault(number).

-- Local copies: a script may set globals of these names.
local error, ipairs, math, pairs, pcall, table = error, ipairs, math, pairs, pcall, table
local tostring, type = tostring, type

return function(native, lookup, arm, alarms)
  local words = {}

  local function text_of(value)
    if type(value) == "table" then
      local parts = {}
      for place, part in ipairs(value) do
        parts[place] = tostring(part)
      end
      return table.concat(parts, ",")
    end
    return type(value) == "string" and value:find("[^%w_.-]") and lookup.quote(value) or tostring(value)
  end

  local function describe(description)
    local fields = type(description) == "table" and description or {}
    local kind = fields.kind or fields.error == nil and description or nil
    local text = { "FAULT", kind ~= nil and tostring(kind) or nil }
    for name, value in pairs(fields) do
      if name ~= "kind" then
        text[#text + 1] = ("%s=%s"):format(tostring(name), text_of(value))
      end
    end
    return table.concat(text, " ")
  end

  local function arm_error(description)
    for name, value in pairs(description) do
      if name ~= "error" then
        local text = "fault: %s: %s (expected error alone: the next command that can answer it does)"
        native.fail("BAD_ARGUMENT", text:format(tostring(name), lookup.quote(value)))
      end
    end
    return alarms.arm(description.error)
  end

  -- The fault begins with the next slice, or `after` seconds later, and lasts `lasting` seconds or until it is
  -- cleared. A fault with an `error` waits for a command. Returns its number.
  function words.fault(description)
    return arm.run(nil, describe(description), function()
      if type(description) == "table" and description.error ~= nil then
        return arm_error(description)
      end
      local ok, result = pcall(native.fault, lookup.table("fault", description))
      if not ok and type(result) == "string" then
        native.fail("BAD_ARGUMENT", result)
      end
      return ok and result or error(result, 0)
    end)
  end

  -- The fault ends with the next slice.
  function words.clear_fault(number)
    local whole = type(number) == "number" and math.tointeger(number)
    arm.run(nil, "CLEAR " .. tostring(whole or number), function()
      if not whole then
        native.fail("BAD_ARGUMENT", ("number: %s (expected a fault's number)"):format(lookup.quote(number)))
      end
      native.clear_fault(whole)
    end)
  end

  return words
end
