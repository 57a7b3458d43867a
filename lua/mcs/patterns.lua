-- Commands as patterns: the order in which the arm moves and the valves switch. A pattern is made of steps
-- (lua/mcs/steps.lua), of the target's grip and of its plane, the side from which the blade comes:
--   grip.ready(target, loaded)    before the way in; nil, or why the command ends there
--   grip.take(target)             from where an empty blade has entered to where it may leave: "taken", or why not
--   grip.give(target)             from where a loaded blade has entered to where it may leave: "kept", or why not
--   grip.settle(target, height)   for RECOVER: leaves a wafer that may be on the blade in the slot
-- A pattern returns the result for the wafer, a word, from the sensors. lua/mcs/own_patterns.lua has those of users.

local yield = coroutine.yield

return function(steps)
  local patterns = {}
  local approach, enter, leave, pause = steps.approach, steps.enter, steps.leave, steps.pause

  -- GET moves in with an empty blade, takes the wafer, and moves out. From below it opens the valve, moves up through the
  -- slot, and out above; from a chuck, and with an edge grip, it stops in the wafer's plane for that. Without a wafer it goes
  -- back, repeats its stroke `retries` times, and moves out: "missing", or "late" if the vacuum did not come though a wafer is
  -- there; "early" if the sensor was on below the slot. With an edge grip else "jammed", "unmoved", "unclosed", "unopened" or
  -- "disagree". Without a wafer the phase "up" is not held.
  function patterns.get(target)
    local found = target.grip.ready(target, false)
    if found then
      return found
    end
    approach(target, target.plane.enter(target, false))
    enter(target)
    pause(target, "extended")
    for _ = 0, target.retries do
      found = target.grip.take(target)
      if found ~= "missing" and found ~= "late" then
        break
      end
    end
    if found == "taken" then
      pause(target, "up")
    end
    leave(target)
    return found
  end

  -- Moves out after a PUT with the result `became`.
  local function leave_empty(target, became)
    if became == "kept" then
      pause(target, "up")
    end
    leave(target)
    if became == "kept" and not target.chuck and target.asks and steps.is_on(target.gripper, false) then
      return "stuck"
    end
    return became
  end

  -- PUT moves in above the slot, down to `release`, lets go, and moves out below the wafer. Results: "kept"; "lost" if
  -- the chuck has not taken it over; "loose" if the chuck's vacuum did not come though the wafer lies on it; "stuck" if the
  -- gripper's sensor is still on after it has left a plain slot. With an edge grip "unmoved" or "unopened" if its plunger
  -- did not go back; with a wafer in it the blade moves up and out again. With `centre` the blade first goes aside by the
  -- beams' result. Without a result it moves out again with the wafer: "uncentred".
  function patterns.put(target)
    target.grip.ready(target, true)
    if target.stage_home then
      steps.shift(target.stage_home)
    end
    approach(target, target.plane.enter(target, true))
    enter(target)
    if not steps.centre(target) then
      leave(target)
      return "uncentred"
    end
    pause(target, "extended")
    return leave_empty(target, target.grip.give(target))
  end

  -- SWAP is a GET with one gripper and, if that took the wafer, a PUT with the other.
  function patterns.swap(target)
    local found = patterns.get(target.get)
    return found == "taken" and patterns.put(target.put) or found
  end

  -- Moves to where a GET enters, or a PUT if the gripper is loaded.
  function patterns.ready(target)
    approach(target, target.plane.enter(target, target.loaded))
  end

  -- Moves from below the stack to above it, in front of the station.
  function patterns.map(target)
    approach(target, -target.margin)
    local line = steps.upward(target.place, target.height + 2 * target.margin)
    yield { line = line, speed = target.map_speed, target = target, where = "in front of" }
  end

  -- Moves out of the station from the place where the arm stopped: with a wafer up to where a GET leaves,
  -- else down to where a PUT leaves, then straight out. `stands` is the gripper's place.
  function patterns.recover(target)
    local height, inward = steps.beside(target.place, target.stands)
    target.plane.retreat(target, height)
    local inside = inward + target.retract
    leave(target, inside > 0 and inside or 0)
  end

  -- Pins take the wafer off a chuck and lift it: "taken"; "empty" if there is none. From a chuck that held one: "missed", or
  -- "late" if the vacuum did not come though it lies there. The chuck then holds it again, and the pins are down.
  function patterns.raise(target)
    return target.grip.raise(target)
  end

  -- The pins bring their wafer down: "kept"; "empty" if they have none; "lost" if the chuck has not taken it over;
  -- "loose" if the chuck's vacuum did not come though it lies there.
  function patterns.lower(target)
    return target.grip.lower(target)
  end

  -- Pins hold the wafer while the stage brings the chuck to `aside`. With the wafer on the chuck it goes `home`.
  function patterns.grip_again(target)
    local found = patterns.raise(target)
    if found ~= "taken" then
      return found
    end
    steps.shift(target.aside)
    target.pins_hold = true
    local became = patterns.lower(target)
    steps.shift(target.home)
    return became
  end

  -- Plays a single segment.
  function patterns.single(target)
    yield(target.segment)
  end

  -- Waits for a switch: true if it came in time.
  function patterns.arrive(target)
    return yield(target.segment)
  end

  return patterns
end
