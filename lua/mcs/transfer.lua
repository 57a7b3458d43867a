-- The operator's words that carry wafers: GET, PUT, SWAP, also in phases and with corrections; READY, which
-- only goes there; MAP, which only looks.

-- Local copies: a script may set globals of these names.
local ipairs, math, pairs, pcall, select, table, type = ipairs, math, pairs, pcall, select, table, type

return function(native, patterns, lookup, arm, player, targets, align, centring, alarms, slot_map, times, truth, ports)
  local transfer = {}

  ------------------------------------------------------------------------------------------------ GET and PUT

  local function name_of(gripper)
    return native.layout.grippers[gripper].name
  end

  -- A sensor that is on with a closed valve does not show a wafer. Passive pads have no valve.
  local function check_empty(target)
    local gripper = target.gripper
    if target.asks and native.sensor(gripper) then
      local name, wafer = name_of(gripper), native.held(gripper)
      if target.is_passive or native.is_open(gripper) then
        native.fail("WAFER_ON_GRIPPER", wafer and ("%s holds %s"):format(name, wafer)
          or ("the sensor of %s is on, without a wafer on its pads"):format(name))
      end
      native.fail(target.edge and "SENSORS_DISAGREE" or "VACUUM_BEFORE_PICK",
        ("the sensor of %s is on, its valve closed"):format(name))
    end
  end

  -- "EE holds Wafer 1, PA holds Wafer 2": for all grippers, or that none holds a wafer.
  local function holders()
    local list = {}
    for index, gripper in ipairs(native.layout.grippers) do
      local wafer = native.held(index)
      list[#list + 1] = wafer and ("%s holds %s"):format(gripper.name, wafer)
    end
    return #list > 0 and lookup.listed(list) or "no gripper holds one"
  end

  local function check_loaded(target)
    if target.asks and not native.sensor(target.gripper) then
      local text = "the sensor of %s is off; %s"
      native.fail("NO_WAFER_ON_GRIPPER", text:format(name_of(target.gripper), holders()))
    end
  end

  -- A station may take only wafers with one face up.
  local function check_face(target)
    local face = target.face and native.held_face(target.gripper)
    if face and face ~= target.face then
      local text = "%s lies face %s on %s (expected face %s: %s says so)"
      native.fail("WRONG_FACE", text:format(native.held(target.gripper), face, name_of(target.gripper), target.face,
        target.station))
    end
  end

  local HELD = "%s still holds %s: its valve or vacuum did not let go of it when %s was to take it"

  -- Adds what kept the gripper from taking anything when it was asked: another one, or its own valve.
  local function add_hindrance(list, gripper, hindered)
    local name = name_of(gripper)
    if not hindered or hindered.gripper ~= gripper then
      return
    end
    if hindered.holder then
      list[#list + 1] = HELD:format(hindered.holder, hindered.wafer, name)
    end
    if hindered.is_shut then
      list[#list + 1] = ("the valve of %s did not open: it was told to %.10g s before"):format(name, hindered.late)
    elseif hindered.late > 0 then
      list[#list + 1] = ("the valve of %s opened %.10g s late"):format(name, hindered.late)
    end
  end

  -- The reasons why the running command took nothing: all that are known, a list.
  local function find_reasons(gripper, hindered)
    local name, list = name_of(gripper), {}
    add_hindrance(list, gripper, hindered)
    local wafer, reasons = native.closest(gripper)
    if wafer then
      list[#list + 1] = ("%s came closest to %s: %s"):format(name, wafer, reasons)
    end
    local force, weight = native.weight(gripper)
    if force and not wafer then
      list[#list + 1] = ("%s is turned over, where its pads hold no wafer: %.4g N (expected at least mass * gravity * n, "
        .. "%.4g N)"):format(name, force, weight)
    end
    return list
  end

  local function explain(gripper, hindered)
    local list = find_reasons(gripper, hindered)
    return list[1] and table.concat(list, "; ") or ("no wafer came near %s while its valve was open"):format(name_of(gripper))
  end

  -- A length as text, without a minus before zeros.
  local function to_micrometre(length)
    local text = ("%.3f"):format(length)
    return text == "-0.000" and "0.000" or text
  end

  -- The reason why the chuck did not take the wafer: it was not let go, or it still lies where the running
  -- command let it go.
  local function explain_lost(gripper, chuck, hindered)
    local kept = native.held(gripper)
    if kept then
      return HELD:format(name_of(gripper), kept, name_of(chuck))
    end
    local wafer, dx, dy, dz, reasons = native.let_go(chuck)
    if not wafer then
      return explain(chuck, hindered)
    end
    local list = {}
    add_hindrance(list, chuck, hindered)
    local text = "%s did not take %s, which lies at dX %s, dY %s, dz %s mm: %s"
    list[#list + 1] = reasons
    reasons = list[1] and table.concat(list, " and ") or "that is within the tolerance, so valve or vacuum did not act"
    dx, dy, dz = to_micrometre(dx), to_micrometre(dy), to_micrometre(dz)
    return text:format(name_of(chuck), wafer, dx, dy, dz, reasons)
  end

  -- By result: the error that it is.
  local ERRORS = { missing = "WAFER_MISSING", late = "VACUUM_TIMEOUT", early = "VACUUM_BEFORE_PICK", lost = "WAFER_LOST",
                   loose = "VACUUM_TIMEOUT", stuck = "WAFER_LOST", jammed = "WAFER_JAMMED", unmoved = "PLUNGER_STUCK",
                   unclosed = "GRIP_TIMEOUT", unopened = "UNGRIP_TIMEOUT", disagree = "SENSORS_DISAGREE" }

  -- A result of a pattern of one's own that no step gave: what the cell knows is told, and no cause beyond it.
  local function check_claim(target, found)
    local claimed = target.source and target.source.claimed
    if claimed and found == "uncentred" and not target.centred and not target.refused then
      native.fail("TOO_FEW_SAMPLES", claimed .. "; it did not ask for the beams' result")
    elseif claimed and ERRORS[found] then
      local list = found == "missing" and find_reasons(target.gripper, target.hindered) or {}
      table.insert(list, 1, claimed)
      list[#list + 1] = holders()
      native.fail(ERRORS[found], table.concat(list, "; "))
    end
  end

  -- Fails with the result of the target's pattern.
  local function fail(target, error_name, text)
    native.fail(error_name, target.source and ("%s; by %s"):format(text, target.source.pattern) or text)
  end

  -- Fails for a gripper whose sensor is off although the simulator sees a wafer on it.
  local function fail_late(target, gripper)
    local wafer = native.held(gripper) or "a wafer"
    local text = "the sensor of %s stayed off for %.10g s, its timeout, with %s on its pads"
    fail(target, "VACUUM_TIMEOUT", text:format(name_of(gripper), target.timeout, wafer))
  end

  -- A gripper that enters less than projz below the slot takes its wafer from there.
  local function taken_below(target)
    local below, projz = target.stroke - target.offset, native.layout.tolerance.projz
    local text = ": it takes the wafer from %.6g mm below (expected stroke - offset above projz, %.6g mm)"
    return below < projz and text:format(below, projz) or ""
  end

  local SAYS = { jammed = "stands before its window", missed = "stands behind its window", closed = "holds a wafer",
                 closing = "is on its way", still = "has not moved", opening = "is on its way back", open = "is open" }

  -- To a micrometre; a value with a small excess has all digits, so that the excess shows.
  local function short(value, excess)
    return (excess < 5e-4 and "%.10g" or "%.3f"):format(value)
  end

  -- The result of a plunger, as an error if it is one.
  local PLUNGER = {}

  function PLUNGER.unmoved(target, name, was)
    fail(target, "PLUNGER_STUCK", ("that of %s is at %.3f mm"):format(name, was.s))
  end

  function PLUNGER.unclosed(target, name, was)
    local text = "that of %s had %.10g s, and is at %.3f mm"
    fail(target, "GRIP_TIMEOUT", text:format(name, math.max(target.edge.travel, target.timeout), was.s))
  end

  function PLUNGER.unopened(target, name, was)
    local text = "that of %s had %.10g s, and is at %.3f mm"
    fail(target, "UNGRIP_TIMEOUT", text:format(name, math.max(target.edge.travel, target.timeout), was.s))
  end

  function PLUNGER.disagree(target, name, was)
    local text = "the sensor of %s is %s, but its plunger %s"
    fail(target, "SENSORS_DISAGREE", text:format(name, was.is_on and "on" or "off", SAYS[was.does]))
  end

  function PLUNGER.jammed(target, name, was)
    local clearance = native.layout.grippers[target.gripper].edge.clearance
    fail(target, "WAFER_JAMMED", was.excess > 0
      and ("a wafer lies %s mm off the centre of %s (expected at most its clearance, %.10g mm; by %s mm)"):format(
        short(clearance + was.excess, was.excess), name, clearance, short(was.excess, was.excess))
      or ("the plunger of %s stands at %.3f mm: the wafer is too large"):format(name, was.s))
  end

  function PLUNGER.missing(target, name, was)
    local edge = native.layout.grippers[target.gripper].edge
    local small = "the plunger of %s stands at %.3f mm, behind its window up to %.10g mm: the wafer is too small, or its "
      .. "notch is at a rest"
    local none = "the plunger of %s went on to the end of its stroke: no wafer lies there, or one that is too far out, "
      .. "too high, too low or askew"
    fail(target, "WAFER_MISSING", was.s < edge.stop and small:format(name, was.s, edge.to) or none:format(name))
  end

  local function judge_plunger(target, found)
    local fail_by = target.edge and PLUNGER[found]
    if fail_by then
      fail_by(target, name_of(target.gripper), target.plunger)
    end
  end

  -- The result of a GET's pattern, as an error unless it took a wafer.
  local function judge_get(target, found)
    check_claim(target, found)
    judge_plunger(target, found)
    if found == "missing" and target.is_passive then
      local text = "%s came up through %s slot %d without a wafer on its pads"
      fail(target, "WAFER_MISSING", text:format(name_of(target.gripper), target.station, target.slot))
    elseif found == "missing" then
      fail(target, "WAFER_MISSING", explain(target.gripper, target.hindered))
    elseif found == "late" then
      fail_late(target, target.gripper)
    elseif found == "early" then
      local text = "the sensor of %s came on below the slot, as soon as its valve opened%s"
      fail(target, "VACUUM_BEFORE_PICK", text:format(name_of(target.gripper), taken_below(target)))
    end
  end

  local function judge_put(target, became)
    check_claim(target, became)
    judge_plunger(target, became)
    if became == "uncentred" then
      centring.fail(target)
    elseif became == "lost" then
      fail(target, "WAFER_LOST", explain_lost(target.gripper, target.chuck, target.hindered))
    elseif became == "loose" then
      fail_late(target, target.chuck)
    elseif became == "feigned" then
      local text = "the sensor of %s stayed on, though %s slot %d had taken the wafer over: %s came up again and took it"
      local name = name_of(target.gripper)
      fail(target, "WAFER_LOST", text:format(name, target.station, target.slot, name))
    elseif became == "stuck" then
      local kept, name = native.held(target.gripper), name_of(target.gripper)
      if kept and target.is_passive then
        local text = "%s still holds %s: nothing in %s slot %d took it over"
        fail(target, "WAFER_LOST", text:format(name, kept, target.station, target.slot))
      end
      fail(target, "WAFER_LOST", kept and ("%s still holds %s: its valve or vacuum did not let go of it"):format(name, kept)
        or ("the sensor of %s is still on, with nothing on its pads"):format(name))
    end
  end

  -- Fails if a GET has taken the wafer of another slot. Its sensor says nothing of that.
  local function check_origin(target)
    local was_elsewhere, wafer, station, slot = native.was_elsewhere(target.gripper,
      lookup.station(target.station).index, target.slot)
    if was_elsewhere then
      local text = "%s holds %s, which lay in %s slot %d (expected the wafer of %s slot %d)"
      native.fail("WRONG_SLOT", text:format(name_of(target.gripper), wafer, station, slot, target.station, target.slot))
    end
  end

  local transfers = {
    get = { check_gripper = check_empty, check_slot = slot_map.check_get, judge = judge_get, note = slot_map.note_taken },
    put = { check_gripper = check_loaded, check_slot = slot_map.check_put, judge = judge_put, note = slot_map.note_put },
  }

  local function carry(word, station, slot, options)
    local kind, target = transfers[word], targets.at(word, station, slot, options, nil, "")
    arm.check_free()
    times.check(word, target)
    alarms.break_at(word:upper(), word, target)
    kind.check_gripper(target)
    check_face(target)
    kind.check_slot(target)
    local plan = player.rehearse(patterns[word], target, true)
    local wafer = word == "put" and native.held(target.gripper)
    local notch, deviation
    if word == "get" then
      notch, deviation = align.notch(target)
    end
    slot_map.forget(target)
    align.forget(target.station)
    player.drive(plan, function(became)
      kind.judge(target, became)
      if word == "get" then
        check_origin(target)
        truth.expect_taken(target)
      end
      kind.note(target)
      truth.expect_given(target, wafer)
      centring.know_notch(target.gripper, notch, deviation)
    end)
    return target.centred
  end

  -- The options with an ALIGN's result for the GET, if they do not give a correction themselves.
  local function with_found(station, options, prefix)
    local found = align.correction(station, options, prefix)
    if not found then
      return options
    end
    local all = {}
    for name, value in pairs(type(options) == "table" and options or {}) do
      all[name] = value
    end
    for name, value in pairs(found) do
      all[prefix .. name] = value
    end
    return all
  end

  -- The command's text for the record: with its corrections, and where it stops.
  local function text_of(word, station, slot, options, ...)
    if type(options) ~= "table" then
      return lookup.command(word, station, slot)
    end
    local fields = {}
    for _, prefix in ipairs({ ... }) do
      for _, name in ipairs(lookup.correction_fields) do
        fields[#fields + 1] = prefix .. name
      end
      fields[#fields + 1] = prefix .. "correct"
      fields[#fields + 1] = prefix .. "stop"
    end
    table.move({ "force", "speed", "acceleration" }, 1, 3, #fields + 1, fields)
    return lookup.command(word, station, slot, lookup.fields_text(options, fields))
  end

  function transfer.get(station, slot, options)
    local text = text_of("GET", station, slot, with_found(station, options, ""), "")
    arm.move(arm.needs(true, station, options), text, carry, "get", station, slot, options)
  end

  function transfer.put(station, slot, options)
    local text, needs = text_of("PUT", station, slot, options, ""), arm.needs(true, station, options)
    needs.latches = targets.centres(station, needs.robot, options)
    return arm.move(needs, text, carry, "put", station, slot, options)
  end

  ------------------------------------------------------------------------------------------------------- SWAP

  -- The robot's grippers: the first empty one and the first that holds a wafer, as the sensors tell.
  local function find_grippers(robot)
    local empty, loaded
    for _, index in ipairs(lookup.on_robot(robot)) do
      if native.sensor(index) then
        loaded = loaded or index
      else
        empty = empty or index
      end
    end
    return empty, loaded
  end

  local function check_grippers(robot, empty, loaded)
    local indices, names = lookup.on_robot(robot)
    if #indices < 2 then
      local text = "SWAP takes with one and puts with another (expected two on the robot; there is %s)"
      native.fail("NO_SUCH_GRIPPER", text:format(lookup.listed(names)))
    elseif not loaded then
      native.fail("NO_WAFER_ON_GRIPPER", "SWAP puts what one on the robot holds; " .. holders())
    elseif not empty then
      native.fail("WAFER_ON_GRIPPER", "SWAP takes with an empty one on the robot; " .. holders())
    end
  end

  local function swap(station, slot, options)
    if type(options) == "table" and options.gripper ~= nil then
      local text = "gripper: %s (expected none: SWAP takes with the empty one and puts with the other)"
      native.fail("BAD_ARGUMENT", text:format(lookup.quote(options.gripper)))
    end
    local robot = lookup.robot_for(station, type(options) == "table" and { robot = options.robot })
    local empty, loaded = find_grippers(robot)
    local take = targets.at("get", station, slot, options, empty or lookup.on_robot(robot)[1], "get_")
    check_grippers(robot, empty, loaded)
    local give = targets.at("put", station, slot, options, loaded, "put_")
    if give.centre then
      native.fail("BAD_ARGUMENT", "put_centre: true (expected false: the beams would see both wafers of a SWAP)")
    end
    local target = { get = take, put = give, watched = take.watched, robot = robot, share = take.share }
    arm.check_free()
    times.check("swap", take)
    alarms.break_at("SWAP", "get", take)
    check_empty(take)
    check_face(give)
    slot_map.check_get(take)
    local plan = player.rehearse(patterns.swap, target, true)
    local wafer = native.held(give.gripper)
    local notch, deviation = align.notch(take)
    slot_map.forget(take)
    align.forget(take.station)
    player.drive(plan, function(became)
      judge_get(take, became)
      judge_put(give, became)
      truth.expect_given(give, wafer)
      check_origin(take)
      truth.expect_taken(take)
      slot_map.note_put(give)
      centring.know_notch(take.gripper, notch, deviation)
      centring.know_notch(give.gripper)
    end)
  end

  -- Takes the wafer there with the empty gripper and puts down the wafer of another one.
  function transfer.swap(station, slot, options)
    local text = text_of("SWAP", station, slot, with_found(station, options, "get_"), "get_", "put_")
    local which = type(options) == "table" and { robot = options.robot }
    arm.move(arm.needs(true, station, which), text, swap, station, slot, options)
  end

  ------------------------------------------------------------------------------------------------------ READY

  local function ready(station, slot, options)
    local target = targets.at("get", station, slot, options)
    arm.check_free()
    ports.check(station)
    target.loaded = native.sensor(target.gripper)
    player.play(patterns.ready, target)
  end

  -- Moves in front of the slot, to where a GET or, with a wafer, a PUT enters.
  function transfer.ready(station, slot, options)
    local text = lookup.command("READY", station, slot, lookup.fields_text(options, lookup.shares))
    arm.move(arm.needs(true, station, options, true), text, ready, station, slot, options)
  end

  -------------------------------------------------------------------------------------------------------- MAP

  local function map_target(name, options, gripper)
    local target, station = targets.at("get", name, 1, options, gripper), lookup.station(name)
    if target.touch then
      native.fail("NOT_LEVEL", "the blade is turned over, and its sensors with it: FLIP or HOME comes first")
    end
    target.margin = station.pitch / 2
    target.height = (station.slots - 1) * station.pitch
    return target, station
  end

  local function map(name, options)
    local target, station = map_target(name, options)
    arm.check_free()
    ports.check(name)
    player.play(patterns.map, target)
    local codes = native.scan(station.index, target.robot, targets.shift(station, target.robot))
    slot_map.map(name, codes)
    return codes
  end

  -- Sweeps over the station's slots; returns a list of their codes, see slot_map.lua.
  function transfer.map(station, options)
    local text = lookup.command("MAP", station, lookup.fields_text(options, lookup.shares))
    return arm.move(arm.needs(true, station, options), text, map, station, options)
  end

  -- For other commands and for trying out: GET and PUT within a command, how the result of either is judged, and
  -- the target of a MAP.
  return transfer, { carry = carry, judge = { get = judge_get, put = judge_put }, map_target = map_target }
end
