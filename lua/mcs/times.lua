-- Stations that take time: what GET and PUT ask of them, PUMP and WAIT_FOR, and what doors of load locks ask.

-- Local copies: a script may set globals of these names.
local ipairs, math, pairs = ipairs, math, pairs

return function(native, patterns, lookup, arm, player, ports)
  local times = {}

  -- Times in a message, to a millisecond.
  local function seconds(value)
    return ("%.3f"):format(value):gsub("%.?0+$", "")
  end

  local function door_name(index)
    return native.layout.doors[index].name
  end

  ------------------------------------------------------------------------------------------------ GET and PUT

  -- The side of a load lock where the robot comes must have its pressure.
  local function check_pressure(station, robot)
    local side, to = native.pressure(station.index)
    local wanted = side and station.sides[robot]
    if side and (to or side ~= wanted) then
      local text = '%s is %s (expected %s, where %s comes): pump("%s", "%s") comes first'
      native.fail("WRONG_PRESSURE", text:format(station.name, to and "on its way to " .. to or "at " .. side, wanted,
        lookup.robot_text(robot), station.name, wanted))
    end
  end

  local function fail_cleaning(station, slot, left)
    local text = '%s slot %d, for %s s yet: wait_for("%s") comes first'
    native.fail("CLEANING", text:format(station.name, slot, seconds(left), station.name))
  end

  local function fail_due(station, slot, wafer)
    local text = "%s slot %d is due when %s has left: GET, and PUT when it is clean"
    native.fail("CLEANING", text:format(station.name, slot, wafer))
  end

  -- The reason why a process has not begun; `why`: how its wafer lies, unless that is well.
  local function why_waiting(station, why)
    local door, inside = native.open_door(station.index), arm.find_inside(station.name)
    return why or door and ('%s is not shut: close("%s") comes first'):format(door_name(door), door_name(door))
      or inside and "the arm stands in it" or "the station pumps"
  end

  -- A wafer may be taken once nothing runs around it. With `force` also one whose process has not begun.
  local function check_get(target, station)
    local phase, wafer, left, _, why = native.place(station.index, target.slot)
    if phase == "processing" then
      local text = '%s in %s slot %d needs %s s yet: wait_for("%s") comes first'
      native.fail("PROCESS_RUNNING", text:format(wafer, station.name, target.slot, seconds(left), station.name))
    elseif phase == "waiting" and not target.force then
      local text = "the process of %s in %s slot %d has not begun, for %s"
      native.fail("PROCESS_RUNNING", text:format(wafer, station.name, target.slot, why_waiting(station, why)))
    elseif phase == "waiting" then
      native.takes_by_force(station.index, target.slot)
    elseif phase == "cleaning" and wafer then
      fail_cleaning(station, target.slot, left)
    end
  end

  local function check_put(target, station)
    local phase, wafer, left, cleans, why = native.place(station.index, target.slot)
    if phase == "cleaning" then
      fail_cleaning(station, target.slot, left)
    elseif wafer and cleans and why then
      fail_due(station, target.slot, wafer)
    end
    native.brings(target.robot, station.index, target.slot)
  end

  -- SWAP leaves the place no time for a clean.
  local function check_swap(target, station)
    check_get(target, station)
    local _, wafer, _, cleans = native.place(station.index, target.slot)
    if wafer and cleans then
      fail_due(station, target.slot, wafer)
    end
    native.brings(target.robot, station.index, target.slot)
  end

  local CHECKS = { get = check_get, put = check_put, swap = check_swap }

  -- Call it before a GET, PUT or SWAP moves anything.
  function times.check(word, target)
    local station = lookup.station(target.station)
    if station.is_port then
      ports.check(target.station)
    elseif station.takes_time then
      check_pressure(station, target.robot)
      CHECKS[word](target, station)
    end
  end

  --------------------------------------------------------------------------------------------------- WAIT_FOR

  -- How much longer than described a command waits by default, s.
  local GRACE = 60

  local function check_takes_time(station)
    if not station.takes_time then
      local names = {}
      for name, other in pairs(native.layout.stations) do
        names[#names + 1] = other.takes_time and name or nil
      end
      local expected = #names > 0 and "a station that takes time: " .. lookup.listed(names)
        or "none: no station of the layout has `process`, `clean` or `pump`, or is a load port"
      native.fail("BAD_ARGUMENT", ("station: %s (expected %s)"):format(lookup.quote(station.name), expected))
    end
  end

  -- Names the thing that has not ended in the station, for a message.
  local function what_runs(station)
    if station.is_port then
      return ports.how_is(station.name, station.index)
    end
    local _, to = native.pressure(station.index)
    if to then
      return ("it is on its way to %s"):format(to)
    end
    for slot = 1, station.slots do
      local phase, wafer, _, _, why = native.place(station.index, slot)
      if phase == "waiting" then
        return ("the process of %s in slot %d has not begun, for %s"):format(wafer, slot, why_waiting(station, why))
      elseif phase == "processing" then
        return ("the process of %s in slot %d goes on"):format(wafer, slot)
      elseif phase == "cleaning" then
        local door = native.open_door(station.index)
        return ("the clean of slot %d goes on or is due%s"):format(slot,
          door and ("; %s is not shut"):format(door_name(door)) or "")
      end
    end
  end

  local function await(station, timeout)
    local ended = player.play(patterns.arrive, { segment = { arrives = { station = station.index }, timeout = timeout } })
    if not ended then
      native.fail("STATION_TIMEOUT", ("%s within %s s: %s"):format(station.name, seconds(timeout), what_runs(station)))
    end
  end

  local function wait_for(name, timeout)
    local station = lookup.station(name)
    timeout = timeout ~= nil and lookup.number("timeout", timeout, lookup.ranges.seconds)
    check_takes_time(station)
    local rest = native.rest(station.index)
    if rest then
      await(station, timeout or math.min(rest + GRACE, lookup.ranges.seconds[2]))
    end
    if station.is_port then
      ports.fail_if_timed_out(name, station.index)
    end
  end

  -- wait_for("PM1"): waits until nothing runs in the station any more, or is to begin there.
  function times.wait_for(station, timeout)
    arm.run(arm.needs(false), lookup.command("WAIT_FOR", station, timeout), wait_for, station, timeout)
  end

  ------------------------------------------------------------------------------------------------------- PUMP

  lookup.sides = { "vacuum", "atmosphere" }

  local function check_lock(station)
    if not native.pressure(station.index) then
      local names = {}
      for name, other in pairs(native.layout.stations) do
        names[#names + 1] = other.sides and name or nil
      end
      local expected = #names > 0 and "a load lock: " .. lookup.listed(names)
        or "none: no station of the layout has a `pump`"
      native.fail("BAD_ARGUMENT", ("station: %s (expected %s)"):format(lookup.quote(station.name), expected))
    end
  end

  local function check_shut(station)
    local door, inside = native.open_door(station.index), arm.find_inside(station.name)
    if inside then
      local text = "the arm stands in %s slot %d since %s: CONTINUE, RECOVER or HOME comes first"
      native.fail("DOOR_OPEN", text:format(station.name, inside.inside.slot, inside.since))
    elseif door then
      native.fail("DOOR_OPEN", ('%s of %s: close("%s") comes first'):format(door_name(door), station.name,
        door_name(door)))
    end
  end

  local function pump(name, to)
    local station = lookup.station(name)
    lookup.value("state", to, { values = lookup.sides })
    check_lock(station)
    check_shut(station)
    if not native.pump(station.index, to) then
      local _, other, left = native.pressure(station.index)
      native.fail("WRONG_PRESSURE", ("%s is on its way to %s, for %s s yet"):format(station.name, other, seconds(left)))
    end
    local _, under_way, left = native.pressure(station.index)
    if under_way then
      local timeout = left + GRACE
      local there = player.play(patterns.arrive, { segment = { arrives = { lock = station.index }, timeout = timeout } })
      if not there then
        native.fail("STATION_TIMEOUT", ("%s within %s s: it is on its way to %s"):format(station.name, seconds(timeout),
          to))
      end
    end
  end

  -- pump("LL", "vacuum" or "atmosphere"): the load lock has this pressure when the command has ended.
  function times.pump(station, to)
    arm.move(arm.needs_lock(station), lookup.command("PUMP", station, to), pump, station, to)
  end

  ------------------------------------------------------------------------------------------------------ doors

  -- Refuses while a door to the other side of the load lock is not shut.
  local function check_others(station, side)
    for other, other_side in pairs(station.door_sides) do
      if other_side ~= side and native.door(other) ~= "shut" then
        local text = '%s of %s is not shut: close("%s") comes first'
        native.fail("BOTH_OPEN", text:format(door_name(other), station.name, door_name(other)))
      end
    end
  end

  -- Refuses to open a door of a load lock that has another pressure, or another door open.
  function times.check_door(door)
    for _, station in pairs(native.layout.stations) do
      local side = station.door_sides and station.door_sides[door]
      if side then
        check_others(station, side)
        local is, to = native.pressure(station.index)
        if to or is ~= side then
          local text = '%s leads to %s, and %s is %s: pump("%s", "%s") comes first'
          native.fail("WRONG_PRESSURE", text:format(door_name(door), side, station.name,
            to and "on its way to " .. to or "at " .. is, station.name, side))
        end
      end
    end
  end

  ------------------------------------------------------------------------------------------ what scripts ask

  -- Simulated seconds so far.
  function times.now()
    return native.utime() / 1e6
  end

  -- late "tell": from now on a stay beyond a window fails nothing; "fail": it does.
  function times.late(how)
    lookup.value("how", how, { values = { "tell", "fail" } })
    native.tell_late(how == "tell")
  end

  -- Returns the verdict and the text of an expectation, and its name: the wafer's last stay there lasts at most so long.
  function times.judge_stay(wafer, name, most)
    local index, station = lookup.wafer(wafer), lookup.station(name)
    lookup.number("seconds", most, lookup.ranges.seconds)
    check_takes_time(station)
    local stay, is_there = native.stay(index, station.index)
    local name = ("%s leaves %s at most %.10g s after its process"):format(wafer, name, most)
    if not stay then
      return false, name .. (is_there == nil and "; it was never done there"
        or "; the process of its last stay there has not ended"), name
    elseif stay <= most then
      return true, name, name
    end
    return false, ("%s; it %s %.10g s, %.10g s too long"):format(name, is_there and "has been there for" or "stayed", stay,
      stay - most), name
  end

  return times
end
