-- Doors: walls that move. OPEN and CLOSE, and the checks of commands that go through a door.

-- Local copies: a script may set globals of these names.
local ipairs, pairs, pcall = ipairs, pairs, pcall

return function(native, patterns, lookup, arm, player, tasks, alarms, times)
  local doors = {}

  -- The stations that have this door, for any robot.
  local function stations_of(door)
    local names = {}
    for name, station in pairs(native.layout.stations) do
      for _, index in ipairs(station.doors or {}) do
        names[name] = names[name] or index == door or nil
      end
    end
    return names
  end

  -- Refuses while a robot stands in one of the door's stations: it would be in the way.
  local function check_free(door, name)
    for station in pairs(stations_of(door)) do
      local state = arm.find_inside(station)
      if state then
        local text = "%s: the arm stands in %s slot %d since %s: CONTINUE, RECOVER or HOME comes first"
        native.fail("DOOR_BLOCKED", text:format(name, station, state.inside.slot, state.since))
      end
    end
  end

  local function await(door, index, word)
    local arrived = player.play(patterns.arrive, { segment = { arrives = { door = index }, timeout = door.timeout } })
    if not arrived then
      local _, at = native.door(index)
      local text = "%s is not %s within %.10g s: it has come to %.1f of %.10g mm"
      native.fail("DOOR_TIMEOUT", text:format(door.name, word, door.timeout, at, door.travel))
    end
  end

  local function move(name, word)
    local index = lookup.door(name)
    local door = native.layout.doors[index]
    if word == "shut" then
      check_free(index, door.name)
    else
      times.check_door(index)
    end
    local to = word == "open" and door.travel or 0
    alarms.break_door(word == "open" and "OPEN" or "CLOSE", door.name)
    if native.axes()[door.axis] ~= to then
      player.play(patterns.single, { segment = { moves = { [door.axis] = to } } })
    end
    await(door, index, word)
  end

  local function needs(name)
    local good, index = pcall(lookup.door, name)
    return good and arm.needs_door(index) or nil
  end

  function doors.open(door)
    arm.run(needs(door), lookup.command("OPEN", door), move, door, "open")
  end

  function doors.close(door)
    arm.run(needs(door), lookup.command("CLOSE", door), move, door, "shut")
  end

  return doors
end
