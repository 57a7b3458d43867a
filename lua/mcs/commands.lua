-- The operator's words for single moves, and for STOP and what follows it. Those that carry wafers are in
-- lua/mcs/transfer.lua.

-- Local copies: a script may set globals of these names.
local ipairs, math, pairs, table, tostring, type = ipairs, math, pairs, table, tostring, type

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

  -- The values of these fields by name, each checked; `ranges`: of those that mean something else here.
  local function read_fields(what, description, known, ranges)
    local values, is_known = {}, {}
    for _, name in ipairs(known) do
      is_known[name] = true
    end
    for name, value in pairs(lookup.table(what, description)) do
      if not is_known[name] then
        lookup.refuse_field(name, value, known)
      end
      values[name] = lookup.number(name, value, ranges and ranges[name])
    end
    return values
  end

  local ELBOWS = { left = 1, right = 2 }

  -- The axes with the first gripper at this pose: x, y, z and the direction of its x axis, yaw; what is not named is
  -- as it is. `axes` are where they stand, with other ones that are named where they go.
  local function axes_at(to, axes, elbow)
    local gripper = lookup.on_robot()[1]
    local pose, robot = native.gripper_pose(gripper), tasks.current().robot
    local heading = to.yaw and math.rad(to.yaw) or math.atan(pose.R[2][1], pose.R[1][1])
    local point = { x = to.x or pose.r[1], y = to.y or pose.r[2], z = to.z or pose.r[3], heading = heading, gripper = gripper }
    local rail = lookup.axis("rail", robot)
    point.place = { rail = rail and axes[rail.index] or 0, elbow = elbow }
    return native.inverse { from = axes, to = point, where = ("to x=%.10g y=%.10g z=%.10g"):format(point.x, point.y, point.z) }
  end

  local function read_elbow(positions, robot)
    local word = positions.elbow
    local elbow = word == nil and 0 or ELBOWS[word]
    if not elbow or elbow > 0 and not lookup.axis("forearm", robot) then
      native.fail("BAD_ARGUMENT", ('elbow: %s (expected "left" or "right", of an arm that folds)'):format(lookup.quote(word)))
    end
    return elbow
  end

  -- A pose is meant where x, y or the elbow is named: then z and yaw are the pose's, too.
  local POSE = { x = true, y = true, z = true, yaw = true }

  local function move(positions)
    local known, robot = {}, tasks.current().robot
    local own, elbow, fields = native.layout.robots[robot].axes, nil, {}
    for name, value in pairs(lookup.table("move", positions)) do
      fields[name] = name ~= "elbow" and value or nil
    end
    elbow = read_elbow(positions, robot)
    for place, axis in ipairs(own) do
      known[place] = axis.name
    end
    for _, list in ipairs({ lookup.pose_fields, { lookup.axis("forearm", robot) and "elbow" or nil }, lookup.shares }) do
      table.move(list, 1, #list, #known + 1, known)
    end
    local axes, to = native.axes(), read_fields("move", fields, known, { speed = lookup.ranges.speed_share })
    local share, is_pose = lookup.share(to), to.x or to.y or elbow > 0
    for _, axis in ipairs(own) do
      local value = not (is_pose and POSE[axis.name]) and to[axis.name]
      axes[axis.index] = value and (axis.turns and math.rad(value) or value) or axes[axis.index]
    end
    arm.check_homed()
    play { axes = is_pose and axes_at(to, axes, elbow) or axes, share = share }
  end

  local MOVE_FIELDS = {}
  for _, list in ipairs({ lookup.axes, { "x", "y", "elbow" }, lookup.shares }) do
    table.move(list, 1, #list, #MOVE_FIELDS + 1, MOVE_FIELDS)
  end

  -- move { theta = , r = , z = , yaw = }, or other axes that the robot has: degrees and mm; axes that are not
  -- named stay. With x, y or elbow it goes to a pose. Shares are parts of the limits of all axes.
  function commands.move(positions)
    arm.move(arm.needs(true), lookup.command("MOVE", lookup.fields_text(positions, MOVE_FIELDS)), move, positions)
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

  local function flip(name, options)
    tasks.current().share = lookup.read_share(options)
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
  function commands.flip(gripper, options)
    local station = flippers.find(gripper)
    if station then
      lookup.read_share(options)
      return flippers.flip(station)
    end
    local text = lookup.command("FLIP", gripper, lookup.fields_text(options, lookup.shares))
    arm.move(arm.needs(true, nil, { gripper = gripper }), text, flip, gripper, options)
  end

  local function line(by)
    local parts = read_fields("line", by, lookup.line_fields)
    local share, at, way = lookup.share { acceleration = parts.acceleration }, native.gripper_pose(lookup.on_robot()[1]).r, {}
    for place, name in ipairs({ "x", "y", "z" }) do
      if parts[name] and parts["d" .. name] then
        native.fail("BAD_ARGUMENT", ("d%s: %.10g (expected none beside %s)"):format(name, parts["d" .. name], name))
      end
      way[place] = parts[name] and parts[name] - at[place] or parts["d" .. name] or 0
    end
    arm.check_homed()
    play { line = way, speed = parts.speed or 0, share = share }
  end

  -- line { dx = , dy = , dz = , speed = }: moves the end-effector straight by these mm in base, or to x, y, z, with
  -- constant heading; without a speed as fast as the axes allow.
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
  local function recover(options)
    local target = arm.state().inside
    tasks.current().share = lookup.read_share(options)
    if target then
      target.share = nil
      target.stands = native.gripper_pose(target.gripper).r
      target.loaded = native.sensor(target.gripper)
      target.watched = false
      player.play(patterns.recover, target)
    end
    arm.set_free()
  end

  function commands.recover(options)
    arm.move(arm.needs_stand(), lookup.command("RECOVER", lookup.fields_text(options, lookup.shares)), recover, options)
  end

  local function home(options)
    recover(options)
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
    native.mend_controller(tasks.current().robot or 1)
  end

  function commands.home(options)
    arm.move(arm.needs_stand(), lookup.command("HOME", lookup.fields_text(options, lookup.shares)), home, options)
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

  local function text_of_change(value)
    return type(value) == "number" and ("%.17g"):format(value) or tostring(value)
  end

  local function change_controller(changes, robot)
    local texts = {}
    for name, value in pairs(changes) do
      if type(name) ~= "string" or type(value) ~= "string" and type(value) ~= "number" then
        local text = "%s: %s (expected a field such as power, and a word or a number)"
        native.fail("BAD_ARGUMENT", text:format(tostring(name), lookup.quote(value)))
      end
      texts[name] = name ~= "robot" and text_of_change(value) or nil
    end
    native.change_controller(robot, texts)
  end

  -- controller { power = "off" }: the robot's own controller has this from now on. Returns what it has.
  function commands.controller(changes)
    local robot = lookup.robot_for(nil, changes ~= nil and lookup.table("controller", changes) or nil)
    if changes ~= nil then
      local text = lookup.command("CONTROLLER", lookup.fields_text(changes, lookup.controller_fields))
      arm.run(nil, arm.with_robot(text, { robot = robot }), change_controller, changes, robot)
    end
    return native.controller(robot)
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
