-- Passive pads have no valve: a wafer is on them after they have lifted it off its support, and off them when a
-- support has it. Turned over they hold nothing, so they come from below.

local yield = coroutine.yield

return function(steps)
  local OPEN, CLOSED = steps.OPEN, steps.CLOSED
  local switch, stroke, holds, is_loaded = steps.switch, steps.stroke, steps.holds, steps.is_loaded
  local passive = {}

  local function reckon(gripper, wafer)
    yield { carries = gripper, wafer = wafer }
  end

  -- The chuck lets go of its wafer; true if it held one.
  local function free_chuck(target)
    local held = steps.is_on(target.chuck, true)
    switch(target.chuck, CLOSED)
    if target.vent > 0 then
      steps.dwell(target.vent)
    end
    return held
  end

  -- The chuck takes hold of the wafer set down on it.
  local function give_to_chuck(target)
    switch(target.chuck, OPEN)
    return steps.judge_chuck(target)
  end

  function passive.ready(target, loaded)
    if loaded then
      reckon(target.gripper, true)
    end
  end

  function passive.take(target)
    local chuck_held = target.chuck and free_chuck(target)
    reckon(target.gripper, true)
    stroke(target, target.stroke)
    if holds(target, target.gripper) then
      return "taken"
    end
    local found = is_loaded(target.gripper) and "late" or "missing"
    stroke(target, -target.stroke)
    reckon(target.gripper, false)
    if chuck_held then
      switch(target.chuck, OPEN)
    end
    return found
  end

  -- If no support takes the wafer over, it comes out again as it went in.
  function passive.give(target)
    stroke(target, -target.stroke, target.gripper)
    if target.asks and steps.is_on(target.gripper, false) then
      local found = is_loaded(target.gripper, true) and "stuck" or "feigned"
      stroke(target, target.stroke)
      return found
    end
    reckon(target.gripper, false)
    return target.chuck and give_to_chuck(target) or "kept"
  end

  function passive.settle(target, height)
    stroke(target, target.offset - target.stroke - height)
  end

  -- Pins move up with the wafer on the chuck, or down to the chuck.
  function passive.raise(target)
    steps.shift { [target.axis] = 0 }
    if target.chuck_holds then
      free_chuck(target)
    end
    reckon(target.pins, true)
    steps.shift { [target.axis] = target.high }
    if holds(target, target.pins) then
      return "taken"
    end
    local found = is_loaded(target.pins) and "late" or "missed"
    reckon(target.pins, false)
    if not target.chuck_holds then
      return "empty"
    end
    steps.shift { [target.axis] = target.low }
    switch(target.chuck, OPEN)
    return found
  end

  function passive.lower(target)
    steps.shift({ [target.axis] = target.low }, target.pins)
    reckon(target.pins, false)
    return target.pins_hold and give_to_chuck(target) or "empty"
  end

  return passive
end
