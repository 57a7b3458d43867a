-- What the controller knows of its arm, and how a command goes: recorded, planned to its end before anything
-- moves, played, held in a phase if it asks for that, and refused while the arm may stand where it must not
-- begin.

-- Kept, for a script may set globals of these names.
local coroutine, error, ipairs, math, pairs, pcall = coroutine, error, ipairs, math, pairs, pcall
local tostring, type = tostring, type

return function(native, lookup, centring)
  -- inside   the target whose straight line the arm has entered and not left
  -- since    the command that entered it
  -- stopped  a command that was cut short, and neither RECOVER nor HOME came since; else nil
  -- homed    nil: as the layout says
  local arm = { inside = nil, since = nil, stopped = nil, homed = nil }
  local running = nil
  -- The plan of a command that stands still in a phase, and its text; else nil. The host knows of it, too, and
  -- may give it up.
  local held = nil

  -- As after a STOP: the arm has to be brought out.
  local function give_up()
    if held then
      arm.stopped = arm.stopped or held.text
      held = nil
      native.release()
    end
  end

  -- The plan that is held, if one is.
  local function find_held()
    if held and not native.is_held() then
      give_up()
    end
    return held
  end

  -- Runs a command: it is recorded with the script's line, its times and its error number. One that an
  -- exhausted limit or a STOP from outside ended past all Lua is still `running` when the next begins.
  function arm.run(text, action, ...)
    native.begin(text)
    arm.stopped = arm.stopped or running
    running = text
    local ok, result = pcall(action, ...)
    running = nil
    if ok then
      native.finish()
      return result
    end
    local numbered = type(result) == "table" and math.type(result.number) == "integer"
      and type(result.text) == "string"
    local number = numbered and result.number or lookup.errors.BAD_ARGUMENT.number
    if number == lookup.errors.STOPPED.number then
      give_up()
      arm.stopped = arm.stopped or text
    end
    native.finish(number, numbered and result.text or native.outside(tostring(result)))
    error(result, 0)
  end

  local function run_free(action, ...)
    if find_held() then
      local text = "%s is held, %s: CONTINUE or STOP comes first"
      native.fail("IN_PHASE", text:format(held.text, held.phase))
    end
    return action(...)
  end

  -- Runs one that moves something: refused while another one is held.
  function arm.move(text, action, ...)
    return arm.run(text, run_free, action, ...)
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
      local text = "the arm stands in %s slot %d since %s: RECOVER or HOME comes first"
      native.fail("STOPPED", text:format(arm.inside.station, arm.inside.slot, arm.since))
    elseif arm.stopped then
      native.fail("STOPPED", arm.stopped .. " was: RECOVER or HOME comes first")
    end
  end

  -- RECOVER and HOME have brought the arm out.
  function arm.set_free()
    arm.inside, arm.stopped = nil, nil
  end

  --------------------------------------------------------------------------------------- planning and playing

  -- The segment of a request, its axes found for where the gripper shall be. Detour 1 turns theta the longer
  -- way round, detour 2 the shorter way and a whole turn.
  local function segment_of(request)
    if request.to then
      request.axes = native.inverse(request)
      if request.detour then
        local theta = request.axes[1]
        local is_left = theta > native.axes()[1]
        request.axes[1] = theta + ((request.detour == 2) == is_left and 2 or -2) * math.pi
      end
    end
    return request
  end

  -- What a pattern is answered while it is only planned: a segment runs to its end, a question has its own
  -- assumption.
  local function assumed(request)
    return request.assume == nil or request.assume
  end

  -- The pattern's requests, one a call. `detours`: which detour each of its ways to a point takes, if any.
  local function requests_of(pattern, detours)
    local step, ways = coroutine.wrap(pattern), 0
    return function(answer)
      local request = step(answer)
      if type(request) == "table" and request.to then
        ways = ways + 1
        request.way, request.detour = ways, detours[ways]
      end
      return request
    end
  end

  -- The pattern of a plan, brought to where these answers lead: what steps it, and its next request, or what
  -- it returns.
  local function forward(plan)
    local step = requests_of(plan.pattern, plan.detours)
    local request = step(plan.target)
    for _, answer in ipairs(plan.answers) do
      request = step(answer)
    end
    return step, request
  end

  local function plan_through(plan)
    local step, request = forward(plan)
    while type(request) == "table" do
      local is_segment = request.assume == nil and not request.hold
      plan.way = request.way or plan.way
      request.planned = is_segment and native.plan(segment_of(request)) or nil
      plan[#plan + 1] = request
      request = step(assumed(request))
    end
    plan.became = request
  end

  local function try(begun, judged, detours)
    local plan = { pattern = begun.pattern, target = begun.target, answers = begun.answers, detours = detours }
    native.rehearse(true, judged)
    local ok, problem = pcall(plan_through, plan)
    native.rehearse(false)
    return plan, not ok and problem or nil
  end

  -- The shorter way to a station may end so near to the end of an axis's travel that the way in leaves it.
  -- Then the longer one is tried, and last one with a whole turn.
  local function can_go_round(plan, problem)
    return type(problem) == "table" and problem.number == lookup.errors.LIMIT_EXCEEDED.number and plan.way
      and plan.detours[plan.way] ~= 2
  end

  -- Plans all that a begun pattern has ahead of it.
  local function plan_ahead(begun, judged)
    local detours = {}
    for way, detour in pairs(begun.detours) do
      detours[way] = detour
    end
    local plan, problem = try(begun, judged, detours)
    local first = problem
    while problem and can_go_round(plan, problem) do
      detours[plan.way] = (detours[plan.way] or 0) + 1
      plan, problem = try(begun, judged, detours)
    end
    if problem then
      error(first, 0)
    end
    return plan
  end

  -- Plans all of a pattern from where the arm stands, without playing it; raises what is out of reach, and
  -- with `judged` a collision ahead. Returns the plan: the requests in order and, as `became`, what the
  -- pattern returned. It can be played until the next one is made.
  function arm.rehearse(pattern, target, judged)
    return plan_ahead({ pattern = pattern, target = target, answers = {}, detours = {} }, judged)
  end

  -- Plays a segment or asks a question. `target.watched`: a wafer that is lost on the way is an error after
  -- the segment, WAFER_LOST_ON_WAY or `target.lost_as`. The cell knows if a wafer is on a gripper's pads,
  -- whatever its sensor says; a controller would look.
  local function perform(request, target)
    if request.centre then
      return centring.answer(request.centre)
    elseif request.is_on then
      return native.sensor(request.is_on)
    elseif request.is_loaded then
      return native.held(request.is_loaded) ~= nil
    end
    if request.enters then
      arm.inside, arm.since = request.enters, running
      centring.begin(request.enters)
    end
    local ended, lost = native.play(request.planned or segment_of(request))
    if request.leaves then
      arm.inside = nil
    end
    if lost and target.watched then
      local name, at = native.layout.grippers[lost].name, request.target
      local way = request.to and "on the way to" or request.where
      local where = at and (" %s %s slot %d"):format(way, at.station, at.slot) or ""
      native.fail(target.lost_as or "WAFER_LOST_ON_WAY", ("the sensor of %s went off%s"):format(name, where))
    end
    return ended
  end

  -- The grippers whose sensors are on.
  local function sensors_on()
    local on = {}
    for index in ipairs(native.layout.grippers) do
      on[index] = native.sensor(index) or nil
    end
    return on
  end

  -- The command ends here, but its plan does not.
  local function hold(plan, phase)
    plan.answers[#plan.answers + 1] = true
    plan.phase, plan.text, plan.on = phase, plan.text or running, sensors_on()
    held = plan
    native.hold(plan.text, phase)
  end

  -- Performs a request and keeps its answer; nil if it is held there instead.
  local function answer_to(plan, request)
    if request.hold then
      return hold(plan, request.hold)
    end
    local answer = perform(request, plan.target)
    plan.answers[#plan.answers + 1] = answer
    return answer
  end

  -- What is ahead of a plan that was answered otherwise than it assumed: planned anew, since the blade goes
  -- elsewhere by what beams say.
  local function plan_again(plan)
    local again = plan_ahead(plan, true)
    again.text, again.conclude = plan.text, plan.conclude
    return again
  end

  local function finish(plan, became)
    if plan.conclude then
      plan.conclude(became)
    end
    return became
  end

  -- The last answer was not the assumed one: plans and plays anew from there.
  local function go_on(plan)
    local step, request = forward(plan)
    while type(request) == "table" do
      local answer = answer_to(plan, request)
      if answer == nil then
        return nil
      end
      request = step(answer)
    end
    return finish(plan, request)
  end

  -- Plays what was planned, as long as the answers are the assumed ones. What became of it goes to `conclude`,
  -- if there is one, and is returned; nil if the command is held before its end, which comes with a later
  -- CONTINUE.
  function arm.drive(plan, conclude)
    plan.conclude = conclude
    for _, request in ipairs(plan) do
      local answer = answer_to(plan, request)
      if answer == nil then
        return nil
      elseif request.centre then
        return arm.drive(plan_again(plan), conclude)
      elseif answer ~= assumed(request) then
        return go_on(plan)
      end
    end
    return finish(plan, plan.became)
  end

  function arm.play(pattern, target)
    return arm.drive(arm.rehearse(pattern, target, true))
  end

  ------------------------------------------------------------------------------------------------------ phases

  -- A wafer that was lost while its command was held would not be missed: no segment of it has seen the loss.
  local function check_kept(begun)
    for index, gripper in ipairs(begun.target.watched and native.layout.grippers or {}) do
      if begun.on[index] and not native.sensor(index) then
        local text = "the sensor of %s went off while %s was held: STOP comes first"
        native.fail("WAFER_LOST_ON_WAY", text:format(gripper.name, begun.text))
      end
    end
  end

  local function go_on_held()
    local begun = find_held()
    if not begun then
      native.fail("NOT_IN_PHASE", "none is held")
    end
    check_kept(begun)
    local plan = plan_ahead(begun, true)
    plan.text, held = begun.text, nil
    native.release()
    arm.drive(plan, begun.conclude)
  end

  -- What is held goes on, to where it is held next or to its end. Refused before anything moves, it is held as
  -- before.
  function arm.continue()
    arm.run("CONTINUE", go_on_held)
  end

  -- What is held is given up.
  function arm.stop()
    if find_held() then
      arm.run("STOP", give_up)
    end
  end

  ------------------------------------------------------------------------------------------------ kept states

  -- Plain data, with functions as they are.
  local function copy(value)
    if type(value) ~= "table" then
      return value
    end
    local copied = {}
    for name, part in pairs(value) do
      copied[name] = copy(part)
    end
    return copied
  end

  -- A held plan but for its requests, which are planned anew when it goes on.
  local function copy_plan(plan)
    local copied = {}
    for name, part in pairs(plan or {}) do
      if type(name) == "string" then
        copied[name] = copy(part)
      end
    end
    return plan and copied
  end

  -- A function that makes the arm again what it is now, and one that says if it still is.
  function arm.keep()
    local plan, inside, since = copy_plan(find_held()), arm.inside, arm.since
    local stopped, homed, was_inside = arm.stopped, arm.homed, copy(arm.inside)
    return function()
      held, arm.inside, arm.since = copy_plan(plan), copy(was_inside), since
      arm.stopped, arm.homed = stopped, homed
    end, function()
      return arm.inside == inside and arm.stopped == stopped and arm.homed == homed
    end
  end

  return arm
end
