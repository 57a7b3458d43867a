-- EDGE_SCAN and ALIGN: a chuck turns once round while its edge sensor scans the wafer. The scan gives the
-- wafer's place. ALIGN turns its notch to the wanted angle, and the next GET from there corrects the rest.
--
-- Angles are rad here, and degrees for the operator. A chuck's frame turns with the chuck; at turn 0 it is the
-- station's. So a direction in the station's frame is the direction in the chuck's frame plus the chuck's turn.

-- Local copies: a script may set globals of these names.
local error, ipairs, math, pairs, pcall, type = error, ipairs, math, pairs, pcall, type

return function(native, patterns, lookup, arm, player, mechanisms, scan_reason)
  local align = {}

  local TURN = 2 * math.pi

  -- A sensor waits for a first sample that is less than half a turn ahead.
  local MOST_AHEAD = math.rad(170)

  -- Two scans of one wafer agree within these, six standard deviations of a sure result: mm and rad.
  local SAME_CENTRE, SAME_DIRECTION = 0.02, math.rad(0.07)

  -- The deviation between a blade's and a chuck's direction, as taught: rad.
  local AS_TAUGHT = math.rad(0.03)

  -- By station: the wafer's centre and its mark in the chuck's frame, as the last ALIGN there found them, and
  -- whether a GET corrects them. It is empty when something else may have moved the wafer on the chuck, or off
  -- it.
  local found = {}

  -- By station: the errors of its edge sensor that a CALIBRATE has found; without a CALIBRATE, those of the
  -- layout.
  local believed = {}

  local function wrapped(angle)
    local rest = angle % TURN
    return rest > math.pi and rest - TURN or rest
  end

  local function rotated(at, angle)
    local cosine, sine = math.cos(angle), math.sin(angle)
    return cosine * at.x - sine * at.y, sine * at.x + cosine * at.y
  end

  local function axis_of(station)
    return native.layout.grippers[station.chuck].axis
  end

  -- The commanded turn of the station's chuck.
  local function turn_of(station)
    return native.axes()[axis_of(station)]
  end

  local function asks(station)
    return station.vacuum_check ~= "none"
  end

  ---------------------------------------------------------------------------------------------------- scanning

  local function stations_with(part)
    local names = {}
    for name, station in pairs(native.layout.stations) do
      names[#names + 1] = station[part] and name
    end
    return names
  end

  local function prealigners()
    local names = {}
    for _, name in ipairs(stations_with("chuck")) do
      names[#names + 1] = not native.layout.stations[name].flipper and name or nil
    end
    return names
  end

  -- Checks that it is a prealigner: "expected P".
  function align.prealigner(name)
    local station = lookup.station(name)
    if not station.chuck or station.flipper then
      local names = prealigners()
      local expected = #names > 0 and "expected " .. lookup.listed(names) or "this cell has no prealigner"
      native.fail("NOT_A_PREALIGNER", ("%s (%s)"):format(lookup.quote(name), expected))
    end
    return station
  end

  local function with_sensor(station)
    local names = stations_with("sensor")
    local those = #names > 0 and lookup.listed(names) or "this cell has none"
    local text = "station: %s (expected a prealigner with an edge sensor: %s)"
    if not station.sensor then
      native.fail("BAD_ARGUMENT", text:format(lookup.quote(station.name), those))
    end
    return station
  end

  -- Plays a single segment; `lost_as`: the error if the wafer is lost in it.
  local function play(segment, lost_as)
    player.play(patterns.single, { segment = segment, watched = true, lost_as = lost_as })
  end

  local function turn_to(station, angle, lost_as)
    local axes = native.axes()
    axes[axis_of(station)] = angle
    play({ axes = axes }, lost_as)
  end

  -- The angle of a scan: one turn plus two samples, so that the first sample is at least one sample ahead of
  -- the chuck.
  local function way_of(station)
    local step = TURN / station.sensor.samples
    return (station.sensor.samples + 2) * step
  end

  -- Plays the slice that arms the sensor. It moves nothing, so no segment watches the chuck's
  -- vacuum in it.
  local function arm_slice(station, lost_as)
    local was_on = asks(station) and native.sensor(station.chuck)
    play({ dwell = native.layout.slice }, lost_as)
    if was_on and not native.sensor(station.chuck) then
      local name = native.layout.grippers[station.chuck].name
      native.fail(lost_as or "WAFER_LOST_ON_WAY", ("the sensor of %s went off"):format(name))
    end
  end

  -- `way` is +1, counter-clockwise, or -1.
  -- `run_up`: the first sample comes later by this angle, rad, and the chuck turns on by it after the last one.
  local function scan(station, way, lost_as, run_up)
    mechanisms.check_pins(station)
    mechanisms.send_home(station, lost_as)
    local samples, from = station.sensor.samples, turn_of(station)
    local step = TURN / samples
    local ahead = math.min(run_up or 0, MOST_AHEAD)
    local first = way * (math.floor((way * from + ahead) / step) + 2) % samples
    native.arm_edge(station.chuck, first, way * samples)
    local ok, problem = pcall(function()
      arm_slice(station, lost_as)
      turn_to(station, from + way * (way_of(station) + 2 * (run_up or 0)), lost_as)
    end)
    native.disarm_edge()
    if not ok then
      error(problem, 0)
    end
  end

  local function edge_scan(name)
    scan(with_sensor(lookup.station(name)), 1)
    return native.edge()
  end

  -- Only one scan runs at a time: the simulator has only one.
  local function needs(station)
    local list = arm.needs(false, station)
    list.scan = true
    return list
  end

  -- Turns the chuck once round and returns its edge sensor's scan: { samples, first, count, missed, is_armed }.
  function align.edge_scan(station)
    return arm.move(needs(station), lookup.command("EDGE_SCAN", station), edge_scan, station)
  end

  -- The result of the last scan, or an error with the reason why there is none.
  local function estimate(station, own)
    local errors = believed[station.name] or station.sensor.believed
    local seen = native.estimate_edge(own.mark ~= "none", own.glass or 0, errors)
    if seen.verdict ~= "OK" then
      native.fail(seen.verdict, scan_reason(seen, station, own))
    end
    return seen
  end

  ------------------------------------------------------------------------------------------------- what is asked

  local function read_options(options)
    if options ~= nil and type(options) ~= "table" then
      native.fail("BAD_ARGUMENT", ("options: %s (expected a table)"):format(lookup.quote(options)))
    end
    local own = {}
    for name, value in pairs(options or {}) do
      local kind = lookup.align_fields[name]
      if not kind then
        lookup.refuse_field(name, value, lookup.names(lookup.align_fields))
      end
      own[name] = lookup.value(name, value, kind)
    end
    if own.turns and not math.tointeger(own.turns) then
      native.fail("BAD_ARGUMENT", ("turns: %.10g (expected a whole number)"):format(own.turns))
    elseif own.mark == "none" and own.angle then
      local text = 'angle: %.10g (expected none: with mark = "none" nothing is turned)'
      native.fail("BAD_ARGUMENT", text:format(own.angle))
    elseif own.correct ~= nil and own.mode and own.mode ~= "robot" then
      local text = 'correct: %s (expected none: with mode = "%s" the GET has nothing to correct)'
      native.fail("BAD_ARGUMENT", text:format(own.correct, own.mode))
    end
    return own
  end

  -- An edge grip centres by itself. The GET then corrects nothing but the turn, and the chuck has made that.
  local function centres_itself(station)
    local gripper = native.layout.grippers[station.effector]
    return gripper.edge and gripper.name
  end

  local function check_correct(station, own)
    local name = centres_itself(station)
    if name and own.correct == true then
      local text = "correct: true (expected none: %s has an edge grip, which centres by itself)"
      native.fail("BAD_ARGUMENT", text:format(name))
    elseif name and (own.mode or "robot") == "robot" then
      own.correct = false
    end
  end

  local function check_wafer(station)
    local name = native.layout.grippers[station.chuck].name
    if not native.is_open(station.chuck) then
      local text = "the valve of %s is closed (expected open: its vacuum holds the wafer that turns)"
      native.fail("NO_WAFER_ON_GRIPPER", text:format(name))
    elseif asks(station) and not native.sensor(station.chuck) then
      local text = "the sensor of %s is off (expected a wafer on the chuck of %s)"
      native.fail("NO_WAFER_ON_GRIPPER", text:format(name, station.name))
    end
  end

  -- Checks the correction of a GET that goes to the wafer's later place.
  local function check_correction(dx, dy)
    local most = native.layout.corrections
    if math.abs(dx) > most.dx or math.abs(dy) > most.dy then
      local text = "the GET would need dx %.3f and dy %.3f mm (expected up to %.10g and %.10g mm: corrections.x and .y "
        .. "of the layout; with correct = false the GET goes to where it was taught)"
      native.fail("CORRECTION_TOO_LARGE", text:format(dx, dy, most.dx, most.dy))
    end
  end

  ------------------------------------------------------------------------------------------------------- aligning

  -- Scans the wafer in as many turns as are asked for, evaluated together. `way`: +1
  -- counter-clockwise, -1 clockwise.
  local function look(station, own, way)
    native.forget_turns()
    for turn = 1, own.turns or 1 do
      if turn > 1 then
        native.keep_turn(believed[station.name] or station.sensor.believed)
      end
      scan(station, way, "WAFER_LOST")
    end
    return estimate(station, own)
  end

  -- Refuses an offset that the mode cannot correct. `at` is the wafer's middle in the chuck's frame, `turn` the
  -- chuck's turn.
  local function check_amount(station, own, at, turn)
    local x, y = rotated(at, turn)
    if own.mode == "stage" or own.mode == "pins" then
      mechanisms.check_way(station, x, y)
    elseif own.correct ~= false then
      check_correction(x, y)
    end
  end

  -- With pins, brings the wafer onto the chuck's axis before it is turned. Returns the expected result of a second
  -- scan.
  local function grip_again(station, own, first)
    if own.mode ~= "pins" then
      return first
    end
    local x, y = rotated(first, turn_of(station))
    mechanisms.check_way(station, x, y)
    mechanisms.grip_again(station, x, y)
    return { x = 0, y = 0, mark = first.mark, direction = first.direction }
  end

  -- With a stage, moves the chuck aside, so that the wafer's middle is at the station's middle.
  local function shift_aside(station, own, second)
    if own.mode == "stage" then
      local x, y = rotated(second, turn_of(station))
      mechanisms.shift(station, -x, -y, "WAFER_LOST")
    end
  end

  -- Checks that both scans are of one wafer that has only turned with its chuck.
  local function compare(first, second, station)
    local x, y = second.x - first.x, second.y - first.y
    local apart = math.sqrt(x * x + y * y)
    if apart > SAME_CENTRE then
      local text = "a scan before the turn and one after it differ by %.3f mm (expected up to %.6g mm): has the wafer "
        .. "slipped on the chuck of %s?"
      native.fail("CENTRE_NOT_SURE", text:format(apart, SAME_CENTRE, station.name))
    end
    local turned = first.mark and math.abs(wrapped(second.direction - first.direction)) or 0
    if turned > SAME_DIRECTION then
      local text = "a scan before the turn and one after it differ by %.3f degrees (expected up to %.6g): has the wafer "
        .. "slipped on the chuck of %s, or is the sensor's latency wrong?"
      native.fail("NOTCH_NOT_SURE", text:format(math.deg(turned), math.deg(SAME_DIRECTION), station.name))
    end
  end

  -- The wafer's middle in the station's frame; `at` is its place in the chuck's frame.
  local function place_of(station, at)
    local x, y = rotated(at, turn_of(station))
    local aside_x, aside_y = mechanisms.aside(station)
    return x + aside_x, y + aside_y
  end

  -- The answer without the time: the wafer before, with the chuck at `before`, and the wafer now.
  local function describe(station, first, second, before)
    local dx, dy = rotated(first, before)
    local now, after_dx, after_dy = turn_of(station), place_of(station, second)
    local answer = {
      eccentricity = math.sqrt(dx * dx + dy * dy), direction = math.deg(math.atan(dy, dx)), dx = dx, dy = dy,
      turn = math.deg(wrapped(now - before)),
      correction = math.sqrt(after_dx * after_dx + after_dy * after_dy),
      correction_angle = math.deg(math.atan(after_dy, after_dx)), after_dx = after_dx, after_dy = after_dy,
      radius = second.radius, sd_centre = second.sd_centre, mark = second.mark or "none",
    }
    if second.mark then
      answer.notch = math.deg(wrapped(first.direction + before))
      answer.after_notch = math.deg(wrapped(second.direction + now))
      answer.sd_notch = math.deg(second.sd_direction)
    end
    return answer
  end

  -- Turns the chuck so that the second scan, clockwise, ends with the mark at its angle; without a mark, with
  -- the wafer as before. So the chuck ends within half a turn of its start.
  local function align_wafer(name, options)
    local own = read_options(options)
    local station = with_sensor(align.prealigner(name))
    mechanisms.check_mode(station, own.mode)
    mechanisms.check_arm(station)
    check_correct(station, own)
    check_wafer(station)
    local begin, before = native.utime(), turn_of(station)
    found[station.name] = nil
    local first = look(station, own, 1)
    local by = first.mark and wrapped(math.rad(own.angle or 0) - first.direction - before) or 0
    check_amount(station, own, first, before + by)
    local expected = grip_again(station, own, first)
    turn_to(station, before + by + (own.turns or 1) * way_of(station), "WAFER_LOST")
    local second = look(station, own, -1)
    compare(expected, second, station)
    check_amount(station, own, second, turn_of(station))
    shift_aside(station, own, second)
    found[station.name] = { x = second.x, y = second.y, direction = second.direction, sd = second.sd_direction,
                            corrects = own.correct ~= false and own.mode ~= "pins", by_stage = own.mode == "stage" }
    local answer = describe(station, first, second, before)
    answer.seconds = (native.utime() - begin) / 1e6
    return answer
  end

  -- align("P", { angle = 90 }): see lua/README.md.
  function align.align(station, options)
    local angle = type(options) == "table" and options.angle or ""
    local rest = lookup.fields_text(options, { "mode", "mark", "glass", "turns", "correct" })
    return arm.move(needs(station), lookup.command("ALIGN", station, angle, rest), align_wafer, station, options)
  end

  ---------------------------------------------------------------------------------------- what a GET makes good

  -- Rounds to tenths of a micrometre: a command's text has all these digits.
  local function rounded(length)
    return math.floor(length * 1e4 + 0.5) / 1e4
  end

  -- The offset of a GET at the station from the taught place: { dx, dy } in the slot's frame with the chuck's
  -- present turn. Nil if nothing was found there, or if the command's options give an own correction.
  function align.correction(name, options, prefix)
    local own, at = type(options) == "table" and options or {}, found[name]
    local is_own = own[prefix .. "correct"] == false or own[prefix .. "dx"] ~= nil or own[prefix .. "dy"] ~= nil
    if not at or not at.corrects or is_own then
      return nil
    end
    local station = native.layout.stations[name]
    if asks(station) and not native.sensor(station.chuck) then
      return nil
    end
    local x, y = place_of(station, at)
    local dx, dy = rounded(x), rounded(y)
    local is_made_good = at.by_stage and dx == 0 and dy == 0
    return not is_made_good and { dx = dx, dy = dy } or nil
  end

  -- The notch's direction in the frame of a gripper that takes the wafer of this target, and its deviation;
  -- nothing if no notch was found there.
  function align.notch(target)
    local at = found[target.station]
    if at and at.direction then
      local turn = turn_of(native.layout.stations[target.station]) - math.rad(target.turn)
      return wrapped(at.direction + turn), math.sqrt(at.sd * at.sd + AS_TAUGHT * AS_TAUGHT)
    end
  end

  -- Call it when the wafer is taken from the station, another one comes, or its chuck lets it go.
  function align.forget(name)
    found[name] = nil
  end

  function align.forget_chuck(gripper)
    for name, station in pairs(native.layout.stations) do
      if station.chuck == gripper then
        found[name] = nil
      end
    end
  end

  local function copied(map)
    local copy = {}
    for name, value in pairs(map) do
      copy[name] = value
    end
    return copy
  end

  -- Returns a function that restores the present knowledge.
  function align.keep()
    local kept_found, kept_believed = copied(found), copied(believed)
    return function()
      found, believed = copied(kept_found), copied(kept_believed)
    end
  end

  ------------------------------------------------------------------------------------------------- for CALIBRATE

  align.scan, align.turn_of, align.turn_to = scan, turn_of, turn_to
  align.with_sensor, align.check_wafer = with_sensor, check_wafer

  -- The wafer's middle in the slot's frame, from one turn: mm.
  function align.find(station)
    local dx, dy = rotated(look(station, { mark = "none" }, 1), turn_of(station))
    check_correction(dx, dy)
    return rounded(dx), rounded(dy)
  end

  -- From now on these errors are assumed for the station's sensor. The wafer's middle is at x, y in the chuck's
  -- frame.
  function align.believe(station, errors, x, y)
    believed[station.name] = errors
    found[station.name] = { x = x, y = y, corrects = true }
  end

  return align
end
