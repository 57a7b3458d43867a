-- GET, PUT and MAP for a survey: planned without being played, or played without the checks before them.

-- Local copies: a script may set globals of these names.
local ipairs = ipairs

return function(native, patterns, lookup, player, targets, carrying, attempt)
  -- `attempt` is pcall, but for faults of a file of patterns: these are no verdict on the cell.
  local tryout = {}

  local function plan(word, station, slot, gripper)
    gripper = gripper or lookup.station(station).effector
    return player.rehearse(patterns[word], targets.at(word, station, slot, nil, gripper))
  end

  -- The axes in front of the slot that a plan goes to; those of now if it goes to none, as one's own may.
  local function before_slot(planned)
    for _, request in ipairs(planned) do
      if request.to then
        return request.axes
      end
    end
    return native.axes()
  end

  -- Plans GET and PUT at a slot from where the arm stands, without playing them, with the station's effector
  -- or another gripper (an index). Returns the word of the refused one and the error, or nil, nil and the axes
  -- before the slot.
  function tryout.rehearse(station, slot, gripper)
    local can_get, got = attempt(plan, "get", station, slot, gripper)
    if not can_get then
      return "GET", got
    end
    local can_put, put = attempt(plan, "put", station, slot, gripper)
    if not can_put then
      return "PUT", put
    end
    return nil, nil, before_slot(got)
  end

  -- Plans a PUT with this gripper that goes aside by its beams' result. Returns the error if it is refused, or nil.
  function tryout.rehearse_centring(station, slot, gripper)
    local can, problem = attempt(function()
      player.rehearse(patterns.put, targets.at("put", station, slot, nil, gripper, ""))
    end)
    return not can and problem or nil
  end

  -- Plans a GET that goes aside by a possible ALIGN result. Its way in is as long as `retract`, if that is given.
  -- Returns the error if it is refused, or nil.
  function tryout.rehearse_aside(station, slot, dx, dy, retract)
    local can, problem = attempt(function()
      local options = { dx = dx, dy = dy, retract = retract }
      player.rehearse(patterns.get, targets.at("get", station, slot, options, lookup.station(station).effector, ""))
    end)
    return not can and problem or nil
  end

  ------------------------------------------------------------------------------------------------ trying out

  -- Plays a command like a run, but without the sensors' check for wafers before it; returns the error. Here
  -- and below `cell` is the cell in which lib/survey/survey.c places it.
  function tryout.try(word, station, slot, cell, gripper)
    local good, problem = attempt(function()
      gripper = gripper or lookup.station(station).effector
      local target = targets.at(word, station, slot, nil, gripper)
      carrying.judge[word](target, player.drive(player.rehearse(patterns[word], target)))
      if word == "get" and not native.held(target.gripper) then
        carrying.judge.get(target, "missing")
      elseif word == "put" and native.held(target.gripper) then
        carrying.judge.put(target, "stuck")
      elseif word == "put" and target.chuck and not native.held(target.chuck) then
        carrying.judge.put(target, "lost")
      end
    end)
    return cell.complaint() or not good and problem or nil
  end

  -- The axes in front of the slot that a GET goes to, from where the arm stands.
  function tryout.before(station, slot, gripper)
    return before_slot(plan("get", station, slot, gripper))
  end

  -- GET and PUT at these slots, one after another in one cell, from in front of the first one; `gripper` as in
  -- tryout.rehearse. Returns the slot at which a command fails, its word and the error; or nil; or false if
  -- the cell is not possible.
  function tryout.try_out(station, slots, cell, gripper)
    if not cell.stage(tryout.before(station, slots[1], gripper)) then
      return false
    end
    for step = 1, 2 * #slots do
      local slot, word = slots[(step + 1) // 2], step % 2 == 1 and "get" or "put"
      local problem = tryout.try(word, station, slot, cell, gripper)
      if problem then
        return slot, word:upper() .. (step > 2 and " after others" or ""), problem
      end
    end
    return nil
  end

  -- Plays a GET at `from`, then a PUT at an empty slot: the wafer's place on the blade comes from the
  -- other station. With `again` a GET follows. Returns the word of the failed one and the error; or nil.
  function tryout.try_carrying(from, station, slot, cell, again)
    cell.stage(tryout.before(from, 1), slot)
    if tryout.try("get", from, 1, cell) then
      return nil
    end
    cell.move(before_slot(plan("put", station, slot)))
    local stand = { segment = { dwell = 4 * native.layout.slice } }
    player.drive(player.rehearse(patterns.single, stand))
    cell.begin()
    local word, problem = "PUT", tryout.try("put", station, slot, cell)
    if again and not problem then
      word, problem = "GET", tryout.try("get", station, slot, cell)
    end
    return problem and word, problem
  end

  -- Plans a MAP: returns the error, or nil.
  function tryout.rehearse_map(station)
    local can_map, problem = attempt(function()
      player.rehearse(patterns.map, (carrying.map_target(station, nil, lookup.station(station).effector)))
    end)
    return not can_map and problem or nil
  end

  return tryout
end
