-- Makes the parts of motion control, in the order in which each has what it needs, and hands each what it goes by.

-- Local copies: a script may set globals of these names.
local error, ipairs, pairs, pcall = error, ipairs, pairs, pcall

return function(native, wh)
  local function make(name, ...)
    return native.module(("mcs/%s.lua"):format(name))(...)
  end

  local lookup = make("lookup", native, wh.errors)
  local alarms = make("alarms", native, lookup)
  local stations = make("stations", native, lookup)
  local centring = make("centring", native, lookup, stations)
  local slot_map = make("slot_map", native)

  -------------------------------------------------------------------------------------- what a pattern is made of

  local steps = native.module("mcs/steps.lua")
  local planes, patterns = make("planes", steps), make("patterns", steps)
  local own = make("own_patterns", native, lookup, patterns, steps, make("own_steps", native, lookup, steps))
  local grips = { vacuum = make("grip_vacuum", steps), edge = make("grip_edge", steps), passive = make("grip_passive", steps) }

  ------------------------------------------------------------------------------------------- who plans and plays it

  local tasks = make("tasks", native, lookup)
  local task_words, finish = make("task_words", native, lookup, tasks)
  local arm = make("arm", native, lookup, tasks, alarms)
  local ways = make("ways", native, arm, tasks)
  local kinds = make("kinds", native, patterns, arm, tasks)
  local player = make("player", native, lookup, arm, ways, centring, tasks, alarms, kinds)

  -- These were made before the ones that know the answers.
  function lookup.bound()
    return tasks.current().bound or native.asked_robot()
  end

  function lookup.bound_station()
    return tasks.current().station or native.asked_station()
  end

  lookup.phase, lookup.last_robot = arm.phase, arm.last_robot
  tasks.stands_in, tasks.is_inside = arm.stands_in, arm.is_inside

  function alarms.robot()
    return tasks.current().robot
  end

  function alarms.bearer()
    return alarms.robot() or tasks.current()
  end

  function alarms.play(segment)
    player.play(patterns.single, { segment = segment })
  end

  --------------------------------------------------------------------------------------------------- who asks for it

  local truth = make("truth", native, lookup)
  local mechanisms = make("mechanisms", native, patterns, lookup, arm, player, grips, truth)
  local align = make("align", native, patterns, lookup, arm, player, mechanisms, native.module("mcs/scan_reasons.lua"))
  local targets = make("targets", native, lookup, align, mechanisms, stations, grips, planes)
  local ports = make("ports", native, patterns, lookup, arm, player, slot_map)
  local times = make("times", native, patterns, lookup, arm, player, ports)
  local transfer, carrying = make("transfer", native, patterns, lookup, arm, player, targets, align, centring, alarms,
    slot_map, times, truth, ports)
  local tryout = make("tryout", native, patterns, lookup, player, targets, carrying, own.attempt)
  local flippers = make("flippers", native, patterns, lookup, arm, player, mechanisms, alarms)
  local doors = make("doors", native, patterns, lookup, arm, player, tasks, alarms, times)
  local singles = make("commands", native, patterns, lookup, arm, ways, player, tasks, alarms, align, mechanisms, flippers,
    stations)

  -- The words that move something, by name.
  local commands = {
    edge_scan = align.edge_scan, align = align.align, lift = mechanisms.lift, open = doors.open, close = doors.close,
    centring = centring.last, wait_for = times.wait_for, pump = times.pump, late = times.late,
    carrier = ports.carrier, take_away = ports.take_away, port = ports.port,
    calibrate = make("calibration", native, patterns, lookup, arm, player, targets, align, carrying.carry),
    teach = make("teaching", native, patterns, lookup, arm, player, targets, stations, slot_map, ports),
  }
  local added = make("added", native, lookup, arm, player, targets, align, centring, slot_map, times, own)
  for _, words in ipairs({ transfer, singles, task_words, added, make("faults", native, lookup, arm, alarms) }) do
    for name, word in pairs(words) do
      commands[name] = word
    end
  end

  -- The words that only ask.
  local queries = make("queries", native, lookup, wh, times.judge_stay)
  queries.station, queries.now, queries.port_map = stations.read, times.now, ports.port_map

  ------------------------------------------------------------------------------------------------------- the whole

  local parts = { lookup = lookup, alarms = alarms, targets = targets, tasks = tasks, commands = commands, queries = queries,
    own = own, finish = finish, ports = ports, slot_map = slot_map }

  parts.reach = make("reach", native, tryout, make("flip_room", native, patterns, lookup, player, tryout),
    stations, own)

  -- Keeps motion control's knowledge: returns a function that puts it back, and one that tells whether
  -- the arm is unchanged.
  function parts.keep()
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

  -- Calls a word for one of several robots: bind(index, word, ...).
  function parts.bind(index, word, ...)
    local task = tasks.current()
    local before = task.bound
    local function restore(ok, ...)
      task.bound = before
      if not ok then
        error((...), 0)
      end
      return ...
    end
    task.bound = index
    return restore(pcall(word, ...))
  end

  return parts
end
