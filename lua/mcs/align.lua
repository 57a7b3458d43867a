-- EDGE_SCAN and ALIGN: a chuck turns once round while its edge sensor looks at the wafer; what that says of the
-- wafer; its notch turned to where it shall be; and what the next GET from there makes good.
--
-- Angles are rad here, and degrees where the operator reads them. A chuck's frame turns with the chuck; at turn
-- 0 it is the station's. So a direction in the station's frame is the one in the chuck's and the chuck's turn.

-- Kept, for a script may set globals of these names.
local error, ipairs, math, pairs, pcall, type = error, ipairs, math, pairs, pcall, type

return function(native, patterns, lookup, arm)
  local align = {}

  local TURN = 2 * math.pi

  -- Two scans of one wafer say the same to six standard deviations of what passes for sure: mm and rad.
  local SAME_CENTRE, SAME_DIRECTION = 0.02, math.rad(0.07)

  -- How well a blade is in line with a chuck's frame, as they were taught: rad.
  local AS_TAUGHT = math.rad(0.03)

  -- By station: where the wafer's centre and its mark are in its chuck's frame, as the last ALIGN there found
  -- them, and if a GET makes that good; nothing once something else may have moved the wafer on the chuck, or off
  -- it.
  local found = {}

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

  -- Where the station's chuck is commanded to.
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

  -- A prealigner: "expected P".
  function align.prealigner(name)
    local station = lookup.station(name)
    if not station.chuck then
      local names = stations_with("chuck")
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

  -- A segment by itself; `lost_as`: the error if the wafer is lost in it.
  local function play(segment, lost_as)
    arm.play(patterns.single, { segment = segment, watched = true, lost_as = lost_as })
  end

  local function turn_to(station, angle, lost_as)
    local axes = native.axes()
    axes[axis_of(station)] = angle
    play({ axes = axes }, lost_as)
  end

  -- How far the chuck turns in a scan: a turn and two samples more, so that the first of them is at least one
  -- ahead of where it stands.
  local function way_of(station)
    local step = TURN / station.sensor.samples
    return (station.sensor.samples + 2) * step
  end

  -- `way` is +1, counter-clockwise, or -1.
  local function scan(station, way, lost_as)
    local samples, from = station.sensor.samples, turn_of(station)
    local step = TURN / samples
    local first = way * (math.floor(way * from / step) + 2) % samples
    native.arm_edge(station.chuck, first, way * samples)
    local ok, problem = pcall(function()
      play({ dwell = native.layout.slice }, lost_as)
      turn_to(station, from + way * way_of(station), lost_as)
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

  -- Turns the chuck once round and returns what its edge sensor saw: { samples, first, count, missed, is_armed }.
  function align.edge_scan(station)
    return arm.move(lookup.command("EDGE_SCAN", station), edge_scan, station)
  end

  ---------------------------------------------------------------------------------------- what a scan does not tell

  local function number_of_samples(seen)
    local text = "%d of %d samples see the rim, %d nothing, %d are covered, %d never came"
    local all = seen.seen + seen.nothing + seen.covered + seen.missed
    return text:format(seen.seen, all, seen.nothing, seen.covered, seen.missed)
  end

  local function offset_text(seen)
    return ("%.3f mm off the axis"):format(math.sqrt(seen.x * seen.x + seen.y * seen.y))
  end

  local function mark_text(seen)
    local depth = seen.limits.notch_depth
    return depth and ("a notch %.6g mm deep"):format(depth) or "a flat"
  end

  local reasons = {}

  function reasons.TOO_FEW_SAMPLES(seen)
    return ("%s (expected at least %d that do)"):format(number_of_samples(seen), seen.limits.samples)
  end

  function reasons.BAD_SCAN(seen)
    return number_of_samples(seen)
  end

  function reasons.OFF_SENSOR(seen, station)
    local sensor, text = station.sensor, "the wafer is %s, its radius %.3f mm; the sensor sees from %.6g to %.6g mm"
    local half = sensor.length / 2
    return text:format(offset_text(seen), seen.radius, sensor.middle - half, sensor.middle + half)
  end

  function reasons.TOO_ECCENTRIC(seen)
    return ("%s (expected at most %.6g mm)"):format(offset_text(seen), seen.limits.eccentricity)
  end

  function reasons.CENTRE_NOT_SURE(seen)
    local limits = seen.limits
    if not seen.radius then
      return "no circle is near half of the samples: " .. number_of_samples(seen)
    elseif math.abs(seen.radius - limits.radius) > limits.radius_off then
      local text = "the rim's radius is %.3f mm (expected %.6g mm, give or take %.6g)"
      return text:format(seen.radius, limits.radius, limits.radius_off)
    end
    local text = "its standard deviation is %.5f mm (expected at most %.6g mm); %s"
    return text:format(seen.sd_centre, limits.sd_centre, number_of_samples(seen))
  end

  function reasons.NO_NOTCH(seen)
    local text = 'the rim is round all round (expected %s; mark = "none" aligns the centre alone)'
    return text:format(mark_text(seen))
  end

  function reasons.TWO_NOTCHES(seen)
    return ("expected one alone that is %s"):format(mark_text(seen))
  end

  function reasons.NOTCH_NOT_SURE(seen)
    local text = "expected %s, known to %.6g degrees and unlike any other dent; %s, %d are off the circle"
    local sd = math.deg(seen.limits.sd_direction)
    return text:format(mark_text(seen), sd, number_of_samples(seen), seen.masked)
  end

  -- What the last scan says, or an error that says why it says nothing.
  local function estimate(station, own)
    local seen = native.estimate_edge(own.mark ~= "none", own.glass or 0)
    if seen.verdict ~= "OK" then
      local reason = reasons[seen.verdict]
      native.fail(seen.verdict, reason and reason(seen, station) or nil)
    end
    return seen
  end

  ------------------------------------------------------------------------------------------------- what is asked

  local MISSING = {
    stage = 'mode: "stage" (expected "robot": a layout cannot say yet that the chuck of %s is on an XY stage)',
    pins = 'mode: "pins" (expected "robot": a layout cannot say yet that pins beside the chuck of %s lift a wafer)',
  }

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
    if own.mark == "none" and own.angle then
      local text = 'angle: %.10g (expected none: with mark = "none" nothing is turned)'
      native.fail("BAD_ARGUMENT", text:format(own.angle))
    end
    return own
  end

  local function check_mode(station, mode)
    if MISSING[mode] then
      native.fail("BAD_ARGUMENT", MISSING[mode]:format(station.name))
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

  local function check_arm(station)
    local inside = arm.inside
    if inside and inside.station == station.name then
      local text = "the arm stands in %s slot %d since %s: RECOVER or HOME comes first"
      native.fail("STOPPED", text:format(inside.station, inside.slot, arm.since))
    end
  end

  -- Of a GET that goes to where the wafer will lie.
  local function check_correction(dx, dy)
    local most = native.layout.corrections
    if math.abs(dx) > most.dx or math.abs(dy) > most.dy then
      local text = "the GET would need dx %.3f and dy %.3f mm (expected up to %.10g and %.10g mm: corrections.x and .y "
        .. "of the layout; with correct = false the GET goes to where it was taught)"
      native.fail("CORRECTION_TOO_LARGE", text:format(dx, dy, most.dx, most.dy))
    end
  end

  ------------------------------------------------------------------------------------------------------- aligning

  -- Both scans are of one wafer that has only turned with its chuck.
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

  -- The answer but for the time: the wafer before, with the chuck at `before`, and as it lies now.
  local function describe(first, second, before, now)
    local dx, dy = rotated(first, before)
    local after_dx, after_dy = rotated(second, now)
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

  -- The chuck turns to where the second scan, clockwise, ends with the mark at its angle; without a mark, with
  -- the wafer as it was. So the chuck ends within half a turn of where it began.
  local function align_wafer(name, options)
    local own = read_options(options)
    local station = with_sensor(align.prealigner(name))
    check_mode(station, own.mode)
    check_arm(station)
    check_wafer(station)
    local begin, before = native.utime(), turn_of(station)
    found[station.name] = nil
    scan(station, 1, "WAFER_LOST")
    local first = estimate(station, own)
    local by = first.mark and wrapped(math.rad(own.angle or 0) - first.direction - before) or 0
    if own.correct ~= false then
      check_correction(rotated(first, before + by))
    end
    turn_to(station, before + by + way_of(station), "WAFER_LOST")
    scan(station, -1, "WAFER_LOST")
    local second, now = estimate(station, own), turn_of(station)
    compare(first, second, station)
    if own.correct ~= false then
      check_correction(rotated(second, now))
    end
    found[station.name] = { x = second.x, y = second.y, direction = second.direction, sd = second.sd_direction,
                            corrects = own.correct ~= false }
    local answer = describe(first, second, before, now)
    answer.seconds = (native.utime() - begin) / 1e6
    return answer
  end

  -- align("P", { angle = 90 }): see lua/README.md.
  function align.align(station, options)
    local angle = type(options) == "table" and options.angle or ""
    local rest = lookup.fields_text(options, { "mode", "mark", "glass", "correct" })
    return arm.move(lookup.command("ALIGN", station, angle, rest), align_wafer, station, options)
  end

  ---------------------------------------------------------------------------------------- what a GET makes good

  -- Whole tenths of a micrometre: a command's text has them all.
  local function rounded(length)
    return math.floor(length * 1e4 + 0.5) / 1e4
  end

  -- How far a GET at the station goes beside what was taught: { dx, dy } in the slot's frame as the chuck stands
  -- now; nil if nothing was found there, or if the command's options say that it goes its own way.
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
    local dx, dy = rotated(at, turn_of(station))
    return { dx = rounded(dx), dy = rounded(dy) }
  end

  -- In which direction of its frame a gripper that takes the wafer of this target has its notch, and how sure that
  -- is; nothing if no notch was found there.
  function align.notch(target)
    local at = found[target.station]
    if at and at.direction then
      local turn = turn_of(native.layout.stations[target.station]) - math.rad(target.turn)
      return wrapped(at.direction + turn), math.sqrt(at.sd * at.sd + AS_TAUGHT * AS_TAUGHT)
    end
  end

  -- The wafer is taken from the station, another one comes, or its chuck lets it go.
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

  -- A function that makes known again what is known now.
  function align.keep()
    local kept = {}
    for name, at in pairs(found) do
      kept[name] = at
    end
    return function()
      found = {}
      for name, at in pairs(kept) do
        found[name] = at
      end
    end
  end

  return align
end
