-- The operator's words that move something: those of lua/mcs/transfer.lua, and the single moves here.

-- Kept, for a script may set globals of these names.
local error, ipairs, math, pairs, pcall = error, ipairs, math, pairs, pcall

return function(native, patterns, lookup)
  local centring = native.module("mcs/centring.lua")(native, lookup)
  local arm = native.module("mcs/arm.lua")(native, lookup, centring)
  local align = native.module("mcs/align.lua")(native, patterns, lookup, arm)
  local targets = native.module("mcs/targets.lua")(native, lookup, align)
  local commands = native.module("mcs/transfer.lua")(native, patterns, lookup, arm, targets, align, centring)

  ----------------------------------------------------------------------------------------------- single moves

  -- A wafer that is lost meanwhile is an error, unless it is the way out of trouble.
  local function play(segment)
    arm.play(patterns.single, { segment = segment, watched = true })
  end

  local function rotate(station_name, degrees)
    local station = align.prealigner(station_name)
    local axis = native.layout.grippers[station.chuck].axis
    local axes = native.axes()
    axes[axis] = axes[axis] + math.rad(lookup.number("degrees", degrees))
    play { axes = axes }
  end

  function commands.rotate(station, degrees)
    arm.move(lookup.command("ROTATE", station, degrees), rotate, station, degrees)
  end

  commands.edge_scan, commands.align = align.edge_scan, align.align

  commands.centring = centring.last
  commands.teach = native.module("mcs/teaching.lua")(native, patterns, lookup, arm, targets)

  local function valve(gripper, level)
    if level ~= 0 and level ~= 1 then
      native.fail("BAD_VALVE", ("level: %s (expected 0, open, or 1, closed)"):format(lookup.quote(level)))
    end
    local index = lookup.gripper(gripper)
    align.forget_chuck(index)
    play { valves = { [index] = math.tointeger(level) } }
  end

  function commands.valve(gripper, level)
    arm.move(lookup.command("VALVE", gripper, level), valve, gripper, level)
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
    local axes, to = native.axes(), read_fields("move", positions, lookup.axes)
    for axis, name in ipairs(lookup.axes) do
      local turns = name == "theta" or name == "yaw"
      axes[axis] = to[name] and (turns and math.rad(to[name]) or to[name]) or axes[axis]
    end
    arm.check_homed()
    play { axes = axes }
  end

  -- move { theta = , r = , z = , yaw = }: degrees and mm; an axis that is not named stays.
  function commands.move(positions)
    arm.move(lookup.command("MOVE", lookup.fields_text(positions, lookup.axes)), move, positions)
  end

  local function line(by)
    local parts = read_fields("line", by, lookup.line_fields)
    arm.check_homed()
    play { line = { parts.dx or 0, parts.dy or 0, parts.dz or 0 }, speed = parts.speed or 0 }
  end

  -- line { dx = , dy = , dz = , speed = }: the end-effector straight by so many mm in base, its heading kept;
  -- without a speed as fast as the axes go.
  function commands.line(by)
    arm.move(lookup.command("LINE", lookup.fields_text(by, lookup.line_fields)), line, by)
  end

  local function wait(seconds)
    play { dwell = lookup.number("seconds", seconds) }
  end

  function commands.wait(seconds)
    arm.run(lookup.command("WAIT", seconds), wait, seconds)
  end

  -------------------------------------------------------------------------------------- STOP and what follows

  -- Straight out of the station that the arm stands in, if it does.
  local function recover()
    local target = arm.inside
    if target then
      target.stands = native.gripper_pose(target.gripper).r
      target.loaded = native.sensor(target.gripper)
      target.watched = false
      arm.play(patterns.recover, target)
    end
    arm.set_free()
  end

  function commands.recover()
    arm.move("RECOVER", recover)
  end

  local function home()
    local axes = native.axes()
    recover()
    for axis, position in ipairs(native.layout.home) do
      axes[axis] = position
    end
    arm.play(patterns.single, { segment = { axes = axes } })
    arm.homed = true
  end

  function commands.home()
    arm.move("HOME", home)
  end

  -- A STOP comes so many simulated seconds from now, whatever then runs: it ends there with STOPPED.
  function commands.stop_in(seconds)
    native.stop_in(lookup.number("seconds", seconds))
  end

  -- What a `stop` of GET, PUT or SWAP holds in a phase goes on.
  function commands.continue()
    arm.continue()
  end

  -- Gives up what is held in a phase, as a STOP from outside does; without that nothing.
  function commands.stop()
    arm.stop()
  end

  local keep_slots = commands.keep_slots
  commands.keep_slots = nil

  -- What motion control knows: a function that puts it back, and one that says if the arm is as it was.
  function commands.keep()
    local put_slots_back, put_found_back = keep_slots(), align.keep()
    local put_arm_back, is_as_was = arm.keep()
    return function()
      put_slots_back()
      put_found_back()
      put_arm_back()
    end, is_as_was
  end

  commands.run = arm.run
  return commands
end
