-- Room to turn over. `waferhand layout` plays FLIP in the likely places: at home, in front of a station, and in a flipper's
-- clamp. It also plays GET and PUT at a station with a blade that is turned over.

-- Local copies: a script may set globals of these names.
local ipairs, math, pcall, tostring, type = ipairs, math, pcall, tostring, type

return function(native, patterns, lookup, player, tryout)
  local room = {}

  -- By robot: FLIP at home has no room; FLIP at home takes too long to be played.
  local has_none_at_home, is_slow = {}, {}

  local function plan_turn(axis)
    return player.rehearse(patterns.single, { segment = { moves = { [axis] = math.pi } } })
  end

  local function reason_of(problem)
    return type(problem) == "table" and problem.text or tostring(problem)
  end

  -- Turns the axis over like FLIP; here and below `cell` is the cell in which lib/survey/survey.c places the
  -- robot. If that is refused or the cell complains, calls failed(slot, what, reason) and returns true.
  local function fails(axis, cell, failed, slot, what)
    local good, problem = pcall(function()
      player.drive(plan_turn(axis))
    end)
    problem = cell.complaint() or not good and problem
    if problem then
      failed(slot, what, reason_of(problem))
    end
    return problem and true
  end

  -- Places the robot there at rest, with its held wafers; earlier complaints do not count.
  local function stand(axes, cell)
    cell.move(axes)
    player.drive(player.rehearse(patterns.single, { segment = { dwell = 4 * native.layout.slice } }))
    cell.begin()
  end

  -- Turns over the blade with a wafer after a GET there: where the GET ends, and at home.
  local function try_loaded(station, slot, gripper, home, cell, failed)
    local blade = native.layout.grippers[gripper]
    local axis = lookup.axis("flip", blade.robot).index
    local what = "%s slot %d: FLIP of %s with a wafer in front of it"
    if tryout.try("get", station.name, slot, cell, gripper)
      or fails(axis, cell, failed, slot, what:format(station.name, slot, blade.name))
      or has_none_at_home[blade.robot] then
      return
    end
    stand(home, cell)
    what = "home: FLIP of %s with a wafer of %s slot %d"
    has_none_at_home[blade.robot] = fails(axis, cell, failed, 0, what:format(blade.name, station.name, slot))
  end

  -- Plays GET and PUT from above, with the blade that was just turned over in front of the slot.
  local function try_turned(place, cell, failed)
    local name, slot, blade = place.station.name, place.slot, native.layout.grippers[place.gripper].name
    for _, command in ipairs { "get", "put" } do
      local problem = tryout.try(command, name, slot, cell, place.gripper)
      if problem then
        failed(slot, ("%s slot %d: %s with %s turned over"):format(name, slot, command:upper(), blade), reason_of(problem))
        return
      end
    end
  end

  -- Turns over in front of a slot, without a wafer and with one. Passive pads that are turned over hold
  -- none: FLIP refuses that.
  local function try_front(place, home, cell, failed)
    local station, slot, blade = place.station, place.slot, native.layout.grippers[place.gripper]
    local axis = lookup.axis("flip", blade.robot)
    local what = "%s slot %d: FLIP of %s in front of it"
    if not axis or is_slow[blade.robot] or not cell.stage(place.before)
      or fails(axis.index, cell, failed, slot, what:format(station.name, slot, blade.name)) or blade.grip == "passive" then
      return
    end
    try_turned(place, cell, failed)
    if cell.stage(place.before) then
      try_loaded(station, slot, place.gripper, home, cell, failed)
    end
  end

  -- Turns over a wafer in the clamp, with the robot where its PUT ends, and with the robot at home.
  local function try_clamp(place, home, cell, failed)
    local name, gripper = place.station.name, place.gripper
    local axis = native.layout.grippers[place.station.chuck].axis
    if not cell.stage(place.before, 0, name .. ": FLIP") or tryout.try("get", name, 1, cell, gripper)
      or tryout.try("put", name, 1, cell, gripper) then
      return
    end
    local what = "%s: FLIP of its wafer with %s in front of it"
    if not fails(axis, cell, failed, 1, what:format(name, native.layout.grippers[gripper].name)) then
      stand(home, cell)
      fails(axis, cell, failed, 1, name .. ": FLIP of its wafer with the robot at home")
    end
  end

  -- The first slot and the last one, for each robot that serves the station, and the axes in front of them.
  local function places_of(station, servers)
    local places = {}
    for slot = 1, station.slots, math.max(station.slots - 1, 1) do
      for _, gripper in ipairs(servers) do
        local before = tryout.before(station.name, slot, gripper)
        places[#places + 1] = { station = station, slot = slot, gripper = gripper, before = before }
      end
    end
    return places
  end

  -- Tries FLIP at a station: `servers` are the grippers that come to it, one of each robot.
  function room.look(station, servers, cell, failed)
    local home, places = native.axes(), places_of(station, servers)
    for _, place in ipairs(places) do
      try_front(place, home, cell, failed)
    end
    for _, place in ipairs(station.flipper and places or {}) do
      plan_turn(native.layout.grippers[station.chuck].axis)
      try_clamp(place, home, cell, failed)
    end
  end

  -- Tries FLIP at home without wafers, before all stations.
  function room.look_at_home(cell, failed)
    local home = native.axes()
    for index in ipairs(native.layout.robots) do
      local axis = lookup.axis("flip", index)
      if axis then
        local _, blades = lookup.on_robot(index)
        local what = "home: FLIP of " .. lookup.listed(blades)
        plan_turn(axis.index)
        is_slow[index] = not cell.stage(home, 0, what)
        has_none_at_home[index] = not is_slow[index] and fails(axis.index, cell, failed, 0, what)
      end
    end
  end

  return room
end
