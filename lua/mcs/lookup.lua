-- Converts an operator's names to the host's indices: stations, slots, grippers, wafers, numbers. Each
-- function refuses an unknown name with a numbered error that tells the name.

-- Local copies: a script may set globals of these names.
local ipairs, math, pairs, rawequal, table = ipairs, math, pairs, rawequal, table
local tonumber, tostring, type = tonumber, tostring, type

return function(native, errors)
  local lookup = { errors = errors }

  -- The station parameters that a command may set for itself, and other options: { least, most, unit } of a
  -- number; the `values` of another kind, or none for a gripper's name.
  lookup.parameters = native.ranges()
  lookup.parameters.check_map = { values = { true, false } }
  local share = { 1e-3, 1, "of the limits" }
  lookup.options = { gripper = {}, robot = {}, force = { values = { true, false } }, speed = share, acceleration = share }
  -- SWAP takes with the empty gripper and puts with the other one.
  lookup.swap_options = { robot = {}, force = lookup.options.force, speed = share, acceleration = share }

  -- The corrections of a GET, PUT or SWAP, and where it may stop: in order.
  lookup.correction_fields = { "dx", "dy", "dz", "turn" }
  lookup.phases = { "extended", "up" }

  -- Whether a GET corrects by ALIGN's result.
  lookup.correct = { values = { true, false } }

  -- The options of ALIGN.
  lookup.align_fields = {
    angle = { -360, 360, "degrees" }, mode = { values = { "robot", "stage", "pins" } },
    mark = { values = { "own", "none" } }, glass = { 0, 0.9, "" }, turns = { 1, 12, "" }, correct = lookup.correct,
  }

  -- The positions for LIFT.
  lookup.up_or_down = { values = { "up", "down" } }

  -- The options of CALIBRATE: the wafer's way, its deviation, and the wafer's size.
  lookup.calibrate_fields = { way = { 2, 20, "mm" }, sd = { 0, 1, "mm" }, diameter = { 20, 600, "mm" } }

  -- The fields of MOVE, of any robot, and of LINE in order, and their ranges.
  lookup.axes = { "theta", "r", "z", "yaw", "forearm", "rail", "tilt_x", "tilt_y", "flip", "r2", "yaw2" }
  -- The axes that tell where a station is; r and yaw are those of the gripper's own arm or wrist.
  lookup.standing = { "theta", "r", "z", "yaw", "forearm" }
  -- And those of a pose, and the parts of the limits.
  lookup.pose_fields, lookup.shares = { "x", "y" }, { "speed", "acceleration" }
  -- A robot's own controller, in order.
  lookup.controller_fields = { "power", "brakes", "estop", "servo", "mode", "exceeded", "at", "override" }
  lookup.controller_words = {
    power = { "on", "off" }, brakes = { "released", "set" }, estop = { "on", "off" }, servo = { "ok", "error" },
    mode = { "automatic", "manual", "remote" },
  }
  lookup.line_fields = { "dx", "dy", "dz", "x", "y", "z", "speed", "acceleration" }
  local way, turn = { -1e6, 1e6, "mm" }, { nil, nil, "degrees" }
  lookup.ranges = {
    theta = turn, r = { nil, nil, "mm" }, z = { nil, nil, "mm" }, yaw = turn, degrees = turn,
    forearm = turn, rail = { nil, nil, "mm" }, tilt_x = turn, tilt_y = turn, flip = turn, r2 = { nil, nil, "mm" }, yaw2 = turn,
    dx = way, dy = way, dz = way, x = way, y = way, acceleration = share, speed_share = share, speed = lookup.parameters.pickup_speed, seconds = { 0, 1e6, "s" },
  }

  -- The most names that an error lists.
  local MOST_NAMES = 16

  function lookup.quote(value)
    return type(value) == "string" and ('"%s"'):format(value) or tostring(value)
  end

  -- The keys of all these tables.
  function lookup.names(...)
    local all = {}
    for _, map in ipairs({ ... }) do
      for name in pairs(map) do
        all[#all + 1] = name
      end
    end
    return all
  end

  -- The nearest of the names, as the end of a sentence; nothing if none is near.
  function lookup.nearest(word, names)
    return type(word) == "string" and native.nearest(word, names) or ""
  end

  -- "A, B, P", for an error.
  function lookup.listed(names)
    local text = table.concat(names, ", ", 1, math.min(#names, MOST_NAMES))
    return #names > MOST_NAMES and text .. " and others" or text
  end

  local function refuse(error_name, name, names)
    local expected = #names > 0 and "expected " .. lookup.listed(names) or "there is none"
    native.fail(error_name, ("%s (%s%s)"):format(lookup.quote(name), expected, lookup.nearest(name, names)))
  end

  -- Refuses a field that a command does not have.
  function lookup.refuse_field(name, value, names)
    local expected = table.concat(names, ", ") .. lookup.nearest(name, names)
    local text = "%s: %s (there is no such field: expected %s)"
    native.fail("BAD_ARGUMENT", text:format(tostring(name), lookup.quote(value), expected))
  end

  function lookup.station(name)
    local stations = native.layout.stations
    if type(name) ~= "string" or not stations[name] then
      refuse("NO_SUCH_STATION", name, lookup.names(stations))
    end
    return stations[name]
  end

  function lookup.slot(station, slot)
    local whole = math.tointeger(slot)
    if type(slot) ~= "number" or not whole or whole < 1 or whole > station.slots then
      local last = station.slots > 1 and (" to %d"):format(station.slots) or ""
      native.fail("NO_SUCH_SLOT", ("%s (expected 1%s in %s)"):format(lookup.quote(slot), last, station.name))
    end
    return whole
  end

  -- By a robot's axes: each of them by its name.
  local axes_by_name = {}

  -- The axis of that name of a robot (by default the first), or nil.
  function lookup.axis(name, robot)
    local axes = native.layout.robots[robot or 1].axes
    local named = axes_by_name[axes]
    if not named then
      named = {}
      for _, axis in ipairs(axes) do
        named[axis.name] = named[axis.name] or axis
      end
      axes_by_name[axes] = named
    end
    return named[name]
  end

  -- The parts of the limits in a command's options; nil: all of them.
  function lookup.share(options)
    local speed, acceleration = options.speed or 1, options.acceleration or 1
    return (speed ~= 1 or acceleration ~= 1) and { speed, acceleration } or nil
  end

  -- Likewise, of a command that has no other options.
  function lookup.read_share(options)
    for name, value in pairs(options ~= nil and lookup.table("options", options) or {}) do
      if name ~= "speed" and name ~= "acceleration" then
        lookup.refuse_field(name, value, lookup.shares)
      end
      lookup.number(name, value, share)
    end
    return lookup.share(options or {})
  end

  -- The names of a robot's axes, in order.
  function lookup.own_axes(robot)
    local names = {}
    for place, axis in ipairs(native.layout.robots[robot].axes) do
      names[place] = axis.name
    end
    return names
  end

  -- The names of these entries, in order.
  function lookup.names_of(list)
    local names = {}
    for index, entry in ipairs(list) do
      names[index] = entry.name
    end
    return names
  end

  -- The index of the entry with that name, or nil.
  local function find(list, name)
    for index, entry in ipairs(list) do
      if entry.name == name then
        return index
      end
    end
  end

  function lookup.gripper(name)
    local all = native.layout.grippers
    return find(all, name) or refuse("NO_SUCH_GRIPPER", name, lookup.names_of(all))
  end

  function lookup.door(name)
    local index = find(native.layout.doors, name)
    if index then
      return index
    end
    local known = lookup.names_of(native.layout.doors)
    local expected = #known > 0 and "expected one of the doors: " .. lookup.listed(known)
        or "expected none: the layout has no `doors`"
    native.fail("BAD_ARGUMENT", ("door: %s (%s%s)"):format(lookup.quote(name), expected, lookup.nearest(name, known)))
  end

  ----------------------------------------------------------------------------------------------------- robots

  function lookup.has_several()
    return #native.layout.robots > 1
  end

  local function robot_names(robots)
    local names = {}
    for index, robot in ipairs(native.layout.robots) do
      names[#names + 1] = (not robots or robots[index]) and robot.name or nil
    end
    return lookup.listed(names)
  end

  -- A robot's index by its name.
  function lookup.robot(name)
    local index = find(native.layout.robots, name)
    if index then
      return index
    end
    for _, timed in ipairs(native.layout.timed_robots) do
      if timed == name then
        native.fail("NO_SUCH_ROBOT", ("%s is times alone: `flow` has it carry wafers (expected %s)"):format(lookup.quote(name),
          robot_names()))
      end
    end
    native.fail("NO_SUCH_ROBOT", ("%s (expected %s)"):format(lookup.quote(name), robot_names()))
  end

  -- "the robot", or the robot's name.
  function lookup.robot_text(index)
    return lookup.has_several() and "robot " .. native.layout.robots[index].name or "the robot"
  end

  -- The robot that a command's words are bound to, or nil: set by lua/mcs/parts.lua.
  function lookup.bound()
  end

  -- The only station of the controller that sent the line, or nil: set by lua/mcs/parts.lua.
  function lookup.bound_station()
  end

  -- lookup.phase(): the phase in which the current task's last command is held, or nil; lookup.last_robot(): that
  -- command's robot. Both are set by lua/mcs/parts.lua.

  local function check_serves(station, robot)
    if station and not station.by[robot] then
      local text, names = "robot: %s (expected one that serves %s: %s)", robot_names(station.by)
      names = names ~= "" and names or "none with axes does"
      native.fail("BAD_ARGUMENT", text:format(native.layout.robots[robot].name, station.name, names))
    end
  end

  -- The robot that a command itself gives: the gripper's, the one that it names, or the one that its word is bound
  -- to. They must not contradict each other.
  local function said_robot(options)
    local gripper = options.gripper ~= nil and native.layout.grippers[lookup.gripper(options.gripper)]
    local bound, named = lookup.bound(), options.robot ~= nil and lookup.robot(options.robot)
    local robot = named or bound
    if named and bound and named ~= bound then
      local text = "robot: %s (expected %s or none: the word is that robot's)"
      native.fail("BAD_ARGUMENT", text:format(lookup.quote(options.robot), native.layout.robots[bound].name))
    end
    if gripper and gripper.robot and robot and gripper.robot ~= robot then
      local text = "gripper: %s (expected one on %s)"
      native.fail("BAD_ARGUMENT", text:format(lookup.quote(options.gripper), native.layout.robots[robot].name))
    end
    return robot or gripper and gripper.robot
  end

  -- The robot that executes a command: the one that the command gives, else the only one, else the one that
  -- serves the station. Present positions do not count.
  function lookup.robot_for(station_name, options)
    local station = type(station_name) == "string" and native.layout.stations[station_name] or nil
    local robot = said_robot(type(options) == "table" and options or {})
    if robot then
      check_serves(station, robot)
      return robot
    elseif not lookup.has_several() then
      check_serves(station, 1)
      return 1
    elseif station and station.robot then
      return station.robot
    end
    if station_name ~= nil and not station then
      lookup.station(station_name)
    end
    local text = "%s (expected robot \"NAME\", robot = or gripper =: %s)"
    local what = station and ("%s is served by several"):format(station.name) or "the command names none"
    native.fail("AMBIGUOUS_ROBOT", text:format(what, robot_names(station and station.by)))
  end

  -- The grippers on the robot, or on one of several: their indices and their names.
  function lookup.on_robot(robot)
    local indices, names = {}, {}
    for index, gripper in ipairs(native.layout.grippers) do
      if gripper.on_robot and (not robot or gripper.robot == robot) then
        indices[#indices + 1], names[#names + 1] = index, gripper.name
      end
    end
    return indices, names
  end

  -- A gripper on the robot, or on one of several: the named one, the one with the index `otherwise`, or the first.
  function lookup.effector(name, otherwise, robot)
    local indices, names = lookup.on_robot(robot)
    if name == nil then
      return otherwise or indices[1]
    end
    local index = lookup.gripper(name)
    if not native.layout.grippers[index].on_robot then
      local text = "%s is on a chuck (expected one on the robot: %s)"
      native.fail("NO_SUCH_GRIPPER", text:format(lookup.quote(name), lookup.listed(names)))
    end
    return index
  end

  function lookup.wafer(name)
    local index = type(name) == "string" and native.wafer(name) or nil
    if not index then
      refuse("NO_SUCH_WAFER", name, native.wafer_names(1001))
    end
    return index
  end

  ----------------------------------------------------------------------------------------------------- frames

  -- Splits "B/10", where B is a station, into the station and the slot's text.
  local function split_slot(stations, name)
    local station, slot = name:match("^(.*)/(%d+)$")
    return stations[station], math.tointeger(tonumber(slot)) or slot
  end

  local function slot_frame(stations, name)
    local station, slot = split_slot(stations, name)
    local exists = station and math.type(slot) == "integer" and slot >= 1 and slot <= station.slots
    return exists and ("%s/%d"):format(station.name, slot) == name and native.slot_pose(station.index, slot)
  end

  local function station_frame(stations, name)
    return stations[name] and native.slot_pose(stations[name].index, 1)
  end

  local function gripper_frame(grippers, name)
    local index = find(grippers, name)
    return index and native.gripper_pose(index, "real")
  end

  local function wafer_frame(name)
    local wafer = native.wafer(name)
    return wafer and native.wafer_pose(wafer)
  end

  local function refuse_frame(what, stations, name)
    local station, slot = split_slot(stations, tostring(name))
    if station then
      lookup.slot(station, slot)
    end
    local expected = '"base" or the name of a wafer, a gripper, a station or a slot, such as "A/1"'
    local text, near = "%s: %s (expected %s%s)", lookup.nearest(name, lookup.frames())
    native.fail("BAD_ARGUMENT", text:format(what, lookup.quote(name), expected, near))
  end

  -- The pose of a frame by its name. With equal names a slot comes first, as in a report's measuring tool.
  function lookup.frame(what, name)
    local layout = native.layout
    local text = type(name) == "string" and name or ""
    return slot_frame(layout.stations, text) or station_frame(layout.stations, text)
      or gripper_frame(layout.grippers, text) or wafer_frame(text) or text == "base" and { r = { 0, 0, 0 } }
      or refuse_frame(what, layout.stations, name)
  end

  -- Every frame's name.
  function lookup.frames()
    local list = native.wafer_names()
    for _, gripper in ipairs(native.layout.grippers) do
      list[#list + 1] = gripper.name
    end
    for name, station in pairs(native.layout.stations) do
      list[#list + 1] = name
      for slot = 1, station.slots do
        list[#list + 1] = ("%s/%d"):format(name, slot)
      end
    end
    list[#list + 1] = "base"
    return list
  end

  local function fail_value(what, value, expected)
    native.fail("BAD_ARGUMENT", ("%s: %s (expected %s)"):format(what, lookup.quote(value), expected))
  end

  -- A finite number. `range`: { least, most, unit }, least and most may be nil; of lookup.ranges if left out.
  function lookup.number(what, value, range)
    range = range or lookup.ranges[what]
    local least, most = range[1] or -math.huge, range[2] or math.huge
    if type(value) ~= "number" or value - value ~= 0 or value < least or value > most then
      local expected = range[1] and ("a number from %g to %g %s"):format(least, most, range[3]):gsub(" $", "")
        or "a finite number of " .. range[3]
      fail_value(what, value, expected)
    end
    return value
  end

  local function one_of(values)
    local text = {}
    for place, value in ipairs(values) do
      text[place] = lookup.quote(value)
    end
    return table.concat(text, ", ", 1, #text - 1) .. " or " .. text[#text]
  end

  -- A value of lookup.parameters or lookup.options.
  function lookup.value(what, value, kind)
    if kind[2] then
      return lookup.number(what, value, kind)
    end
    for _, known in ipairs(kind.values or {}) do
      if rawequal(value, known) then
        return value
      end
    end
    if kind.values then
      fail_value(what, value, one_of(kind.values))
    end
    return value
  end

  function lookup.table(what, value)
    if type(value) ~= "table" then
      native.fail("BAD_ARGUMENT", ("%s: %s (expected a table)"):format(what, lookup.quote(value)))
    end
    return value
  end

  ------------------------------------------------------------------------------------------- a command's text

  function lookup.number_text(value)
    return math.type(value) == "float" and value == value and ("%.10g"):format(value) or tostring(value)
  end

  -- "dx=1 dz=2.5": the fields of this list that a command's table has.
  function lookup.fields_text(fields, order)
    local text = {}
    for _, name in ipairs(order) do
      if type(fields) == "table" and fields[name] ~= nil then
        text[#text + 1] = ("%s=%s"):format(name, lookup.number_text(fields[name]))
      end
    end
    return table.concat(text, " ")
  end

  -- The command's text for the record: its word and its arguments.
  function lookup.command(word, ...)
    local text = { word }
    for _, value in ipairs({ ... }) do
      text[#text + 1] = value ~= "" and lookup.number_text(value) or nil
    end
    return table.concat(text, " ")
  end

  return lookup
end
