-- CALIBRATE finds the errors of an edge sensor with a wafer of known diameter. The chuck turns the wafer both ways in
-- two places, and the robot carries it from the first to the second, a known distance. From then on motion control uses
-- the found errors. The wafer stays in the second place, and the next GET goes there.

-- Local copies: a script may set globals of these names.
local ipairs, math, pairs, type = ipairs, math, pairs, type

return function(native, patterns, lookup, arm, player, targets, align, carry)
  -- The wafer's way by default, mm, and its deviation when a robot carries it, mm.
  local WAY, SD = 14, 0.001

  local fields = lookup.calibrate_fields

  local function read_options(options)
    if options ~= nil and type(options) ~= "table" then
      native.fail("BAD_ARGUMENT", ("options: %s (expected a table)"):format(lookup.quote(options)))
    end
    local own = {}
    for name, value in pairs(options or {}) do
      local is_robot = name == "robot" and lookup.has_several() -- which arm.needs has read
      if not fields[name] and not is_robot then
        lookup.refuse_field(name, value, lookup.names(fields))
      end
      own[name] = not is_robot and lookup.number(name, value, fields[name]) or nil
    end
    return own
  end

  -- The wafer's way: half of it to each side, within the largest correction of commands.
  local function way_of(station, own)
    local most = 2 * native.layout.corrections.dx
    local way = own.way or math.min(WAY, most, station.sensor.length / 2)
    if way < fields.way[1] or way > most then
      local text = "the wafer would have to go %.10g mm to either side (expected from %.10g up to corrections.x of the layout, %.10g mm)"
      native.fail("CORRECTION_TOO_LARGE", text:format(way / 2, fields.way[1] / 2, most / 2))
    end
    return way
  end

  -- Plans GET and PUT to either side before anything moves.
  local function check_ways(station, way, robot)
    for _, side in ipairs { -way / 2, way / 2 } do
      local there, back = { dx = side, robot = robot }, { dx = side, centre = false, robot = robot }
      player.rehearse(patterns.get, targets.at("get", station.name, 1, there, nil, ""), true)
      player.rehearse(patterns.put, targets.at("put", station.name, 1, back, nil, ""), true)
    end
  end

  local function check_gripper(gripper)
    if native.sensor(gripper) then
      native.fail("WAFER_ON_GRIPPER", "CALIBRATE carries the wafer on the chuck")
    end
  end

  -- Carries the wafer from one place beside the middle to another, along the slot's x. A GET takes it over from the
  -- chuck in the slot's plane. If it is let go there, it keeps its height, however often it is carried.
  local function shift(station, dx, dy, to, robot)
    carry("get", station.name, 1, { dx = dx, dy = dy, correct = false, robot = robot })
    carry("put", station.name, 1, { dx = to, release = 0, centre = false, robot = robot })
  end

  -- Scans both ways round; the chuck ends where it began.
  local function look(station, scans, way)
    local turn = align.turn_of(station)
    for _, direction in ipairs { 1, -1 } do
      align.scan(station, direction, "WAFER_LOST", station.sensor.run_up)
      scans[#scans + 1] = { turn = native.edge_turn(), way_x = way * math.cos(turn), way_y = -way * math.sin(turn) }
    end
    align.turn_to(station, turn, "WAFER_LOST")
  end

  local function number(value)
    return ("%.6g"):format(value + 0.0)
  end

  local function text_of(found)
    local text = "believed = { offset = %s, zero = %s, gain = %s, latency = %s }"
    return text:format(number(found.offset), number(found.zero), number(found.gain), number(found.latency))
  end

  local function solve(station, scans, own)
    local radius, sd = (own.diameter or 2 * station.radius) / 2, own.sd or SD
    local found, name, bad = native.calibrate(station.chuck, scans, radius, sd)
    if not found then
      local text = name == "CENTRE_NOT_SURE" and "the scans contradict each other: is the wafer %.10g mm large, and did it keep its place on the blade?"
        or "the scans of a wafer that is %.10g mm large do not tell the sensor's errors"
      native.fail(name, text:format(2 * radius) .. (bad and (" (scan %d of %d)"):format(bad, #scans) or ""))
    end
    return found
  end

  local function calibrate(name, options)
    local own = read_options(options)
    local station = align.with_sensor(align.prealigner(name))
    local way = way_of(station, own)
    -- With several robots, one robot carries the wafer there and back.
    local index = lookup.robot_for(station.name, options)
    local robot = lookup.has_several() and native.layout.robots[index].name or nil
    arm.check_free()
    check_gripper(station.by[index])
    align.check_wafer(station)
    check_ways(station, way, robot)
    local begin, scans = native.utime(), {}
    local dx, dy = align.find(station)
    shift(station, dx, dy, -way / 2, robot)
    look(station, scans, 0)
    shift(station, -way / 2, 0, way / 2, robot)
    look(station, scans, way)
    local found = solve(station, scans, own)
    align.believe(station, found, found.x + scans[#scans].way_x, found.y + scans[#scans].way_y)
    found.x, found.y = nil, nil
    found.text, found.seconds = text_of(found), (native.utime() - begin) / 1e6
    return found
  end

  -- calibrate("P", { way = 14 }): see lua/README.md.
  return function(station, options)
    local rest = lookup.fields_text(options, { "way", "sd", "diameter" })
    local needs = arm.needs(true, station, options)
    needs.scan = true
    return arm.move(needs, lookup.command("CALIBRATE", station, rest), calibrate, station, options)
  end
end
