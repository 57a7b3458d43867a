-- What a command at a station works on: its place, its gripper, and the station's parameters, each of which the
-- command may set for itself. All is checked before anything moves.

-- Kept, for a script may set globals of these names.
local ipairs, math, pairs, tostring, type = ipairs, math, pairs, tostring, type

return function(native, lookup)
  local targets = {}

  local parameters = lookup.parameters

  local function check_options(options)
    if options ~= nil and type(options) ~= "table" then
      native.fail("BAD_ARGUMENT", "options: " .. tostring(options) .. " (expected a table)")
    end
    for name, value in pairs(options or {}) do
      local expected = lookup.options[name] or parameters[name]
      if type(value) ~= expected then
        local what = expected and "a " .. expected or "gripper, force or a station parameter"
        native.fail("BAD_ARGUMENT", ("%s: %s (expected %s)"):format(tostring(name), tostring(value), what))
      end
    end
    return options or {}
  end

  local function is_one_of(value, ...)
    for _, known in ipairs({ ... }) do
      if value == known then
        return true
      end
    end
    return false
  end

  -- Strokes end where the neighbouring slots begin: a GET from below the next one would take its wafer.
  local function stroke_rules(target, station)
    local pitch = station.slots > 1 and station.pitch or math.huge
    return {
      { "stroke", target.stroke > 0, "above 0" },
      { "offset", target.offset >= 0 and target.offset <= target.stroke, "from 0 to the stroke" },
      { "stroke", math.max(target.stroke - target.offset, target.offset) < pitch,
        ("within the pitch of %.10g mm below and above the slot"):format(pitch) },
      { "retract", target.retract > 0, "above 0" },
      { "release", target.release >= target.offset - target.stroke and target.release <= target.offset, "within the stroke" },
    }
  end

  local function other_rules(target, layout)
    local window = layout.tolerance.projz / layout.slice
    return {
      { "pickup_speed", target.pickup_speed > 0, "above 0" },
      { "pickup_speed", not layout.sampled or target.pickup_speed <= window,
        ('at most %.10g mm/s with these slices, or a layout with check = "swept"'):format(window) },
      { "pickup_acceleration", target.pickup_acceleration == 0 or target.pickup_acceleration >= 1e-6, "0, or 1e-6 or more" },
      { "map_speed", target.map_speed > 0, "above 0" },
      { "vacuum_delay", target.vacuum_delay >= 0, "0 or more" },
      { "timeout", target.timeout >= 0, "0 or more" },
      { "wait", target.wait >= 0, "0 or more" },
      { "retries", math.tointeger(target.retries) and target.retries >= 0 and target.retries <= 100, "a whole number from 0 to 100" },
      { "handover", is_one_of(target.handover, "new_first", "same_slice"), '"new_first" or "same_slice"' },
      { "vacuum_check", is_one_of(target.vacuum_check, "both", "get", "put", "none"), '"both", "get", "put" or "none"' },
    }
  end

  local function check(target, rules)
    for _, rule in ipairs(rules) do
      if not rule[2] then
        native.fail("BAD_ARGUMENT", ("%s: %s (expected %s)"):format(rule[1], lookup.quote(target[rule[1]]), rule[3]))
      end
    end
  end

  -- The target of `word`, "get" or "put", at a slot. `gripper` (an index) overrules what the station says.
  function targets.at(word, station_name, slot, options, gripper)
    local station = lookup.station(station_name)
    local number = lookup.slot(station, slot)
    options = check_options(options)
    if not station.taught then
      native.fail("NOT_TAUGHT", lookup.quote(station.name))
    end
    local target = { station = station.name, slot = number, chuck = station.chuck, force = options.force, watched = true }
    target.gripper = gripper or lookup.effector(options.gripper, station.effector)
    target.place = native.slot(station.index, number)
    for name in pairs(parameters) do
      target[name] = options[name]
      if target[name] == nil then
        target[name] = station[name]
      end
    end
    check(target, stroke_rules(target, station))
    check(target, other_rules(target, native.layout))
    target.asks = target.vacuum_check == "both" or target.vacuum_check == word
    target.watched = target.asks
    return target
  end

  return targets
end
