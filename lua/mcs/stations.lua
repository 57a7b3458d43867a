-- The believed places of stations: those of the layout, until a host sets one by the axes with which a gripper
-- stands in its slot 1.

-- Local copies: a script may set globals of these names.
local error, ipairs, math, next, pairs, pcall = error, ipairs, math, next, pairs, pcall

return function(native, lookup)
  local stations = {}

  -- By station and robot: its set offset from the layout's place, see native.shift. A returned table is never changed.
  local shifts = {}

  -- An axis' name in SET_STATION: the second arm's r2 and wrist's yaw2 are the gripper's r and yaw. Nil: an axis that the
  -- station's place decides.
  local function role_of(axis)
    local name = axis.name:gsub("2$", "")
    for _, known in ipairs(lookup.standing) do
      if name == known then
        return name
      end
    end
  end

  local function key(station, robot)
    return station.name .. "\0" .. robot
  end

  local function is_taught(station, robot)
    return station.taught or shifts[key(station, robot)] ~= nil
  end

  -- The station's set offset from the layout's place: see native.shift; nil: it was not set.
  function stations.shift(station, robot)
    return shifts[key(station, robot)]
  end

  -- native.slot for the station as it was set; `undrawn`: without a trial's drawn offset.
  function stations.place(station, slot, robot, by, undrawn)
    return native.slot(station.index, slot, by.dx or 0, by.dy or 0, by.dz or 0, by.turn or 0, robot,
      shifts[key(station, robot)], undrawn)
  end

  function stations.check_taught(station, robot)
    if not is_taught(station, robot) then
      native.fail("NOT_TAUGHT", ("%s: its layout says taught = false"):format(lookup.quote(station.name)))
    end
  end

  -- The station, the robot and the gripper of a command.
  local function find(name, options)
    options = options == nil and {} or lookup.table("options", options)
    local station = lookup.station(name)
    local robot = lookup.robot_for(station.name, options)
    return station, robot, lookup.effector(options.gripper, station.by[robot] or nil, robot)
  end

  -- All axes with the gripper in that slot, at a distance along the way in, planned from home.
  local function axes_at(station, slot, robot, gripper, along, up)
    local place = stations.place(station, slot, robot, {}, true)
    local from, own = native.axes(), native.layout.robots[robot]
    for axis, position in ipairs(own.home) do
      from[own.first + axis - 1] = position
    end
    return native.inverse { from = from, where = "to stand in", target = { station = station.name, slot = slot }, to = {
      x = place.x + along * place.dir_x, y = place.y + along * place.dir_y, z = place.z + up,
      heading = place.heading, gripper = gripper, place = place } }
  end

  -- The robot's axes that move this gripper and tell where a slot is.
  local function telling(station, robot, gripper)
    local axes, list = native.axes(), {}
    local before = native.shift(station.index, robot, gripper, axes)
    for _, axis in ipairs(native.layout.robots[robot].axes) do
      local at = axes[axis.index]
      axes[axis.index] = at + 0.1
      local after, moves = native.shift(station.index, robot, gripper, axes), false
      for part = 1, 4 do
        moves = moves or math.abs(after[part] - before[part]) > 1e-6
      end
      axes[axis.index] = at
      local name = role_of(axis)
      list[#list + 1] = moves and name and { name = name, index = axis.index, turns = axis.turns } or nil
    end
    return list
  end

  -- The believed places of the axes with the gripper in slot 1: degrees and mm by name.
  local function read(name, options)
    local station, robot, gripper = find(name, options)
    stations.check_taught(station, robot)
    local axes, found = axes_at(station, 1, robot, gripper, 0, 0), {}
    for _, axis in ipairs(telling(station, robot, gripper)) do
      local value = axes[axis.index]
      found[axis.name] = axis.turns and math.deg(value) or value
    end
    return found
  end

  -- Checks the reach in front of each slot and in it, at the heights of the stroke.
  local function check_reach(station, robot, gripper)
    for slot = 1, station.slots, station.upright and math.max(1, station.slots - 1) or 1 do
      for _, up in ipairs({ station.offset - station.stroke, station.offset }) do
        axes_at(station, slot, robot, gripper, -station.retract, up)
        axes_at(station, slot, robot, gripper, 0, up)
      end
    end
  end

  -- The axes as the host sets them: the named ones replace the believed ones.
  local function set_axes(fields, station, robot, gripper)
    local known, values, names = telling(station, robot, gripper), {}, { "gripper", "robot" }
    local axes = is_taught(station, robot) and axes_at(station, 1, robot, gripper, 0, 0) or native.axes()
    for _, axis in ipairs(known) do
      names[#names + 1] = axis.name
      local value = fields[axis.name]
      if value ~= nil then
        values[axis.name] = lookup.number(axis.name, value)
        axes[axis.index] = axis.turns and math.rad(value) or value
      elseif not is_taught(station, robot) then
        native.fail("BAD_ARGUMENT", ("%s: nil (expected a number: %s was never taught)"):format(axis.name, station.name))
      end
    end
    for field, value in pairs(fields) do
      if values[field] == nil and field ~= "gripper" and field ~= "robot" then
        lookup.refuse_field(field, value, names)
      end
    end
    if next(values) == nil then
      native.fail("BAD_ARGUMENT", ("no axis (expected one or more of %s)"):format(lookup.listed(names)))
    end
    return axes
  end

  -- Moves the station by this shift for a robot, unless one of its slots would be out of reach.
  local function move(station, robot, gripper, shift)
    local before = shifts
    shifts = {}
    for other, moved in pairs(before) do
      shifts[other] = moved
    end
    shifts[key(station, robot)] = shift
    local good, problem = pcall(check_reach, station, robot, gripper)
    if not good then
      shifts = before
      error(problem, 0)
    end
  end

  local function set(name, fields)
    local station, robot, gripper = find(name, lookup.table("axes", fields))
    local axes, before = set_axes(fields, station, robot, gripper), stations.shift(station, robot)
    local shift = native.shift(station.index, robot, gripper, axes, true)
    shift.beams = before and before.beams
    move(station, robot, gripper, shift)
  end

  stations.read, stations.set = read, set

  -- Takes TEACH's result for a robot: slot 1's place in base, mm, and the direction of its way in, rad. With a beam,
  -- also x and y of the first beam that `beam.gripper` passes.
  function stations.learn(station, robot, at, heading, beam)
    local place = native.slot(station.index, 1, 0, 0, 0, 0, robot, nil, true)
    local shift = { at[1] - place.x, at[2] - place.y, at[3] - place.z, heading - place.heading }
    if beam then
      local along = native.beam(station.index, beam.gripper, shift)
      shift.beams = { beam.x - along.x, beam.y - along.y }
    end
    move(station, robot, station.by[robot], shift)
  end

  -- Returns a function that restores the present state, and one that tells whether it is unchanged.
  function stations.keep()
    local kept = shifts
    return function()
      shifts = kept
    end, function()
      return shifts == kept
    end
  end

  return stations
end
