-- Patterns of one's own: a GET that comes from above slowly and waits for the vacuum sensor for up to 3 s, and a look into a slot.

-- The last millimetres go at this speed, mm/s.
local SLOWLY = { speed = 2 }

-- From below as shipped. From above the blade stops 1 mm over the wafer, and touches it slowly.
local function get(target, steps, shipped)
  if target.side == "below" or target.grip ~= "vacuum" or target.chuck then
    return shipped.get(target)
  end
  steps.approach(target, target.enters_empty)
  steps.enter(target)
  steps.pause(target, "extended")
  steps.stroke(target, 1 - target.offset)
  steps.stroke(target, -1, SLOWLY)
  steps.open(target, "gripper")
  local on, found = steps.await(target, "gripper", 3), "taken"
  if not on then
    found = steps.is_loaded(target, "gripper") and "late" or "missing" -- asked before the valve lets go
    steps.close(target, "gripper")
  end
  steps.stroke(target, 1, SLOWLY)
  steps.stroke(target, target.offset - 1)
  if on then
    steps.pause(target, "up")
  end
  steps.leave(target)
  return found
end

-- A camera on the wrist looks at the slot: the blade stands before it, half as high as the slots are apart.
local function look(target, steps)
  steps.approach(target, target.enters_loaded)
  steps.wait(params.exposure or 0.25)
end

return { get = get, added = { look = look } }
