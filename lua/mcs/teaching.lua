-- Teaching: the robot finds a station's true place with its own motions. With a beam at the station's door: the
-- blade comes up below the wafer in slot 1 until the vacuum sensor feels it; this gives z. It carries the wafer
-- through the beam on both sides, with the station's heading and turned either way; this gives x and y, and the
-- beam's place. It turns the wafer's notch through the beam; this gives yaw. Last the wafer is put back. By
-- touch: touching.lua.

-- Local copies: a script may set globals of these names.
local error, ipairs, math, pairs, pcall, type = error, ipairs, math, pairs, pcall, type

return function(native, patterns, lookup, arm, player, targets, stations, slot_map, ports)
  -- The search for the wafer: the distance from its expected height, mm, and the step.
  local SEARCH, STEP = 0.35, 0.01
  -- The motion through the beam: its speed, mm/s, and the distance before and after a rim, mm.
  local SPEED, ROOM = 100, 8
  local TURNS = { 0, math.rad(30), math.rad(-30) }
  -- The notch: the beam's distance inside the rim, mm, and the wafer's turn to either side.
  local INSIDE, SWEEP = 0.5, math.rad(2.5)
  -- The least and most angle of a flank from the notch's middle, seen from the wafer's middle:
  -- outside of these it is not a notch.
  local LEAST_FLANK, MOST_FLANK = math.rad(0.05), math.rad(0.6)

  local function play(segment)
    player.play(patterns.single, { segment = segment, watched = false, gripper = arm.leader() })
  end

  local function along(place, way, height)
    return { way * place.dir_x, way * place.dir_y, height or 0 }
  end

  -- `stays`: it turns at its place, whatever `robot.transit` says, because retracting would lead through the
  -- beam.
  local function go(target, x, y, z, heading, stays)
    play { to = { x = x, y = y, z = z, heading = heading, gripper = target.gripper }, stays = stays }
  end

  local function leave(target)
    play { line = along(target.place, -target.retract), leaves = true, target = target, where = "on the way out of" }
  end

  -- Moves out of the station after a failure: nothing was learnt.
  local function withdraw(target, bottom, name, why)
    local place, gripper = target.place, target.gripper
    play { valves = { [gripper] = 1 } }
    play { line = { 0, 0, place.z + bottom - native.gripper_pose(gripper).r[3] } }
    leave(target)
    native.fail(name, why)
  end

  local function height_of(target)
    return native.gripper_pose(target.gripper).r[3] - target.place.z
  end

  -- Moves up in steps from this height, with the valve open, until the sensor is on: at most to `top`. Returns
  -- whether it is on.
  local function rise(target, top)
    local on = native.sensor(target.gripper)
    for _ = 1, on and 0 or math.ceil((top - height_of(target)) / STEP - 1e-6) do
      play { line = { 0, 0, STEP } }
      play { dwell = target.timeout }
      on = native.sensor(target.gripper)
      if on then
        break
      end
    end
    return on
  end

  -- The blade felt a wafer if three things hold: the sensor goes off with the valve, is off at the height where
  -- the search began, and comes on again at the found height. The wafer stays at its place: a blade that draws it
  -- onto its pads first lifts by that distance.
  local function is_wafer(target, begin, felt)
    local gripper, projz = target.gripper, native.layout.tolerance.projz
    local drawn = native.layout.seat and projz - STEP / 2 or 0
    play { line = { 0, 0, drawn } }
    play { valves = { [gripper] = 1 } }
    play { dwell = target.timeout }
    if native.sensor(gripper) then
      return false
    end
    play { line = { 0, 0, begin - height_of(target) }, speed = target.pickup_speed }
    play { valves = { [gripper] = 0 } }
    play { dwell = target.timeout }
    if native.sensor(gripper) then
      return false
    end
    play { line = { 0, 0, felt - 3.5 * STEP - begin }, speed = target.pickup_speed }
    play { dwell = target.timeout }
    return not native.sensor(gripper) and rise(target, felt + 1.5 * STEP)
      and math.abs(height_of(target) - felt) < 1.5 * STEP
  end

  -- Moves into the station below the wafer, and up to it. Returns the height of the wafer's back face, and the
  -- blade's.
  local function feel(target)
    local place, projz, gripper = target.place, native.layout.tolerance.projz, target.gripper
    local bottom = target.offset - target.stroke
    local begin = math.max(bottom, -projz - SEARCH)
    play { to = { x = place.x - target.retract * place.dir_x, y = place.y - target.retract * place.dir_y,
                  z = place.z + bottom, heading = place.heading, gripper = gripper }, target = target, where = "in front of" }
    play { line = along(place, target.retract), enters = target, target = target, where = "on the way into" }
    play { line = { 0, 0, begin - bottom }, speed = target.pickup_speed }
    play { valves = { [gripper] = 0 } }
    local where = ("slot %d of %s"):format(target.slot, target.station)
    if native.sensor(gripper) then
      withdraw(target, bottom, "VACUUM_BEFORE_PICK", ("no wafer was felt within %.10g mm of %s: the sensor was on below it"):format(SEARCH, where))
    elseif not rise(target, SEARCH - projz) then
      withdraw(target, bottom, "WAFER_MISSING", ("no wafer was felt within %.10g mm of %s"):format(SEARCH, where))
    end
    local felt = height_of(target)
    if not is_wafer(target, begin, felt) then
      withdraw(target, bottom, "VACUUM_BEFORE_PICK", ("what was felt %.3f mm above %s is no wafer: the sensor of %s did not go off below it and come on there again"):format(
        felt + projz - STEP / 2, where, native.layout.grippers[gripper].name))
    end
    local height = place.z + math.max(felt, height_of(target))
    return height + projz - STEP / 2, height - STEP / 2
  end

  local function carry_out(target)
    local place = target.place
    play { line = { 0, 0, place.z + target.offset - native.gripper_pose(target.gripper).r[3] },
           speed = target.pickup_speed }
    leave(target)
  end

  -- The beams' crossings while `action` plays.
  local function watch(station, target, action)
    native.arm_beams(station.index, target.gripper, stations.shift(station, target.robot))
    play { dwell = 2 * native.layout.slice }
    action()
    play { dwell = 0.01 }
    if not native.sensor(target.gripper) then
      native.fail("WAFER_LOST_ON_WAY", "the vacuum sensor went off while the wafer passed the beam")
    end
    local found = native.centre({})
    native.disarm_beams()
    play { dwell = native.layout.slice }
    return found
  end

  -- Moves in and out again over one edge of the beam, beside the wafer's middle.
  local function cross(station, target, beam, turn, side)
    local place, radius = target.place, station.radius
    local aside = side * radius * 2 / 3
    local ahead = math.sqrt(radius * radius - aside * aside) + ROOM
    go(target, beam.x - aside * place.dir_y - ahead * place.dir_x, beam.y + aside * place.dir_x
      - ahead * place.dir_y, place.z + target.offset, place.heading + turn)
    local found, count = watch(station, target, function()
      play { line = along(place, 2 * ROOM), speed = SPEED }
      play { line = along(place, -2 * ROOM), speed = SPEED }
    end), 0
    for _, crossing in ipairs(found.crossings) do
      count = count + (crossing.beam == beam.number and 1 or 0)
    end
    if count < 2 then
      native.fail("TOO_FEW_SAMPLES", ("%d crossings of the wafer's rim (expected 2, there and back)"):format(count))
    end
    native.add_teaching(place.x, place.y, target.turned and place.heading or nil)
  end

  local function rotate(angle, x, y)
    local c, s = math.cos(angle), math.sin(angle)
    return c * x - s * y, s * x + c * y
  end

  -- Turns the notch through the beam and back. Returns the error of the station's yaw.
  local function find_yaw(station, target, beam, solved)
    local place = target.place
    local x, y = rotate(-place.heading, solved.x, solved.y)
    -- The notch in the frame of a blade that took the wafer on its own way in.
    local notch = target.turned and station.notch - target.turned or station.notch
    local heading, radius = place.heading - notch, station.radius - INSIDE
    local to_x, to_y = beam.x + solved.beam_x - radius * place.dir_x, beam.y + solved.beam_y - radius * place.dir_y
    local function at(turn)
      local ox, oy = rotate(heading + turn, x, y)
      go(target, to_x - ox, to_y - oy, place.z + target.offset, heading + turn, true)
    end
    at(-SWEEP)
    local found = watch(station, target, function()
      at(SWEEP)
      at(-SWEEP)
    end)
    local angles, sum = {}, 0
    for _, crossing in ipairs(found.crossings) do
      if crossing.beam == beam.number then
        local bx, by = rotate(-heading, solved.beam_x, solved.beam_y)
        local angle = math.atan(crossing.y + by - y, crossing.x + bx - x) - notch
        angles[#angles + 1] = (angle + math.pi) % (2 * math.pi) - math.pi
        sum = sum + angles[#angles]
      end
    end
    if #angles ~= 4 then
      local from_tip = math.abs(math.deg((notch + math.pi) % (2 * math.pi) - math.pi))
      local why = target.turned and ("; on this blade it is %.4g degrees from the tip: where the neck covers it, yaw = false goes without"):format(
        from_tip) or ""
      native.fail("NO_NOTCH", ("%d crossings of the wafer's notch (expected 4%s)"):format(#angles, why))
    end
    for _, angle in ipairs(angles) do
      local flank = math.abs(angle - sum / 4)
      if flank < LEAST_FLANK or flank > MOST_FLANK then
        native.fail("NO_NOTCH", ("what crossed the beam is %.3f degrees from its middle (expected %.4g to %.4g of a notch)"):format(
          math.deg(flank), math.deg(LEAST_FLANK), math.deg(MOST_FLANK)))
      end
    end
    return sum / 4
  end

  local function check_options(options)
    if options ~= nil and type(options) ~= "table" then
      native.fail("BAD_ARGUMENT", ("options: %s (expected a table)"):format(lookup.quote(options)))
    end
    for field, value in pairs(options or {}) do
      if field == "keep" or field == "yaw" then
        lookup.value(field, value, lookup.correct)
      elseif field == "robot" then
        lookup.robot(value)
      elseif field ~= "by" or value ~= "beam" and value ~= "touch" then
        native.fail("BAD_ARGUMENT", ("%s: %s (expected by = \"beam\" or \"touch\", keep or yaw = true or false, robot = \"NAME\")"):format(
          lookup.quote(field), lookup.quote(value)))
      end
    end
  end

  local function has_beams(station)
    for _, count in ipairs(station.beams) do
      if count > 0 then
        return true
      end
    end
    return false
  end

  -- Selects beam or touch, and with several robots the robot: for touch it is the one with the probe.
  local function way_of(name, options)
    local station = type(name) == "string" and native.layout.stations[name]
    local own = type(options) == "table" and options or {}
    local is_clear, robot = pcall(lookup.robot_for, name, own)
    local sees = station and (is_clear and station.beams[robot] > 0 or not is_clear and has_beams(station))
    local by = own.by or station and not sees and station.block and "touch" or "beam"
    local toucher = by == "touch" and station and station.block and native.block(station.index).gripper
    return by, not is_clear and own.robot == nil and not lookup.bound() and toucher
      and native.layout.robots[native.layout.grippers[toucher].robot].name or own.robot, toucher
  end

  local function check_beam(station, robot)
    if station.beams[robot] > 0 then
      return
    elseif not lookup.has_several() then
      native.fail("BAD_ARGUMENT", ("station: %s (expected one with beams at its door)"):format(lookup.quote(station.name)))
    end
    local own = native.layout.robots[robot]
    native.fail("BAD_ARGUMENT", own.is_usual
      and ("station: %s (expected one with beams that %s passes on its way in)"):format(lookup.quote(station.name), own.name)
      or ('robot: %s (expected one of kind "TRZY" without rail, tilt and flip)'):format(own.name))
  end

  local function check_touch(station, robot, toucher)
    if not toucher then
      native.fail("BAD_ARGUMENT", ("station: %s (expected one with a block)"):format(lookup.quote(station.name)))
    end
    local gripper = native.layout.grippers[toucher]
    if gripper.robot ~= robot then
      native.fail("BAD_ARGUMENT", ("robot: %s (expected %s: the probe is on %s)"):format(
        native.layout.robots[robot].name, native.layout.robots[gripper.robot].name, gripper.name))
    end
  end

  local touching = native.module("mcs/touching.lua")(native, patterns, lookup, arm, player, targets)

  local function to_rpy(R)
    return math.deg(math.atan(R[3][2], R[3][3])), math.deg(math.asin(-R[3][1]) + 0.0), math.deg(math.atan(R[2][1], R[1][1]))
  end

  local function key_of(name)
    return name:match("^[%a_][%w_]*$") or ("[%q]"):format(name)
  end

  -- The entry for a layout: the station's place, and its yaw, which is the guess plus `yaw`. With several robots the place
  -- is this robot's taught place, and the yaw is for all. Without `yaw` the yaw is unchanged.
  local function result_of(station, robot, guess, at, yaw)
    local roll, pitch, heading = to_rpy(guess.R)
    local result = { at = at, rpy = { roll, pitch, heading + math.deg(yaw or 0) } }
    local place = ("at = { %.4f, %.4f, %.4f }"):format(at[1], at[2], at[3])
    local turn = yaw and ("rpy = { %.5g, %.5g, %.4f }"):format(roll, pitch, result.rpy[3])
    if not lookup.has_several() then
      result.text = ("%s = { %s }"):format(key_of(station.name), turn and place .. ", " .. turn or place)
      return result
    end
    local own, before = native.way_in(station.index, robot)
    if own and yaw then
      local own_roll, own_pitch, own_heading = to_rpy(own.R)
      local _, _, was = to_rpy(before.R)
      result.own_rpy = { own_roll, own_pitch, own_heading + result.rpy[3] - was }
      place = ("%s, rpy = { %.5g, %.5g, %.4f }"):format(place, own_roll, own_pitch, result.own_rpy[3])
    end
    result.robot = native.layout.robots[robot].name
    result.text = ("%s = { %sby = { %s = { %s } } }"):format(key_of(station.name), turn and turn .. ", " or "",
      key_of(result.robot), place)
    return result
  end

  local function by_touch(name, station, robot)
    ports.check(name)
    local guess, solved = touching(name, station, stations.shift(station, robot))
    local at = { guess.r[1] + solved.x, guess.r[2] + solved.y, guess.r[3] + solved.z }
    local result = result_of(station, robot, guess, at, solved.yaw)
    result.sd, result.sd_yaw = { solved.sd_x, solved.sd_y, solved.sd_z }, math.deg(solved.sd_yaw)
    return result, solved.yaw
  end

  local function by_beam(station, target, beam, guess, z)
    for _, turn in ipairs(TURNS) do
      cross(station, target, beam, turn, -1)
      cross(station, target, beam, turn, 1)
    end
    local solved = native.solve_teaching()
    if solved.error ~= 0 then
      native.fail("CENTRE_NOT_SURE", "the crossings contradict each other")
    end
    local at = { guess.r[1] + solved.x, guess.r[2] + solved.y, z }
    local yaw = target.finds_yaw and find_yaw(station, target, beam, solved) or nil
    local result = result_of(station, target.robot, guess, at, yaw)
    result.sd, result.beam = { solved.sd_x, solved.sd_y, STEP / math.sqrt(12) }, { solved.beam_x, solved.beam_y }
    local stands = { gripper = target.gripper, x = beam.x + solved.beam_x, y = beam.y + solved.beam_y }
    return { result, yaw, stands }
  end

  -- Puts the wafer back to its place: on a blade that draws wafers onto its pads it lies lower.
  local function put_back(name, target, z, felt)
    local height = (native.layout.seat and z or felt) - target.place.z
    local release = math.min(math.max(height, target.offset - target.stroke), target.offset)
    local options = { release = release, centre = false, robot = native.layout.robots[target.robot].name }
    target = targets.at("put", name, 1, options, nil, "")
    player.drive(player.rehearse(patterns.put, target, true))
  end

  -- The angle of a robot's own way in from the station's x, rad; false: it comes along x.
  local function turned_by(place, believed)
    local turned = place.heading - math.atan(believed.R[2][1], believed.R[1][1])
    turned = (turned + math.pi) % (2 * math.pi) - math.pi
    return math.abs(turned) > 1e-6 and turned
  end

  local function with_wafer(name, station, robot, finds_yaw)
    local target = targets.at("get", name, 1, { robot = native.layout.robots[robot].name })
    target.finds_yaw = finds_yaw
    if target.is_passive then
      local text = "gripper: %s (expected one with vacuum, whose sensor feels the wafer)"
      native.fail("BAD_ARGUMENT", text:format(lookup.quote(native.layout.grippers[target.gripper].name)))
    end
    arm.check_free()
    ports.check(name)
    if native.sensor(target.gripper) then
      native.fail("WAFER_ON_GRIPPER", "TEACH takes the wafer in slot 1")
    end
    slot_map.forget(target)
    local z, felt = feel(target)
    carry_out(target)
    local beam = native.beam(station.index, target.gripper, stations.shift(station, target.robot))
    local guess, believed = native.begin_teaching(station.index, stations.shift(station, robot), target.gripper)
    target.turned = turned_by(target.place, believed)
    local good, result = pcall(by_beam, station, target, beam, guess, z + (guess.r[3] - believed.r[3]))
    if native.sensor(target.gripper) then
      put_back(name, target, z, felt)
      slot_map.note_put(target)
    end
    if not good then
      error(result, 0)
    end
    return result[1], result[2], result[3]
  end

  local function teach(name, options, by, toucher)
    local station = lookup.station(name)
    check_options(options)
    local robot = lookup.robot_for(station.name, options)
    local finds_yaw = not options or options.yaw ~= false
    if by == "touch" then
      check_touch(station, robot, toucher)
      if not finds_yaw then
        native.fail("BAD_ARGUMENT", "yaw: false (expected true: touches always tell it)")
      end
    else
      check_beam(station, robot)
    end
    local before = native.slot(station.index, 1, 0, 0, 0, 0, robot, stations.shift(station, robot), true)
    local action = by == "touch" and by_touch or with_wafer
    local result, yaw, beam = action(name, station, robot, finds_yaw)
    if options and options.keep then
      local heading = lookup.has_several() and before.heading + (yaw or 0) or math.rad(result.rpy[3])
      stations.learn(station, robot, result.at, heading, beam)
    end
    return result
  end

  -- The options, with the chosen robot.
  local function with_robot(options, robot)
    local all = {}
    for field, value in pairs(type(options) == "table" and options or {}) do
      all[field] = value
    end
    all.robot = robot
    return type(options) == "table" and all or options == nil and robot and all or options
  end

  -- Finds the station's true place, by its beam and the wafer in its slot 1, or by its block: see
  -- lua/mcs/words.lua.
  return function(station, options)
    local by, robot, toucher = way_of(station, options)
    options = with_robot(options, robot)
    local needs = arm.needs(true, station, options)
    needs.latches = true
    return arm.move(needs, lookup.command("TEACH", station), teach, station, options, by, toucher)
  end
end
