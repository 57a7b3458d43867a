-- What the controller knows of its arm, and how a command goes: recorded, planned to its end before anything moves,
-- played, and refused while the arm may stand where a GET or PUT must not begin.

-- Kept, for a script may set globals of these names.
local coroutine, error, ipairs, math, pcall = coroutine, error, ipairs, math, pcall
local tostring, type = tostring, type

return function(native, lookup)
  -- inside   the target whose straight line the arm has entered and not left
  -- stopped  a command was cut short, and neither RECOVER nor HOME came since
  -- homed    nil: as the layout says
  local arm = { inside = nil, stopped = false, homed = nil }
  local running = false

  -- Runs a command: it is recorded with the script's line, its times and its error number. One that an exhausted
  -- limit or a STOP from outside ended past all Lua is still `running` when the next begins.
  function arm.run(text, action, ...)
    native.begin(text)
    arm.stopped = arm.stopped or running
    running = true
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

  ------------------------------------------------------------------------------------- planning and playing

  -- The segment of a request, its axes found for where the gripper shall be.
  local function segment_of(request)
    local to = request.to
    if to then
      request.axes = native.inverse(to.x, to.y, to.z, to.heading, to.gripper)
    end
    return request
  end

  -- What a pattern is answered while it is only planned: a segment runs to its end, a question has its own assumption.
  local function assumed(request)
    return request.assume == nil or request.assume
  end

  local function plan_through(pattern, target)
    local plan, step = {}, coroutine.wrap(pattern)
    local request = step(target)
    while type(request) == "table" do
      request.planned = request.assume == nil and native.plan(segment_of(request)) or nil
      plan[#plan + 1] = request
      request = step(assumed(request))
    end
    plan.became = request
    return plan
  end

  -- Plans all of a pattern from where the arm stands, without playing it; raises what is out of reach, and with
  -- `judged` a collision ahead. Returns the plan: the requests in order and, as `became`, what the pattern returned. It
  -- can be played until the next one is made.
  function arm.rehearse(pattern, target, judged)
    native.rehearse(true, judged)
    local ok, result = pcall(plan_through, pattern, target)
    native.rehearse(false)
    if not ok then
      error(result, 0)
    end
    return result
  end

  -- Plays a segment or asks a question. `target.watched`: a wafer that is lost on the way is an error after the segment.
  -- Whether a wafer is on a gripper's pads, whatever its sensor says, the cell knows; a controller would look.
  local function perform(request, target)
    if request.is_on then
      return native.sensor(request.is_on)
    elseif request.is_loaded then
      return native.held(request.is_loaded) ~= nil
    end
    arm.inside = request.enters or arm.inside
    local ended, lost = native.play(request.planned or segment_of(request))
    if request.leaves then
      arm.inside = nil
    end
    if lost and target.watched then
      native.fail("WAFER_LOST_ON_WAY", lookup.quote(native.layout.grippers[lost].name) .. " lost its vacuum")
    end
    return ended
  end

  -- The answer at this place of the plan was not the assumed one: plans and plays anew from there.
  local function go_on(pattern, target, plan, place, answer)
    local step = coroutine.wrap(pattern)
    step(target)
    for before = 1, place - 1 do
      step(assumed(plan[before]))
    end
    local request = step(answer)
    while type(request) == "table" do
      request = step(perform(request, target))
    end
    return request
  end

  -- Plays what was planned, as long as the answers are the assumed ones; returns what became of it.
  function arm.drive(pattern, target, plan)
    for place, request in ipairs(plan) do
      local answer = perform(request, target)
      if answer ~= assumed(request) then
        return go_on(pattern, target, plan, place, answer)
      end
    end
    return plan.became
  end

  function arm.play(pattern, target)
    return arm.drive(pattern, target, arm.rehearse(pattern, target, true))
  end

  return arm
end
