-- Injected errors: fault { error = N } arms one. The next command that can give this error gives it, once.
--
-- How each one is raised:
--   cause   something breaks, so that the command meets the real effect in the cell
--   check   the command is refused before anything moves, though nothing is wrong
--   line    likewise, for an error that motion control and the cell never cause, or that comes before a command is
--           read: a host gets it all the same

-- Local copies: a script may set globals of these names.
local ipairs, pairs, pcall, table = ipairs, pairs, pcall, table

return function(native, lookup)
  local alarms = {}

  -- By the error's number: its name, how it is raised, and the set of commands; and all numbers. They are read when the
  -- first fault asks.
  local by_number, numbers

  local function read_errors()
    by_number, numbers = {}, {}
    for name, how in pairs(native.module("mcs/alarm_errors.lua").how) do
      local number, words = lookup.errors[name].number, {}
      for word in how[2]:gmatch("%S+") do
        words[word] = true
      end
      by_number[number] = { name = name, how = how[1], words = words }
      numbers[#numbers + 1] = number
    end
    table.sort(numbers)
  end

  local function raised_by(number)
    if not by_number then
      read_errors()
    end
    return by_number[number]
  end

  -- By robot: the broken part for its running or held command: { alarm = , fault = , opened = }. By task, if only a
  -- door or a flipper works.
  local broken = {}

  -- alarms.play(segment) plays a single segment; alarms.robot() is the robot of the running command, or nil;
  -- alarms.bearer() is that robot, or the task. lua/mcs/parts.lua sets all of them.

  function alarms.arm(error)
    if not raised_by(error) then
      local text = "error: %s (expected the number of one that a command can answer: %s)"
      native.fail("BAD_ARGUMENT", text:format(lookup.quote(error), table.concat(numbers, ", ")))
    end
    return native.arm_alarm(error)
  end

  local NONE = {}

  -- The first armed error that this command can give and that is raised in this way, or nil.
  local function find(word, how)
    for _, alarm in ipairs(native.alarms() or NONE) do
      local raised = raised_by(alarm.error)
      if raised.words[word] and raised.how == how then
        return alarm, raised
      end
    end
  end

  local function take(error_name)
    for _, alarm in ipairs(native.alarms() or NONE) do
      if raised_by(alarm.error).name == error_name then
        native.disarm(alarm.number)
        return true
      end
    end
    return false
  end
  alarms.take = take

  local function raise(alarm, raised)
    native.disarm(alarm.number)
    native.fail(raised.name, ("on purpose, by fault %d"):format(alarm.number))
  end

  -- Call it before a command has begun: the command then does not begin.
  function alarms.refuse(word)
    local alarm, raised = find(word, "line")
    if alarm and raised.name ~= "NO_SUCH_COMMAND" then
      raise(alarm, raised)
    end
  end

  -- Call it before a typed line is read.
  function alarms.refuse_line(word)
    local alarm, raised = find(word, "line")
    if alarm and raised.name == "NO_SUCH_COMMAND" then
      raise(alarm, raised)
    end
  end

  -- Call it within a command, or before a question is answered.
  function alarms.check(word)
    local alarm, raised = find(word, "check")
    if alarm then
      raise(alarm, raised)
    end
  end

  -- The time that a command has moved when its STOP comes, s.
  local BEFORE_STOP = 0.1

  -- Runs the command of this word, with the error armed for it.
  function alarms.meet(word, action, ...)
    alarms.check(word)
    return action(...)
  end

  -- By the bearer of the running command: the alarm whose STOP will end it.
  local stopping = {}

  -- Call it when the running command is about to move.
  function alarms.begin_motion(text)
    local armed = native.alarms()
    if not armed then
      return
    end
    local bearer, stopped = alarms.bearer(), raised_by(lookup.errors.STOPPED.number)
    for _, alarm in ipairs(not stopping[bearer] and armed or NONE) do
      if raised_by(alarm.error) == stopped and stopped.words[text:match("^[%u_]+")] then
        stopping[bearer] = alarm.number
        native.stop_in(BEFORE_STOP)
        return
      end
    end
  end

  -- The command has ended, with the error of this number or none. If the STOP did not end it, the alarm waits for
  -- another command.
  local function end_stop(number)
    local bearer = alarms.bearer()
    if stopping[bearer] and number == lookup.errors.STOPPED.number then
      native.disarm(stopping[bearer])
    elseif stopping[bearer] then
      native.stop_in()
    end
    stopping[bearer] = nil
  end

  -------------------------------------------------------------------------------------------------- causes

  -- The fault to inject at a target of `word`, "get" or "put": its kind and its gripper; nil: no fault leads to
  -- this error there. `at_once` false: not before the arm moves.
  local causes = {}

  local function by_vacuum(target)
    return not target.edge and not target.is_passive
  end

  -- A plunger's speed for a timeout, mm/s: it moves, but does not arrive in time.
  local CREEP = 1e-3

  function causes.PLUNGER_STUCK(_, target)
    return target.edge and { "plunger_stuck", target.gripper }
  end

  -- A plunger that must first go back would be slow then, and give another error.
  function causes.GRIP_TIMEOUT(word, target)
    return word == "get" and target.edge and native.grip(target.gripper) == "open" and { "plunger_slow", target.gripper, value = CREEP }
  end

  function causes.UNGRIP_TIMEOUT(word, target)
    return word == "put" and target.edge and { "plunger_slow", target.gripper, value = CREEP }
  end

  function causes.SENSORS_DISAGREE(word, target)
    return word == "get" and target.edge and { "sensor_off", target.gripper }
  end

  function causes.WAFER_MISSING(word, target)
    return word == "get" and by_vacuum(target) and not native.is_open(target.gripper)
      and { "valve_stuck", target.gripper }
  end

  function causes.NO_WAFER_ON_GRIPPER(word, target)
    return word == "put" and target.asks and { "sensor_off", target.gripper }
  end

  function causes.WAFER_ON_GRIPPER(word, target)
    return word == "get" and target.asks and { "sensor_on", target.gripper, opens = not target.is_passive }
  end

  function causes.VACUUM_BEFORE_PICK(word, target)
    return word == "get" and target.asks and by_vacuum(target) and not native.is_open(target.gripper)
      and { "sensor_on", target.gripper }
  end

  function causes.VACUUM_TIMEOUT(word, target)
    if word == "get" then
      return target.asks and not target.edge and { "sensor_off", target.gripper }
    end
    return target.chuck and { "sensor_off", target.chuck }
  end

  function causes.WAFER_LOST(_, target)
    if target.chuck then
      return not native.is_open(target.chuck) and { "valve_stuck", target.chuck }
    end
    return target.asks and not target.edge and { "sensor_on", target.gripper }
  end

  function causes.WAFER_LOST_ON_WAY(_, target)
    return target.watched and by_vacuum(target) and { "no_vacuum", target.gripper, later = true }
  end

  -- PUT gives these errors, too, if it centres by beams.
  local OF_CENTRING = { TOO_FEW_SAMPLES = true, CENTRE_NOT_SURE = true }

  local function check_centring(target)
    for _, alarm in ipairs(target.centre and native.alarms() or NONE) do
      local raised = raised_by(alarm.error)
      if OF_CENTRING[raised.name] then
        raise(alarm, raised)
      end
    end
  end

  local function stand_still()
    alarms.play { dwell = native.layout.slice }
  end

  -- Call it before a GET, PUT or SWAP reads its sensors. `half` is "get" or "put".
  function alarms.break_at(word, half, target)
    local robot = alarms.robot()
    check_centring(target)
    for _, alarm in ipairs(not broken[robot] and native.alarms() or NONE) do
      local raised = raised_by(alarm.error)
      local cause = raised.words[word] and causes[raised.name] and causes[raised.name](half, target)
      if cause then
        local kind, gripper = cause[1], native.layout.grippers[cause[2]].name
        broken[robot] = { alarm = alarm, fault = native.fault { kind = kind, gripper = gripper, value = cause.value } }
        if cause.opens and not native.is_open(cause[2]) then
          broken[robot].opened = cause[2]
          alarms.play { valves = { [cause[2]] = 0 } }
        end
        if not cause.later then
          stand_still()
        end
        return
      end
    end
  end

  -- Breaks the mechanism that this word moves, for an armed error of that name.
  local function break_mechanism(error_name, word, fault)
    local bearer = alarms.bearer()
    for _, alarm in ipairs(not broken[bearer] and native.alarms() or NONE) do
      local raised = raised_by(alarm.error)
      if raised.name == error_name and raised.words[word] then
        broken[bearer] = { alarm = alarm, fault = native.fault(fault) }
        stand_still()
        return
      end
    end
  end

  function alarms.break_door(word, door)
    break_mechanism("DOOR_TIMEOUT", word, { kind = "door_stuck", door = door })
  end

  function alarms.break_flip(gripper)
    break_mechanism("FLIP_TIMEOUT", "FLIP", { kind = "axis_stopped", gripper = gripper })
  end

  -- A command has ended, with the error of this number or none: the part broken for it works again. If it was the
  -- armed error, that no longer waits. A slice passes, so that the cell has this change.
  function alarms.mend(number)
    end_stop(number)
    local bearer, robot = alarms.bearer(), alarms.robot()
    local was = broken[bearer]
    if not was or robot and native.is_held(robot) then
      return
    end
    broken[bearer] = nil
    pcall(native.clear_fault, was.fault)
    if number == was.alarm.error then
      native.disarm(was.alarm.number)
      if was.opened then
        pcall(alarms.play, { valves = { [was.opened] = 1 } })
      end
      pcall(stand_still)
    else
      native.note_tried(was.alarm.number)
    end
  end

  -- Returns a function that restores the parts broken now.
  function alarms.keep()
    local was = {}
    for bearer, what in pairs(broken) do
      was[bearer] = what
    end
    return function()
      broken = was
    end
  end

  return alarms
end
