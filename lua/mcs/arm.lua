-- What the controller knows of its arm, and how a command goes: recorded, planned to its end before anything moves,
-- played, and refused while the arm may stand where a GET or PUT must not begin.

-- Kept, for a script may set globals of these names.
local coroutine, error, math, pcall, tostring, type = coroutine, error, math, pcall, tostring, type

return function(native, lookup)
  -- inside   the target whose straight line the arm has entered and not left
  -- stopped  a command was cut short, and neither RECOVER nor HOME came since
  -- homed    nil: as the layout says
  local arm = { inside = nil, stopped = false, homed = nil }
  local running, rehearsing = false, false

  -- Runs a command: it is recorded with the script's line, its times and its error number. One that an exhausted
  -- limit or a STOP from outside ended past all Lua is still `running` when the next begins.
  function arm.run(text, action, ...)
    native.begin(text)
    arm.stopped = arm.stopped or running
    running, rehearsing = true, false
    local ok, result = pcall(action, ...)
    running = false
    if ok then
      native.finish()
      return result
    end
    local numbered = type(result) == "table" and math.type(result.number) == "integer" and type(result.text) == "string"
    local number = numbered and result.number or lookup.errors.BAD_ARGUMENT.number
    arm.stopped = arm.stopped or number == lookup.errors.STOPPED.number
    native.finish(number, numbered and result.text or tostring(result))
    error(result, 0)
  end

  -- Before a command that counts on where the arm stands.
  function arm.check_homed()
    if arm.homed == nil then
      arm.homed = native.layout.homed
    end
    if not arm.homed then
      native.fail("NOT_HOMED", "HOME comes first")
    end
  end

  -- Before one that goes into a station.
  function arm.check_free()
    arm.check_homed()
    if arm.inside then
      native.fail("STOPPED", ("the arm stands in %s: RECOVER or HOME comes first"):format(arm.inside.station))
    elseif arm.stopped then
      native.fail("STOPPED", "an earlier one was: RECOVER or HOME comes first")
    end
  end

  -- RECOVER and HOME have brought the arm out.
  function arm.set_free()
    arm.inside, arm.stopped = nil, false
  end

  -------------------------------------------------------------------------------------------- the sensors

  -- In a rehearsal nothing is on any gripper.
  function arm.is_on(gripper)
    return not rehearsing and native.sensor(gripper)
  end

  -- A wafer is on its pads, whatever the sensor says: the cell knows, a controller would look.
  function arm.is_loaded(gripper)
    return not rehearsing and native.held(gripper) ~= nil
  end

  ------------------------------------------------------------------------------------------------ playing

  local function skip_through(pattern, target)
    local step = coroutine.wrap(pattern)
    local segment = step(target)
    while type(segment) == "table" do
      segment = step(native.play(segment))
    end
  end

  -- Plans all of a pattern from where the arm stands, without playing it; raises what is out of reach, and with
  -- `judged` a collision ahead.
  function arm.rehearse(pattern, target, judged)
    native.rehearse(true, judged)
    rehearsing = true
    local ok, problem = pcall(skip_through, pattern, target)
    rehearsing = false
    native.rehearse(false)
    if not ok then
      error(problem, 0)
    end
  end

  -- Plays a pattern segment by segment and returns what it does. `target.watched`: a wafer that is lost on the way
  -- ends it after that segment.
  function arm.drive(pattern, target)
    local step = coroutine.wrap(pattern)
    local segment = step(target)
    while type(segment) == "table" do
      arm.inside = segment.enters or arm.inside
      local ended, lost = native.play(segment)
      if segment.leaves then
        arm.inside = nil
      end
      if lost and target.watched then
        native.fail("WAFER_LOST_ON_WAY", lookup.quote(native.layout.grippers[lost].name) .. " lost its vacuum")
      end
      segment = step(ended)
    end
    return segment
  end

  function arm.play(pattern, target)
    arm.rehearse(pattern, target, true)
    return arm.drive(pattern, target)
  end

  return arm
end
