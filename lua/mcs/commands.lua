-- The operator's words that move something: those of lua/mcs/transfer.lua, and the single moves here.

-- Kept, for a script may set globals of these names.
local ipairs, math, pairs, table, tostring, type = ipairs, math, pairs, table, tostring, type

return function(native, patterns, names)
  local arm = native.module("mcs/arm.lua")(native, names)
  local jobs = native.module("mcs/jobs.lua")(native, names, arm)
  local commands = native.module("mcs/transfer.lua")(native, patterns, names, arm, jobs)

  ------------------------------------------------------------------------------------------ single moves

  -- A wafer that is lost meanwhile is an error, unless it is the way out of trouble.
  local function play(segment)
    arm.play(patterns.single, { segment = segment, watched = true })
  end

  local function rotate(station_name, degrees)
    local station = names.station(station_name)
    if not station.chuck then
      native.fail("NOT_A_PREALIGNER", names.quote(station_name))
    end
    local axis = native.layout().grippers[station.chuck].axis
    local axes = native.axes()
    axes[axis] = axes[axis] + math.rad(names.number("degrees", degrees))
    play { axes = axes }
  end

  function commands.rotate(station, degrees)
    arm.run(names.command("ROTATE", station, degrees), rotate, station, degrees)
  end

  local function valve(gripper, level)
    if level ~= 0 and level ~= 1 then
      native.fail("BAD_VALVE", "valve: " .. names.quote(level) .. " (expected 0, open, or 1, closed)")
    end
    play { valves = { [names.gripper(gripper)] = math.tointeger(level) } }
  end

  function commands.valve(gripper, level)
    arm.run(names.command("VALVE", gripper, level), valve, gripper, level)
  end

  local function axis_of(name)
    for axis, known in ipairs(names.axes) do
      if name == known then
        return axis
      end
    end
    native.fail("BAD_ARGUMENT", tostring(name) .. ": no such axis (expected theta, r, z or yaw)")
  end

  local function move(targets)
    local axes = native.axes()
    for name, value in pairs(names.table("move", targets)) do
      local axis = axis_of(name)
      local turns = name == "theta" or name == "yaw"
      axes[axis] = turns and math.rad(names.number(name, value)) or names.number(name, value)
    end
    arm.check_homed()
    play { axes = axes }
  end

  local function text_of(targets, order)
    local text = {}
    for _, name in ipairs(order) do
      if type(targets) == "table" and targets[name] ~= nil then
        text[#text + 1] = ("%s=%s"):format(name, names.number_text(targets[name]))
      end
    end
    return table.concat(text, " ")
  end

  -- move { theta = , r = , z = , yaw = }: degrees and mm; an axis that is not named stays.
  function commands.move(targets)
    arm.run(names.command("MOVE", text_of(targets, names.axes)), move, targets)
  end

  local function line(by)
    local parts = { dx = 0, dy = 0, dz = 0, speed = 0 }
    for name, value in pairs(names.table("line", by)) do
      if parts[name] == nil then
        native.fail("BAD_ARGUMENT", tostring(name) .. ": no such field (expected dx, dy, dz or speed)")
      end
      parts[name] = names.number(name, value)
    end
    arm.check_homed()
    play { line = { parts.dx, parts.dy, parts.dz }, speed = parts.speed }
  end

  -- line { dx = , dy = , dz = , speed = }: the end-effector straight by so many mm in base, its heading kept.
  function commands.line(by)
    arm.run(names.command("LINE", text_of(by, names.line_fields)), line, by)
  end

  local function wait(seconds)
    if names.number("seconds", seconds) < 0 or seconds > 1e6 then
      native.fail("BAD_ARGUMENT", ("seconds: %s (expected 0 to 1e6)"):format(tostring(seconds)))
    end
    play { dwell = seconds }
  end

  function commands.wait(seconds)
    arm.run(names.command("WAIT", seconds), wait, seconds)
  end

  ------------------------------------------------------------------------------------- STOP and what follows

  -- Straight out of the station that the arm stands in, if it does.
  local function recover()
    local job = arm.inside
    if job then
      job.stands = native.gripper_pose(job.gripper).r
      job.loaded = native.sensor(job.gripper)
      job.watched = false
      arm.play(patterns.recover, job)
    end
    arm.set_free()
  end

  function commands.recover()
    arm.run("RECOVER", recover)
  end

  local function home()
    local axes = native.axes()
    recover()
    for axis, position in ipairs(native.layout().home) do
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
    if names.number("seconds", seconds) < 0 or seconds > 1e6 then
      native.fail("BAD_ARGUMENT", ("seconds: %s (expected 0 to 1e6)"):format(tostring(seconds)))
    end
    native.stop_in(seconds)
  end

  commands.run = arm.run
  return commands
end
