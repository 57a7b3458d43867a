-- The operator's words that move something: those of lua/mcs/transfer.lua, and the single moves here.

-- Kept, for a script may set globals of these names.
local ipairs, math, pairs, table, tostring, type = ipairs, math, pairs, table, tostring, type

return function(native, patterns, lookup)
  local arm = native.module("mcs/arm.lua")(native, lookup)
  local targets = native.module("mcs/targets.lua")(native, lookup)
  local commands = native.module("mcs/transfer.lua")(native, patterns, lookup, arm, targets)

  ------------------------------------------------------------------------------------------ single moves

  -- A wafer that is lost meanwhile is an error, unless it is the way out of trouble.
  local function play(segment)
    arm.play(patterns.single, { segment = segment, watched = true })
  end

  local function rotate(station_name, degrees)
    local station = lookup.station(station_name)
    if not station.chuck then
      native.fail("NOT_A_PREALIGNER", lookup.quote(station_name))
    end
    local axis = native.layout.grippers[station.chuck].axis
    local axes = native.axes()
    axes[axis] = axes[axis] + math.rad(lookup.number("degrees", degrees))
    play { axes = axes }
  end

  function commands.rotate(station, degrees)
    arm.run(lookup.command("ROTATE", station, degrees), rotate, station, degrees)
  end

  local function valve(gripper, level)
    if level ~= 0 and level ~= 1 then
      native.fail("BAD_VALVE", "valve: " .. lookup.quote(level) .. " (expected 0, open, or 1, closed)")
    end
    play { valves = { [lookup.gripper(gripper)] = math.tointeger(level) } }
  end

  function commands.valve(gripper, level)
    arm.run(lookup.command("VALVE", gripper, level), valve, gripper, level)
  end

  local function axis_of(name)
    for axis, known in ipairs(lookup.axes) do
      if name == known then
        return axis
      end
    end
    native.fail("BAD_ARGUMENT", tostring(name) .. ": no such axis (expected theta, r, z or yaw)")
  end

  local function move(positions)
    local axes = native.axes()
    for name, value in pairs(lookup.table("move", positions)) do
      local axis = axis_of(name)
      local turns = name == "theta" or name == "yaw"
      axes[axis] = turns and math.rad(lookup.number(name, value)) or lookup.number(name, value)
    end
    arm.check_homed()
    play { axes = axes }
  end

  local function text_of(positions, order)
    local text = {}
    for _, name in ipairs(order) do
      if type(positions) == "table" and positions[name] ~= nil then
        text[#text + 1] = ("%s=%s"):format(name, lookup.number_text(positions[name]))
      end
    end
    return table.concat(text, " ")
  end

  -- move { theta = , r = , z = , yaw = }: degrees and mm; an axis that is not named stays.
  function commands.move(positions)
    arm.run(lookup.command("MOVE", text_of(positions, lookup.axes)), move, positions)
  end

  local function line(by)
    local parts = { dx = 0, dy = 0, dz = 0, speed = 0 }
    for name, value in pairs(lookup.table("line", by)) do
      if parts[name] == nil then
        native.fail("BAD_ARGUMENT", tostring(name) .. ": no such field (expected dx, dy, dz or speed)")
      end
      parts[name] = lookup.number(name, value)
    end
    arm.check_homed()
    play { line = { parts.dx, parts.dy, parts.dz }, speed = parts.speed }
  end

  -- line { dx = , dy = , dz = , speed = }: the end-effector straight by so many mm in base, its heading kept.
  function commands.line(by)
    arm.run(lookup.command("LINE", text_of(by, lookup.line_fields)), line, by)
  end

  local function wait(seconds)
    if lookup.number("seconds", seconds) < 0 or seconds > 1e6 then
      native.fail("BAD_ARGUMENT", ("seconds: %s (expected 0 to 1e6)"):format(tostring(seconds)))
    end
    play { dwell = seconds }
  end

  function commands.wait(seconds)
    arm.run(lookup.command("WAIT", seconds), wait, seconds)
  end

  ------------------------------------------------------------------------------------- STOP and what follows

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
    arm.run("RECOVER", recover)
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
    arm.run("HOME", home)
  end

  -- A STOP comes so many simulated seconds from now, whatever then runs: it ends there with STOPPED.
  function commands.stop_in(seconds)
    if lookup.number("seconds", seconds) < 0 or seconds > 1e6 then
      native.fail("BAD_ARGUMENT", ("seconds: %s (expected 0 to 1e6)"):format(tostring(seconds)))
    end
    native.stop_in(seconds)
  end

  commands.run = arm.run
  return commands
end
