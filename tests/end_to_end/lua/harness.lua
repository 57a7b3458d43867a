-- The smallest test harness: named tests, a few checks that say what differs, one line at the end.

local harness = {}
local passed, failed = 0, 0

function harness.test(name, body)
  local ok, message = xpcall(body, debug.traceback)
  if ok then
    passed = passed + 1
  else
    failed = failed + 1
    print("FAILED " .. name .. "\n  " .. tostring(message))
  end
end

function harness.equal(found, wanted, what)
  if found ~= wanted then
    error(("%s: found %s, wanted %s"):format(what or "value", tostring(found), tostring(wanted)), 2)
  end
end

function harness.near(found, wanted, tolerance)
  if not (math.abs(found - wanted) <= tolerance) then
    error(("found %.17g, wanted %.17g within %g"):format(found, wanted, tolerance), 2)
  end
end

-- Lists and records, compared entry by entry.
function harness.same(found, wanted, path)
  path = path or "value"
  if type(found) ~= "table" or type(wanted) ~= "table" then
    return harness.equal(found, wanted, path)
  end
  for key, value in pairs(wanted) do
    harness.same(found[key], value, path .. "." .. tostring(key))
  end
  for key in pairs(found) do
    harness.equal(wanted[key] ~= nil, true, path .. "." .. tostring(key) .. " expected")
  end
end

-- The call raises a string that says where and then exactly `wanted`.
function harness.raises(wanted, call)
  local ok, message = pcall(call)
  if ok then
    error("no error, wanted " .. wanted, 2)
  end
  harness.equal(type(message), "string", "type of error")
  local where, text = message:match("^([^:]+:%d+: )(.*)$")
  if not where or text ~= wanted then
    error("found  " .. message .. "\n  wanted " .. wanted, 2)
  end
end

-- Prints the result and ends the program with its exit status.
function harness.finish()
  print(("%d passed, %d failed"):format(passed, failed))
  os.exit(failed == 0 and passed > 0, true)
end

return harness
