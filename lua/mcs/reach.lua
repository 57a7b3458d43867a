-- Checks that GET and PUT can be planned at the slots, from home. A run checks its layout so before
-- anything moves, and `waferhand layout` checks each layout. `waferhand layout` plays them as well.

-- Local copies: a script may set globals of these names.
local ipairs, math, tostring, type = ipairs, math, tostring, type

return function(native, tryout, flip_room, stations, own)
  local rehearse, rehearse_map = tryout.rehearse, tryout.rehearse_map
  local reach = {}

  -- In an upright stack only the height differs, so its ends stand for all slots. In a tilted one a
  -- slot between them may be nearer to the robot than both.
  local function slots_of(station)
    if not station.taught then
      return {}
    elseif station.upright then
      return station.slots > 1 and { 1, station.slots } or { 1 }
    end
    local slots = {}
    for slot = 1, station.slots do
      slots[slot] = slot
    end
    return slots
  end

  local function reason_of(problem)
    return type(problem) == "table" and problem.text or tostring(problem)
  end

  -- The grippers that come to a station, one of each robot that serves it.
  local function servers(station)
    local list = {}
    for _, gripper in ipairs(station.by) do
      list[#list + 1] = gripper or nil
    end
    return #list > 0 and list or { station.effector }
  end

  -- GET and PUT at a slot: returns the word of the refused one and why, or nil, nil and the axes before the slot.
  local function try_slot(station, slot, gripper)
    native.reach(station.index, slot, native.layout.grippers[gripper].robot)
    return rehearse(station.name, slot, gripper)
  end

  -- The slots of a tilted stack that can be nearest to theta's axis, but for its ends: from the first to the last of them.
  -- The square of R is a parabola over the slots, and each point of the way in has its own lowest slot.
  local function nearest_slots(station, robot, at_first, at_last)
    local first, count = stations.place(station, 1, robot, {}), station.slots - 1
    local last, r = stations.place(station, station.slots, robot, {}), native.layout.robots[robot].first + 1
    local dx, dy = (last.x - first.x) / count, (last.y - first.y) / count
    local square, along = dx * dx + dy * dy, first.dir_x * dx + first.dir_y * dy
    local in_front = ((at_last[r] * at_last[r] - at_first[r] * at_first[r]) / count - count * square) / 2
    local inside = in_front + station.retract * along
    local low, high = 1 - math.max(in_front, inside) / square, 1 - math.min(in_front, inside) / square
    return math.max(2, low - 1), math.min(count, high + 1)
  end

  -- True if the ends of a tilted stack and the slots nearest to theta's axis show that all of it is in reach: all axes
  -- but R go one way along it. It holds for our own GET and PUT, a robot of theta, R, Z and yaw, and ends on one turn.
  local function do_some_show_all(station, gripper)
    local number = native.layout.grippers[gripper].robot
    local robot = native.layout.robots[number]
    if not station.taught or station.upright or station.slots < 4 or not robot.is_usual or not own.has_shipped() then
      return false
    end
    local word, _, first = try_slot(station, 1, gripper)
    local word_last, _, last = try_slot(station, station.slots, gripper)
    if word or word_last then
      return false
    end
    for _, axis in ipairs(robot.axes) do
      if axis.turns and math.abs(last[axis.index] - first[axis.index]) > 1 then
        return false
      end
    end
    local low, high = nearest_slots(station, number, first, last)
    for slot = 2, station.slots - 1 do
      if slot >= low and slot <= high and try_slot(station, slot, gripper) then
        return false
      end
    end
    return true
  end

  -- Calls found(slot, word, reason, robot) for each slot at which a command of that word is refused to that robot: then
  -- a run refuses the whole layout.
  function reach.check(station, found)
    for _, gripper in ipairs(servers(station)) do
      for _, slot in ipairs(do_some_show_all(station, gripper) and {} or slots_of(station)) do
        local word, problem = try_slot(station, slot, gripper)
        if problem then
          found(slot, word, reason_of(problem), native.layout.grippers[gripper].robot)
        end
      end
    end
    native.reach()
  end

  -- The place of a station that is not taught is a guess, and none of the checks here looks at it. Calls missed(slot, word,
  -- reason, gripper's name) if no robot that serves it reaches its first slot there.
  function reach.check_untaught(station, missed)
    local first, problem
    for _, gripper in ipairs(not station.taught and servers(station) or {}) do
      station.taught = true
      local word, refused = rehearse(station.name, 1, gripper)
      station.taught = false
      if not refused then
        return
      end
      first, problem = first or native.layout.grippers[gripper].name, problem or { word, reason_of(refused) }
    end
    if problem then
      missed(1, problem[1], problem[2] .. "; it is not taught, so no run is refused for this", first)
    end
  end

  -- Earlier commands may have wound theta up, so that a slot is a turn or more away from its theta from
  -- home. `found` as above, at most once for a slot.
  local function check_wound(station, slot, found)
    local _, problem, axes = rehearse(station.name, slot)
    local robot = native.layout.grippers[station.effector].robot
    local theta = axes and axes[native.layout.robots[robot].first]
    for _, wound in ipairs(problem and {} or native.windings(theta, robot)) do
      native.stand(wound, robot)
      local word, refused = rehearse(station.name, slot)
      native.stand(nil, robot)
      if refused then
        local from = "coming from theta %.5g deg, where earlier commands can lead it, %s"
        found(slot, word, from:format(math.deg(wound), reason_of(refused)))
        return
      end
    end
  end

  -- Other refusals in the course of a run: a MAP at a station with `check_map`, a PUT without room to go aside
  -- by its beams' result, and the checked ways with theta wound up.
  function reach.check_later(station, found)
    for _, slot in ipairs(slots_of(station)) do
      check_wound(station, slot, found)
      for _, gripper in ipairs(servers(station)) do
        local centres = station.centres[native.layout.grippers[gripper].robot]
        local cannot = centres and tryout.rehearse_centring(station.name, slot, gripper)
        if cannot then
          found(slot, "PUT", reason_of(cannot))
        end
      end
    end
    local problem = station.taught and station.check_map and rehearse_map(station.name)
    if problem then
      found(1, "MAP", reason_of(problem))
    end
  end

  -- The limits of a GET's corrections, as parts of the layout's: corners, and the middles between them.
  local ENDS = { { -1, -1 }, { -1, 0 }, { -1, 1 }, { 0, -1 }, { 0, 1 }, { 1, -1 }, { 1, 0 }, { 1, 1 } }

  -- The error of the first limit, scaled by `part`, that is refused; or nil.
  local function refused_aside(station, part, retract)
    local most = native.layout.corrections
    for _, way in ipairs(ENDS) do
      local dx, dy = part * way[1] * most.dx, part * way[2] * most.dy
      local problem = tryout.rehearse_aside(station.name, 1, dx, dy, retract)
      if problem then
        return problem
      end
    end
  end

  -- The largest number from 0 to `most` for which `does` is true, to a thousandth of `most`.
  local function largest(most, does)
    local good, bad = 0, most
    for _ = 1, 10 do
      local middle = (good + bad) / 2
      if does(middle) then
        good = middle
      else
        bad = middle
      end
    end
    return good
  end

  -- After ALIGN a GET goes to the wafer's found place, as far aside as `corrections` allow. Calls missed(slot, word,
  -- reason, name) if there is no room for that.
  function reach.check_corrections(station, missed)
    local gripper, most = native.layout.grippers[station.effector], native.layout.corrections
    if not station.sensor or not station.taught or gripper.grip == "edge" or refused_aside(station, 0) then
      return
    end
    local problem = refused_aside(station, 1)
    if problem then
      local part = largest(1, function(some)
        return not refused_aside(station, some)
      end)
      local way = largest(station.retract, function(some)
        return not refused_aside(station, 1, some)
      end)
      local text = "what ALIGN finds is made good up to %.3g mm along x and %.3g along y alone, not to `corrections` "
        .. "of %.10g and %.10g: %s%s"
      local advice = way >= 1 and ("; retract = %.0f leaves room"):format(math.floor(way)) or ""
      missed(1, "GET", text:format(part * most.dx, part * most.dy, most.dx, most.dy, reason_of(problem), advice),
        gripper.name)
    end
  end

  local function check_blade(station, gripper, name, missed)
    for _, slot in ipairs(slots_of(station)) do
      local word, problem = try_slot(station, slot, gripper)
      if problem then
        missed(slot, word, reason_of(problem), name)
        break
      end
    end
    native.reach()
  end

  -- Calls missed(slot, word, reason, name) for each blade that is not the station's effector, with the first
  -- slot at which that blade is refused: a run refuses it when a command names the blade.
  function reach.check_blades(station, missed)
    for index, gripper in ipairs(native.layout.grippers) do
      if gripper.on_robot and index ~= station.effector and station.by[gripper.robot] then
        check_blade(station, index, gripper.name, missed)
      end
    end
  end

  -- The slots played at a station, in order: they cover all neighbours above and below a slot, and the
  -- effects of earlier commands. A wafer goes to a chuck again only after it was elsewhere.
  local function sequences_of(station)
    if station.slots == 1 then
      return { station.chuck and { 1 } or { 1, 1 } }
    end
    return { { 1, 1, 2 }, { 2, 1 }, { station.slots } }
  end

  -- True if no slot of the station is refused to this gripper.
  local function is_reached(station, gripper)
    for _, slot in ipairs(slots_of(station)) do
      if tryout.rehearse(station.name, slot, gripper) then
        return false
      end
    end
    return true
  end

  -- Calls failed(slot, word, reason) for the first GET or PUT that fails when it is played; `cell` as in
  -- lua/mcs/tryout.lua. With `gripper`, a blade that is not the station's effector, if that reaches it.
  function reach.play(station, cell, failed, gripper)
    for _, slots in ipairs((not gripper or is_reached(station, gripper)) and sequences_of(station) or {}) do
      local slot, word, problem = tryout.try_out(station.name, slots, cell, gripper)
      if slot == false then
        return
      elseif slot then
        failed(slot, word, reason_of(problem))
        return
      end
    end
  end

  -- Like reach.play, for a PUT of a wafer that another station's GET has taken; from a chuck it is then
  -- taken again.
  function reach.play_carrying(from, station, cell, failed)
    for slot = 1, math.min(station.slots, 2) do
      local word, problem = tryout.try_carrying(from.name, station.name, slot, cell, station.chuck)
      if word then
        failed(slot, word .. " of a wafer from " .. from.name, reason_of(problem))
        return
      end
    end
  end

  -- Calls failed(slot, what, reason) for each FLIP that has no room in front of the station or in its clamp; without a
  -- station for FLIPs at home, which come first. Slot 0 means no slot.
  function reach.play_flips(station, cell, failed)
    if station then
      flip_room.look(station, servers(station), cell, failed)
    else
      flip_room.look_at_home(cell, failed)
    end
  end

  return reach
end
