-- A pattern is planned to its end before anything moves, and played. The command that asks for it is held in a phase
-- if it wants that, and CONTINUE goes on with it.

-- Local copies: a script may set globals of these names.
local coroutine, error, ipairs, next, pairs, pcall, type = coroutine, error, ipairs, next, pairs, pcall, type

return function(native, lookup, arm, ways, centring, tasks, alarms, kinds)
  local player = {}

  -- The answer to a pattern while it is only planned: a segment runs to its end, a question has its own
  -- assumption.
  local function assumed(request)
    return request.assume == nil or request.assume
  end

  -- Returns the pattern's requests, one for each call, with all that the pattern has `told` of passive
  -- pads before it. `detours`: the detour of each way to a point, if any.
  local function requests_of(pattern, detours)
    local step, count, told = coroutine.wrap(pattern), 0, {}
    return function(answer)
      local request = step(answer)
      while type(request) == "table" and request.carries do
        told[request.carries] = request.wafer
        request = step()
      end
      if type(request) == "table" then
        request.told = told
        if request.to then
          count = count + 1
          request.way, request.detour = count, detours[count]
        end
      end
      return request
    end
  end

  -- Repeats a plan's pattern with its answers so far. Returns the function that steps it, and its next
  -- request or its result.
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
    local front = arm.state().front
    while type(request) == "table" do
      local is_segment = request.assume == nil and not request.hold
      if request.centre then
        centring.check_room(request.centre)
      end
      plan.way = request.way or plan.way
      request.planned = is_segment and native.plan(ways.segment(request, plan.target, front)) or nil
      front = request.to and ways.in_front(request) or front
      plan[#plan + 1] = request
      request = step(assumed(request))
    end
    native.look_on()
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
  -- Then the longer way is tried, and last the one with a whole turn.
  local function can_go_round(plan, problem)
    return type(problem) == "table" and problem.number == lookup.errors.LIMIT_EXCEEDED.number and plan.way
      and plan.detours[plan.way] ~= 2
  end

  -- Plans the rest of a begun pattern.
  local function plan_ahead(begun, judged)
    local detours = {}
    if next(begun.detours) then
      for way, detour in pairs(begun.detours) do
        detours[way] = detour
      end
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

  -- Plans all of a pattern from where the arm stands, without playing it; raises an error if something is
  -- out of reach, and with `judged` for a collision ahead. Returns the plan: the requests in order and, as
  -- `became`, what the pattern returned. It can be played until the next one is made.
  function player.rehearse(pattern, target, judged)
    for _, part in ipairs({ target, target.get, target.put }) do
      part.asked = {} -- see lua/mcs/own_patterns.lua
    end
    local known = judged and kinds.find(pattern, target)
    if known then
      return known
    end
    local plan = plan_ahead({ pattern = pattern, target = target, answers = {}, detours = {} }, judged)
    if judged then
      kinds.keep(plan)
    end
    return plan
  end

  -- The state of an edge grip's plunger. A target keeps the first state that is not the expected "open".
  local function ask_plunger(request)
    local does, s, excess = native.grip(request.grip)
    local target = request.note
    if target and not (does == "open" and request.assume == "open") and not target.plunger then
      target.plunger = { does = does, s = s, excess = excess, is_on = native.sensor(request.grip) }
    end
    return does
  end

  -- True if the robot's arm leaves its place: chucks and doors are not its own, and a flip turns the blade without
  -- leaving.
  local function goes_away(request, robot)
    local now, goes = native.axes(), request.line ~= nil
    for _, axis in ipairs(request.axes and native.layout.robots[robot or tasks.current().robot or 1].axes or {}) do
      goes = goes or axis.name ~= "flip" and request.axes[axis.index] ~= now[axis.index]
    end
    return goes
  end

  -- The target keeps of a gripper without a wafer what hindered it when it was asked, not what did so later on.
  local function is_loaded(gripper, target)
    if native.held(gripper) then
      return true
    end
    local late, is_shut, wafer, holder = native.hindered(gripper)
    target.hindered = { gripper = gripper, late = late, is_shut = is_shut, wafer = wafer, holder = holder }
    return false
  end

  -- Plays a segment or asks a question. `target.watched`: a wafer lost on the way is an error after the
  -- segment, WAFER_LOST_ON_WAY or `target.lost_as`. The cell knows whether a wafer is on a gripper's pads,
  -- whatever its sensor says; in a real tool someone would look.
  local function perform(request, target)
    if request.centre then
      return centring.answer(request.centre)
    elseif request.is_on then
      return native.sensor(request.is_on)
    elseif request.is_loaded then
      return is_loaded(request.is_loaded, target)
    elseif request.grip then
      return ask_plunger(request)
    end
    local state, robot = arm.state(target.robot), target.robot or tasks.current().robot or 1
    if request.enters then
      native.stands_in(robot, native.layout.stations[request.enters.station].index)
      state.inside, state.since = request.enters, arm.running()
      centring.begin(request.enters)
    end
    alarms.begin_motion(arm.running())
    local segment = request.planned or ways.segment(request, target, state.front)
    if request.to or request.homeward or not request.target and goes_away(request, target.robot) then
      state.front = nil   -- a stopped one ends somewhere between
    end
    local ended, lost = tasks.play(segment)
    if request.leaves then
      native.stands_in(robot)
      state.inside = nil
    end
    if request.to or request.leaves then
      state.front = ways.in_front(request)
    end
    if lost and lost ~= request.lets_go and target.watched then
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

  -- Holds the plan: the command ends here, but its plan does not.
  local function hold(plan, phase)
    plan.answers[#plan.answers + 1] = true
    plan.phase, plan.text, plan.on = phase, plan.text or arm.running(), sensors_on()
    arm.state().held = plan
    native.hold(tasks.current().robot, plan.text, phase)
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

  -- Plans the rest again after an answer that was not assumed: the beams send the blade to another place.
  local function plan_again(plan)
    local again = plan_ahead(plan, true)
    again.text, again.conclude = plan.text, plan.conclude
    return again
  end

  -- Plans again after the beams have given the wafer's place. If the blade cannot go aside so far, the wafer
  -- comes out again.
  local function plan_aside(plan)
    local ok, again = pcall(plan_again, plan)
    if not ok and type(again) == "table" and again.number and plan.answers[#plan.answers] then
      plan.target.refused = again
      plan.answers[#plan.answers] = false
      return plan_again(plan)
    end
    return ok and again or error(again, 0)
  end

  local function finish(plan, became)
    if plan.conclude then
      plan.conclude(became)
    end
    return became
  end

  -- Goes on after an answer that was not assumed: plans and plays again from there.
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

  -- Plays what was planned, as long as the answers are the assumed ones. The result goes to `conclude`, if
  -- given, and is returned. It is nil if the command is held before its end; a later CONTINUE then ends it.
  function player.drive(plan, conclude)
    plan.conclude = conclude
    for _, request in ipairs(plan) do
      local answer = answer_to(plan, request)
      if answer == nil then
        return nil
      elseif request.centre then
        return player.drive(plan_aside(plan), conclude)
      elseif answer ~= assumed(request) then
        return go_on(plan)
      end
    end
    return finish(plan, plan.became)
  end

  function player.play(pattern, target)
    return player.drive(player.rehearse(pattern, target, true))
  end

  ------------------------------------------------------------------------------------------------------ phases

  -- Checks that no wafer was lost while its command was held: no segment of the command has seen such a loss.
  local function check_kept(begun)
    for index, gripper in ipairs(begun.target.watched and native.layout.grippers or {}) do
      if begun.on[index] and not native.sensor(index) then
        local text = "the sensor of %s went off while %s was held: STOP comes first"
        native.fail("WAFER_LOST_ON_WAY", text:format(gripper.name, begun.text))
      end
    end
  end

  local function go_on_held()
    local robot = tasks.current().robot
    local begun = robot and arm.find_held(robot)
    if not begun then
      native.fail("NOT_IN_PHASE", "none is held")
    end
    check_kept(begun)
    local plan = plan_ahead(begun, true)
    plan.text, arm.state().held = begun.text, nil
    native.release(robot)
    player.drive(plan, begun.conclude)
    return plan.target.centred
  end

  -- Continues the held command, to its next hold or its end; for a PUT that centres it returns the beams'
  -- result. If it is refused before anything moves, it is held as before. With several robots it is the one
  -- that the word is bound to, or the only one with a held command.
  function player.continue()
    local holding = arm.find_holding()
    local bound = lookup.bound()
    local robot = bound or #holding == 1 and holding[1] or not lookup.has_several() and 1 or nil
    local options = robot and { robot = native.layout.robots[robot].name }
    local needs = robot and arm.find_held(robot) and arm.needs_stand(options)
      or arm.needs(robot ~= nil or #holding > 0, nil, options)
    return arm.run(needs, "CONTINUE", go_on_held)
  end

  return player
end
