-- The operator's words for single moves, and for STOP and what follows it. Those that carry wafers are in
-- lua/mcs/transfer.lua.

-- Local copies: a script may set globals of these names.
local ipairs, math, pairs, type = ipairs, math, pairs, type

return function(native, patterns, lookup, arm, ways, player, tasks, alarms, align, mechanisms, flippers, stations)
  local commands = {}

  -- Plays a segment. A wafer lost meanwhile is an error, except on the way out of trouble.
  local function play(segment)
    player.play(patterns.single, { segment = segment, watched = true, gripper = arm.leader() })
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
      player.play(patterns.recover, target)
    end
    arm.set_free()
  end

  function commands.recover()
    arm.move(arm.needs_stand(), "RECOVER", recover)
  end

  local function home()
    recover()
    local axes, robot = native.axes(), native.layout.robots[tasks.current().robot]
    local retracts = robot.retracts and not ways.goes_home_by_points()
    for _, axis in ipairs(retracts and robot.arms or {}) do
      axes[axis] = robot.home[axis - robot.first + 1]
    end
    if retracts then
      player.play(patterns.single, { segment = { axes = axes } })
    end
    for axis, position in ipairs(robot.home) do
      axes[robot.first + axis - 1] = position
    end
    player.play(patterns.single, { segment = { axes = axes, homeward = true } })
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
    local is_name = mechanism == nil or type(mechanism) == "string"
    local found, names = native.stop_in(number, not is_name and "" or mechanism)
    if not found then
      local text = "mechanism: %s (expected one of: %s; a station's name is that of its chuck)"
      native.fail("BAD_ARGUMENT", text:format(lookup.quote(mechanism), names))
    end
  end

  -- Continues a GET, PUT or SWAP that its `stop` holds in a phase; returns the PUT's result.
  function commands.continue()
    return player.continue()
  end

  -- Gives up the command that is held in a phase, like a STOP from outside; without one it does nothing.
  function commands.stop()
    arm.stop()
  end

  return commands
end
