-- The operator's words that move something: those of lua/mcs/transfer.lua, and the single moves here.

-- Local copies: a script may set globals of these names.
local error, ipairs, math, pairs, pcall, type = error, ipairs, math, pairs, pcall, type

return function(native, patterns, lookup, alarms)
  local stations = native.module("mcs/stations.lua")(native, lookup)
  local centring = native.module("mcs/centring.lua")(native, lookup, stations)
  local tasks = native.module("mcs/tasks.lua")(native, lookup)
  local arm = native.module("mcs/arm.lua")(native, lookup, centring, tasks, alarms)
  local mechanisms = native.module("mcs/mechanisms.lua")(native, patterns, lookup, arm)
  local align = native.module("mcs/align.lua")(native, patterns, lookup, arm, mechanisms)
  local targets = native.module("mcs/targets.lua")(native, lookup, align, mechanisms, stations)

  function lookup.bound()
    return tasks.current().bound or native.asked_robot()
  end

  function lookup.bound_station()
    return tasks.current().station
  end

  lookup.phase, lookup.last_robot = arm.phase, arm.last_robot

  local slot_map = native.module("mcs/slot_map.lua")(native)
  local commands = native.module("mcs/transfer.lua")(native, patterns, lookup, arm, targets, align, centring,
    alarms, slot_map)

  ----------------------------------------------------------------------------------------------- single moves

  -- Plays a segment. A wafer lost meanwhile is an error, except on the way out of trouble.
  local function play(segment)
    arm.play(patterns.single, { segment = segment, watched = true, gripper = arm.leader() })
  end

  function alarms.robot()
    return tasks.current().robot
  end

  function alarms.bearer()
    return alarms.robot() or tasks.current()
  end

  function alarms.play(segment)
    arm.play(patterns.single, { segment = segment })
  end

  local function rotate(station_name, degrees)
    local station = align.prealigner(station_name)
    local axis = native.layout.grippers[station.chuck].axis
    local axes = native.axes()
    mechanisms.check_pins(station)
    axes[axis] = axes[axis] + math.rad(lookup.number("degrees", degrees))
    play { axes = axes }
  end

  function commands.rotate(station, degrees)
    arm.move(arm.needs(false, station), lookup.command("ROTATE", station, degrees), rotate, station, degrees)
  end

  commands.edge_scan, commands.align, commands.lift = align.edge_scan, align.align, mechanisms.lift

  local doors = native.module("mcs/doors.lua")(native, patterns, lookup, arm, tasks, alarms)
  commands.open, commands.close = doors.open, doors.close

  local flippers = native.module("mcs/flippers.lua")(native, patterns, lookup, arm, mechanisms, alarms)

  commands.flip_room = native.module("mcs/flip_room.lua")(native, patterns, lookup, arm, {
    before = commands.before, try = commands.try })
  commands.before, commands.try = nil, nil
  commands.centring = centring.last
  commands.calibrate = native.module("mcs/calibration.lua")(native, patterns, lookup, arm, targets, align,
    commands.carry)
  commands.carry = nil
  commands.teach = native.module("mcs/teaching.lua")(native, patterns, lookup, arm, targets, stations, slot_map)

  -- station("A"): the axes' places in its slot 1, degrees and mm.
  function commands.station(name, options)
    return stations.read(name, options)
  end

  -- set_station("A", { theta = , r = , z = , yaw = }): the station is where the gripper would be
  -- with these axes.
  function commands.set_station(name, axes)
    local text = lookup.command("SET_STATION", name, lookup.fields_text(axes, lookup.standing))
    local options = type(axes) == "table" and axes or {}
    arm.run(nil, arm.with_robot(text, arm.needs(true, name, options)), stations.set, name, axes)
  end

  local function valve(gripper, level)
    if level ~= 0 and level ~= 1 then
      native.fail("BAD_VALVE", ("level: %s (expected 0, open, or 1, closed)"):format(lookup.quote(level)))
    end
    local index = lookup.gripper(gripper)
    if native.layout.grippers[index].grip == "passive" then
      local text = "gripper: %s (expected one with a valve: passive pads have none)"
      native.fail("BAD_ARGUMENT", text:format(lookup.quote(gripper)))
    end
    align.forget_chuck(index)
    play { valves = { [index] = math.tointeger(level) } }
  end

  -- Needs the gripper's carrier, if there is a gripper of that name.
  local function needs_of_gripper(name)
    for index, gripper in ipairs(native.layout.grippers) do
      if gripper.name == name and gripper.on_robot then
        return arm.needs(true, nil, { gripper = name })
      end
      for station_name, station in pairs(native.layout.stations) do
        if gripper.name == name and (station.chuck == index or station.pins == index) then
          return arm.needs(false, station_name)
        end
      end
    end
  end

  function commands.valve(gripper, level)
    arm.move(needs_of_gripper(gripper), lookup.command("VALVE", gripper, level), valve, gripper, level)
  end

  -- The values of these fields by name, each checked.
  local function read_fields(what, description, known)
    local values, is_known = {}, {}
    for _, name in ipairs(known) do
      is_known[name] = true
    end
    for name, value in pairs(lookup.table(what, description)) do
      if not is_known[name] then
        lookup.refuse_field(name, value, known)
      end
      values[name] = lookup.number(name, value)
    end
    return values
  end

  local function move(positions)
    local known, own = {}, native.layout.robots[tasks.current().robot].axes
    for place, axis in ipairs(own) do
      known[place] = axis.name
    end
    local axes, to = native.axes(), read_fields("move", positions, known)
    for _, axis in ipairs(own) do
      local value = to[axis.name]
      axes[axis.index] = value and (axis.turns and math.rad(value) or value) or axes[axis.index]
    end
    arm.check_homed()
    play { axes = axes }
  end

  -- move { theta = , r = , z = , yaw = }, or other axes that the robot has: degrees and mm; axes that are not
  -- named stay.
  function commands.move(positions)
    arm.move(arm.needs(true), lookup.command("MOVE", lookup.fields_text(positions, lookup.axes)), move, positions)
  end

  -- Refuses to turn passive pads with a wafer over: they hold nothing then.
  local function check_drops_nothing()
    for _, index in ipairs(lookup.on_robot()) do
      local gripper = native.layout.grippers[index]
      if gripper.grip == "passive" and native.sensor(index) then
        local text = "%s holds %s by its weight alone, and would drop it"
        native.fail("SLIP_AHEAD", text:format(gripper.name, native.held(index) or "a wafer"))
      end
    end
  end

  -- The time that a FLIP waits for a blade that should have arrived, s.
  local BLADE_TIMEOUT = 1

  local function flip(name)
    local gripper = native.layout.grippers[lookup.gripper(name) and lookup.effector(name)]
    local axis, axes = lookup.axis("flip", gripper.robot), native.axes()
    if not axis then
      native.fail("BAD_ARGUMENT", ('gripper: "%s" (expected one of a robot with `flip`)'):format(gripper.name))
    end
    arm.check_outside()
    check_drops_nothing()
    axes[axis.index] = math.abs(axes[axis.index]) > math.pi / 2 and 0 or math.pi
    alarms.break_flip(gripper.name)
    play { axes = axes }
    flippers.await(lookup.gripper(gripper.name), gripper.name, BLADE_TIMEOUT)
  end

  -- Turns the blade over about its x, by half a turn, or back; or the wafer in a flipper's clamp.
  function commands.flip(gripper)
    local station = flippers.find(gripper)
    if station then
      return flippers.flip(station)
    end
    arm.move(arm.needs(true, nil, { gripper = gripper }), lookup.command("FLIP", gripper), flip, gripper)
  end

  local function line(by)
    local parts = read_fields("line", by, lookup.line_fields)
    arm.check_homed()
    play { line = { parts.dx or 0, parts.dy or 0, parts.dz or 0 }, speed = parts.speed or 0 }
  end

  -- line { dx = , dy = , dz = , speed = }: moves the end-effector straight by these mm in base, with constant
  -- heading; without a speed as fast as the axes allow.
  function commands.line(by)
    arm.move(arm.needs(true), lookup.command("LINE", lookup.fields_text(by, lookup.line_fields)), line, by)
  end

  local function wait(seconds)
    play { dwell = lookup.number("seconds", seconds) }
  end

  function commands.wait(seconds)
    arm.run(arm.needs(false), lookup.command("WAIT", seconds), wait, seconds)
  end

  -------------------------------------------------------------------------------------- STOP and what follows

  -- Moves straight out of the station in which the arm stands, if it does.
  local function recover()
    local target = arm.state().inside
    if target then
      target.stands = native.gripper_pose(target.gripper).r
      target.loaded = native.sensor(target.gripper)
      target.watched = false
      arm.play(patterns.recover, target)
    end
    arm.set_free()
  end

  function commands.recover()
    arm.move(arm.needs_stand(), "RECOVER", recover)
  end

  local function home()
    recover()
    local axes, robot = native.axes(), native.layout.robots[tasks.current().robot]
    local retracts = robot.retracts and not arm.goes_home_by_points()
    for _, axis in ipairs(retracts and robot.arms or {}) do
      axes[axis] = robot.home[axis - robot.first + 1]
    end
    if retracts then
      arm.play(patterns.single, { segment = { axes = axes } })
    end
    for axis, position in ipairs(robot.home) do
      axes[robot.first + axis - 1] = position
    end
    arm.play(patterns.single, { segment = { axes = axes, homeward = true } })
    arm.state().homed = true
  end

  function commands.home()
    arm.move(arm.needs_stand(), "HOME", home)
  end

  -- A STOP comes after this many simulated seconds: the running commands end there with STOPPED, or only the
  -- command that has the mechanism of that name.
  function commands.stop_in(seconds, mechanism)
    local number = lookup.number("seconds", seconds)
    if mechanism ~= nil then
      tasks.open()
    end
    if mechanism ~= nil and type(mechanism) ~= "string" or not native.stop_in(number, mechanism) then
      local text = "mechanism: %s (expected robot, or a station with a chuck)"
      native.fail("BAD_ARGUMENT", text:format(lookup.quote(mechanism)))
    end
  end

  -- Continues a GET, PUT or SWAP that its `stop` holds in a phase; returns the PUT's result.
  function commands.continue()
    return arm.continue()
  end

  -- Gives up the command that is held in a phase, like a STOP from outside; without one it does nothing.
  function commands.stop()
    arm.stop()
  end

  -- Keeps motion control's knowledge: returns a function that puts it back, and one that tells whether
  -- the arm is unchanged.
  function commands.keep()
    local put_slots_back, put_found_back, put_broken_back = slot_map.keep(), align.keep(), alarms.keep()
    local put_arm_back, is_arm_as_was = arm.keep()
    local put_stations_back, are_stations_as_were = stations.keep()
    return function()
      put_slots_back()
      put_found_back()
      put_broken_back()
      put_arm_back()
      put_stations_back()
    end, function()
      return is_arm_as_was() and are_stations_as_were()
    end
  end

  -- Runs a command that moves nothing.
  function commands.run(text, action, ...)
    return arm.run(nil, text, action, ...)
  end

  -- Calls a word for one of several robots: bound(index, word, ...).
  function commands.bind(index, word, ...)
    local task = tasks.current()
    local function restore(before, ok, ...)
      task.bound = before
      if not ok then
        error((...), 0)
      end
      return ...
    end
    local before = task.bound
    task.bound = index
    return restore(before, pcall(word, ...))
  end

  for name, word in pairs(tasks.words) do
    commands[name] = word
  end
  commands.finish, commands.serve, commands.is_any_alive = tasks.finish, tasks.serve, tasks.is_any_alive
  return commands
end
