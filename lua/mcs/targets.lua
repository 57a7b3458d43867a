-- The target of a command at a station: its place, its gripper, and the station's parameters, each of which
-- the command may set for itself. All is checked before anything moves.

-- Local copies: a script may set globals of these names.
local ipairs, math, pairs, type = ipairs, math, pairs, type

return function(native, lookup, align, mechanisms, stations, grips, planes)
  local targets = {}

  local parameters = lookup.parameters
  local parameter_names = lookup.names(parameters)

  targets.shift = stations.shift

  -- Other options of GET and PUT, and of SWAP for its GET and its PUT: the fields' kinds by name. The unit of
  -- a length or an angle has the index that it has in lookup.parameters.
  local kinds = { dx = { nil, nil, "mm" }, dy = { nil, nil, "mm" }, dz = { nil, nil, "mm" },
                  turn = { nil, nil, "degrees" }, stop = { values = lookup.phases }, centre = { values = { true, false } } }

  local function with_prefixes(...)
    local fields = {}
    for _, prefix in ipairs({ ... }) do
      for name, kind in pairs(kinds) do
        fields[prefix .. name] = kind
      end
    end
    return fields
  end

  targets.fields = { get = with_prefixes(""), put = with_prefixes(""), swap = with_prefixes("get_", "put_") }
  targets.fields.get.correct = lookup.correct
  targets.fields.swap.get_correct = lookup.correct

  -- The options of "get" or "put", alone or within a SWAP; `prefix` nil: the command has none.
  local function own_fields(word, prefix)
    return prefix and targets.fields[prefix == "" and word or "swap"] or {}
  end

  local NONE = {}

  local function check_options(options, own)
    if options == nil then
      return NONE
    end
    if type(options) ~= "table" then
      native.fail("BAD_ARGUMENT", ("options: %s (expected a table)"):format(lookup.quote(options)))
    end
    local common = own == targets.fields.swap and lookup.swap_options or lookup.options
    for name, value in pairs(options or {}) do
      local kind = common[name] or parameters[name] or own[name]
      if not kind then
        lookup.refuse_field(name, value, lookup.names(own, common, parameters))
      elseif kind[3] and not kind[2] then
        lookup.number(name, value, kind)
      else
        lookup.value(name, value, kind)
      end
    end
    return options or {}
  end

  -- The gripper's offset from the taught slot's frame: from the command's options, else from an ALIGN's result
  -- (`found`). Offsets that the layout does not allow are refused.
  local function read_corrections(target, options, prefix, found)
    local corrections = native.layout.corrections
    for _, name in ipairs(lookup.correction_fields) do
      local value = options[prefix .. name] or found[name] or 0
      local most = corrections[name]
      if value > most or value < -most then
        local field = name:match("^d([xyz])$") or name
        local text = "%s: %.10g (expected from %.10g to %.10g %s: corrections.%s of the layout%s)"
        local why = found[name] and ("; ALIGN found it: %scorrect = false goes without"):format(prefix) or ""
        native.fail("CORRECTION_TOO_LARGE",
          text:format(prefix .. name, value, -most, most, kinds[name][3], field, why))
      end
      target[name] = value
    end
    target.stop = options[prefix .. "stop"]
  end

  -- Whether a PUT goes aside by its beams' result.
  local function read_centre(target, word, station, options, prefix)
    local own = prefix and options[prefix .. "centre"]
    if word == "get" and own ~= nil and own ~= false then
      native.fail("BAD_ARGUMENT", ("%scentre: true (expected false: a PUT centres)"):format(prefix))
    end
    target.centre = word == "put" and prefix ~= nil and station.centres[target.robot]
    if word == "put" and own ~= nil then
      target.centre = own
    end
  end

  -- The reason why a PUT does not centre there.
  local function no_centre(target, station)
    local beams, robot = station.beams[target.robot], native.layout.robots[target.robot]
    if not lookup.has_several() then
      return ("false: %s has %d beams, and two tell a centre"):format(station.name, beams)
    elseif not robot.is_usual then
      return ('false: beams are for a robot of kind "TRZY" without rail, tilt and flip, and %s is another'):format(robot.name)
    end
    return ("false: %s passes %d beams on its way to %s, and two tell a centre"):format(robot.name, beams, station.name)
  end

  -- Whether a PUT there would go aside by its beams' result, as far as that is clear before the check.
  function targets.centres(station_name, robot, options)
    local station = type(station_name) == "string" and native.layout.stations[station_name]
    local own
    if type(options) == "table" then
      own = options.centre
    end
    return station and (own == true or own == nil and station.centres[robot]) or false
  end

  -- Checks relations between parameters. Strokes end where the neighbouring slots begin: a GET from below
  -- the next one would take its wafer.
  -- `limits`: pitch, window (the fastest stroke, mm/s), bottom (of the stroke) and the station.
  local RULES = {
    { "offset", function(target)
      return target.offset <= target.stroke, "from 0 to the stroke, %.10g mm", target.stroke
    end },
    { "stroke", function(target, limits)
      return math.max(-limits.bottom, target.offset) < limits.pitch,
        "within the pitch of %.10g mm below and above the slot", limits.pitch
    end },
    { "release", function(target, limits)
      return target.is_passive or target.release >= limits.bottom and target.release <= target.offset,
        "within the stroke: from %.10g to %.10g mm", limits.bottom, target.offset
    end },
    { "pickup_speed", function(target, limits)
      return target.pickup_speed <= limits.window,
        'at most %.10g mm/s with these slices, or a layout with check = "swept"', limits.window
    end },
    { "pickup_acceleration", function(target)
      return target.pickup_acceleration == 0 or target.pickup_acceleration >= 1e-6, "0, or 1e-6 mm/s^2 or more"
    end },
    { "centre", function(target, limits)
      local is_good = not target.centre or limits.station.beams[target.robot] > 1
      return is_good, "%s", not is_good and no_centre(target, limits.station)
    end },
    { "retries", function(target)
      return math.tointeger(target.retries), "a whole number"
    end },
    { "dz", function(target, limits)
      return math.max(-limits.bottom - target.dz, target.offset + target.dz) < limits.pitch,
        "with the stroke within the pitch of %.10g mm below and above the slot", limits.pitch
    end },
  }

  local function check(target, station, layout, prefix)
    local limits = { station = station, pitch = station.slots > 1 and station.pitch or math.huge, bottom = target.offset - target.stroke,
      window = layout.sampled and layout.tolerance.projz / layout.slice or math.huge }
    for _, rule in ipairs(RULES) do
      local is_good, expected, first, second = rule[2](target, limits)
      if not is_good then
        local name = rule[1]
        expected = expected:format(first, second)
        local value = lookup.quote(target[name])
        name = name == "dz" and (prefix or "") .. name or name
        native.fail("BAD_ARGUMENT", ("%s: %s (expected %s)"):format(name, value, expected))
      end
    end
  end

  -- The target of `word`, "get" or "put", at a slot. `gripper` (an index) overrules what the station says.
  -- `prefix` stands before the names of the corrections among the options; nil: the command has none.
  function targets.at(word, station_name, slot, options, gripper, prefix)
    local station = lookup.station(station_name)
    local number = lookup.slot(station, slot)
    options = check_options(options, own_fields(word, prefix))
    local robot = gripper and native.layout.grippers[gripper].robot or lookup.robot_for(station.name, options)
    stations.check_taught(station, robot)
    mechanisms.check_pins(station)
    mechanisms.check_flipper(station)
    local target = { station = station.name, slot = number, chuck = station.chuck, force = options.force, robot = robot,
      share = lookup.share(options) }
    target.stage_home = word == "put" and mechanisms.way_home(station) or nil
    target.gripper = gripper or lookup.effector(options.gripper, station.by[target.robot] or nil, target.robot)
    local found = word == "get" and prefix and align.correction(station.name, options, prefix)
    read_corrections(target, prefix and options or {}, prefix or "", found or {})
    target.place = stations.place(station, number, robot, target)
    for index = 1, #parameter_names do
      local name = parameter_names[index]
      local own = options[name]
      if own == nil then
        own = station[name]
      end
      target[name] = own
    end
    local edge = native.layout.grippers[target.gripper].edge
    if edge and options.release == nil and station.release_default then
      target.release = 0 -- its wafer lies on no pads, which would be lower
    end
    read_centre(target, word, station, options, prefix)
    local grip = native.layout.grippers[target.gripper].grip
    target.grip, target.plane, target.is_passive = grips[grip], planes.below, grip == "passive"
    check(target, station, native.layout, prefix)
    target.vent = target.is_passive and native.layout.vent or nil
    -- A blade that is turned over comes from above: its pads stop at `touch`, above the slot's plane.
    local flip = lookup.axis("flip", target.robot)
    if flip and math.abs(native.axes()[flip.index]) > math.pi / 2 then
      target.vent, target.plane = native.layout.vent, planes.above
      target.touch = native.layout.thickness + math.abs(target.release)
      if target.is_passive then
        local text = "%s is passive and turned over, where it holds nothing: FLIP or HOME comes first"
        native.fail("NOT_LEVEL", text:format(native.layout.grippers[target.gripper].name))
      end
    end
    target.edge = edge and { travel = edge.travel, slice = native.layout.slice, vent = native.layout.vent } or nil
    target.face = word == "put" and station.face or nil
    target.asks = target.vacuum_check == "both" or target.vacuum_check == word
    target.watched = target.asks
    target.retracts = native.layout.robots[target.robot].retracts
    return target
  end

  return targets
end
