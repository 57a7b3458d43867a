-- What a command at a station works on: its place, its gripper, and the station's parameters, each of which
-- the command may set for itself. All is checked before anything moves.

-- Kept, for a script may set globals of these names.
local ipairs, math, pairs, type = ipairs, math, pairs, type

return function(native, lookup)
  local targets = {}

  local parameters = lookup.parameters

  local function check_options(options)
    if options ~= nil and type(options) ~= "table" then
      native.fail("BAD_ARGUMENT", ("options: %s (expected a table)"):format(lookup.quote(options)))
    end
    for name, value in pairs(options or {}) do
      local kind = lookup.options[name] or parameters[name]
      if not kind then
        lookup.refuse_field(name, value, lookup.names(lookup.options, parameters))
      end
      lookup.value(name, value, kind)
    end
    return options or {}
  end

  -- What must hold between parameters. Strokes end where the neighbouring slots begin: a GET from below the
  -- next one would take its wafer.
  local function rules(target, station, layout)
    local pitch = station.slots > 1 and station.pitch or math.huge
    local window = layout.tolerance.projz / layout.slice
    local bottom = target.offset - target.stroke
    return {
      { "offset", target.offset <= target.stroke, "from 0 to the stroke, %.10g mm", target.stroke },
      { "stroke", math.max(-bottom, target.offset) < pitch,
        "within the pitch of %.10g mm below and above the slot", pitch },
      { "release", target.release >= bottom and target.release <= target.offset,
        "within the stroke: from %.10g to %.10g mm", bottom, target.offset },
      { "pickup_speed", not layout.sampled or target.pickup_speed <= window,
        'at most %.10g mm/s with these slices, or a layout with check = "swept"', window },
      { "pickup_acceleration", target.pickup_acceleration == 0 or target.pickup_acceleration >= 1e-6,
        "0, or 1e-6 mm/s^2 or more" },
      { "retries", math.tointeger(target.retries), "a whole number" },
    }
  end

  local function check(target, all)
    for _, rule in ipairs(all) do
      if not rule[2] then
        local name, expected = rule[1], rule[3]:format(rule[4], rule[5])
        local value = lookup.quote(target[name])
        native.fail("BAD_ARGUMENT", ("%s: %s (expected %s)"):format(name, value, expected))
      end
    end
  end

  -- The target of `word`, "get" or "put", at a slot. `gripper` (an index) overrules what the station says.
  function targets.at(word, station_name, slot, options, gripper)
    local station = lookup.station(station_name)
    local number = lookup.slot(station, slot)
    options = check_options(options)
    if not station.taught then
      native.fail("NOT_TAUGHT", ("%s: its layout says taught = false"):format(lookup.quote(station.name)))
    end
    local target = { station = station.name, slot = number, chuck = station.chuck, force = options.force }
    target.gripper = gripper or lookup.effector(options.gripper, station.effector)
    target.place = native.slot(station.index, number)
    for name in pairs(parameters) do
      target[name] = options[name]
      if target[name] == nil then
        target[name] = station[name]
      end
    end
    check(target, rules(target, station, native.layout))
    target.asks = target.vacuum_check == "both" or target.vacuum_check == word
    target.watched = target.asks
    return target
  end

  return targets
end
