-- Vacuum: a valve, and a sensor that is on while a wafer closes the pads.

return function(steps)
  local OPEN, CLOSED = steps.OPEN, steps.CLOSED
  local switch, holds, is_on, is_loaded = steps.switch, steps.holds, steps.is_on, steps.is_loaded
  local vacuum = {}

  function vacuum.ready() end

  local function close(target)
    switch(target.gripper, CLOSED)
  end

  -- Below a slot no wafer is near, so a sensor that comes on there is "early".
  local function take_from_slot(target)
    local early = target.plane.sweep(target, function(is_below)
      switch(target.gripper, OPEN)
      if is_below and target.asks and is_on(target.gripper, false) then
        close(target)
        return "early"
      end
    end)
    if early then
      return early
    elseif holds(target, target.gripper) then
      target.plane.keep(target)
      return "taken"
    end
    local found = is_loaded(target.gripper) and "late" or "missing"
    target.plane.fail(target, close)
    return found
  end

  -- A chuck that has not lost its wafer holds it again.
  local function take_from_chuck(target)
    local chuck_held = is_on(target.chuck, true)
    target.plane.reach(target)
    steps.hand_over(target, target.chuck, target.gripper)
    if holds(target, target.gripper) then
      target.plane.rise(target)
      return "taken"
    end
    local found = is_loaded(target.gripper) and "late" or "missing"
    steps.switch_both(target.gripper, CLOSED, target.chuck, chuck_held and OPEN or CLOSED)
    target.plane.sink(target)
    return found
  end

  function vacuum.take(target)
    return (target.chuck and take_from_chuck or take_from_slot)(target)
  end

  -- A hanging wafer is let go of once the pads are vented.
  function vacuum.give(target)
    local became = "kept"
    target.plane.lower(target)
    if target.chuck then
      steps.hand_over(target, target.gripper, target.chuck)
      became = steps.judge_chuck(target)
    else
      close(target)
    end
    if became == "kept" and target.vent and target.vent > 0 then
      steps.dwell(target.vent)
    end
    target.plane.withdraw(target)
    return became
  end

  function vacuum.settle(target, height)
    target.plane.set_back(target, height, close)
  end

  -- Pins have come up to the wafer, whose back is in the chuck's plane: they take it and lift it.
  function vacuum.raise(target)
    steps.shift { [target.axis] = 0 }
    if target.chuck_holds then
      steps.hand_over(target, target.chuck, target.pins)
    else
      switch(target.pins, OPEN)
    end
    if holds(target, target.pins) then
      steps.shift { [target.axis] = target.high }
      return "taken"
    end
    local found = is_loaded(target.pins) and "late" or "missed"
    if target.chuck_holds then
      steps.switch_both(target.chuck, OPEN, target.pins, CLOSED)
      steps.shift { [target.axis] = target.low }
      return found
    end
    switch(target.pins, CLOSED)
    steps.shift { [target.axis] = target.high }
    return "empty"
  end

  function vacuum.lower(target)
    local became = "empty"
    if target.pins_hold then
      steps.shift { [target.axis] = 0 }
      steps.hand_over(target, target.pins, target.chuck)
      became = steps.judge_chuck(target)
    end
    steps.shift { [target.axis] = target.low }
    return became
  end

  return vacuum
end
