-- An edge grip: a plunger that pushes the wafer against rests. The target's `edge` has { travel, the longest time of
-- a sound plunger, slice, vent }.

local yield = coroutine.yield

return function(steps)
  local OPEN, CLOSED = steps.OPEN, steps.CLOSED
  local switch, is_loaded = steps.switch, steps.is_loaded
  local edge = {}

  -- The waiting time for a sound plunger, s: its own time plus two slices, since one slice gives the order.
  local function patience(target)
    return target.edge.travel + 2 * target.edge.slice
  end

  local function ask(target, assume, note)
    return yield { grip = target.gripper, assume = assume, note = note }
  end

  -- Waits until the plunger has the state `wanted`; at least as long as a sound plunger needs.
  local function await(target, wanted)
    local is_patient = target.timeout > patience(target)
    steps.dwell(patience(target))
    local does = ask(target, wanted, not is_patient and target or nil)
    if does ~= wanted and is_patient then
      steps.dwell(target.timeout - patience(target))
      does = ask(target, wanted, target)
    end
    return does
  end

  -- Sends the plunger back. Returns nil, or why it is not open: "unopened" on its way, "unmoved".
  local function open(target)
    switch(target.gripper, CLOSED)
    local does = await(target, "open")
    return does ~= "open" and (does == "opening" and "unopened" or "unmoved") or nil
  end

  -- By the plunger's state: the result when it does not hold the wafer.
  local WHY = { jammed = "jammed", missed = "missing", still = "unmoved", open = "unmoved", opening = "unmoved",
                closing = "unclosed", closed = "disagree" }

  -- Closes the plunger. Returns "taken", or why it does not hold the wafer.
  local function close(target)
    local gripper = target.gripper
    switch(gripper, OPEN)
    local on = steps.await(gripper, patience(target))
    if not on and target.timeout > patience(target) and ask(target, "closed") == "closing" then
      on = steps.await(gripper, target.timeout - patience(target))
    end
    -- A sensor that is on before the plunger has arrived does not show a wafer.
    if on and ask(target, "closed") == "closed" and is_loaded(gripper, true) then
      return "taken"
    end
    local does = ask(target, "closed", target)
    return on and does ~= "jammed" and "disagree" or WHY[does]
  end

  -- The chuck lets go before the plunger closes.
  local function close_over_chuck(target)
    if target.chuck then
      switch(target.chuck, CLOSED)
      if target.edge.vent > 0 then
        steps.dwell(target.edge.vent)
      end
    end
    return close(target)
  end

  -- Before a GET the plunger must be open.
  function edge.ready(target, loaded)
    if not loaded and ask(target, "open") ~= "open" then
      return open(target)
    end
  end

  -- In the wafer's plane rests and plunger are beside its rim; a wafer that is not gripped stays there.
  function edge.take(target)
    target.plane.reach(target)
    local found = close_over_chuck(target)
    if found == "taken" then
      target.plane.rise(target)
    else
      open(target)
      target.plane.sink(target)
    end
    return found
  end

  local function let_go(target)
    if target.chuck then
      switch(target.chuck, OPEN)
    end
    local shut = open(target)
    if shut and is_loaded(target.gripper) then -- it has not let go, and must not do so on the way
      switch(target.gripper, OPEN)
    end
    if shut or not target.chuck then
      return shut or "kept"
    end
    return steps.judge_chuck(target)
  end

  function edge.give(target)
    target.plane.lower(target)
    local became = let_go(target)
    target.plane.withdraw(target, function()
      return is_loaded(target.gripper)
    end)
    return became
  end

  function edge.settle(target, height)
    target.plane.set_back(target, height, open)
  end

  return edge
end
