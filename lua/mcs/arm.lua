-- The controller's knowledge of its arm, and the steps of a command. A command is recorded, planned to its
-- end before anything moves, and played. It is held in a phase if it asks for that, and refused while the
-- arm may stand in a place where it must not begin.

-- Local copies: a script may set globals of these names.
local coroutine, error, ipairs, math, pairs, pcall = coroutine, error, ipairs, math, pairs, pcall
local tostring, type = tostring, type

return function(native, lookup, centring, tasks, alarms)
  local arm = {}

  -- By robot:
  -- inside   the target whose straight line the arm has entered and not left
  -- since    the command that entered it
  -- front    { station, gripper }: the name of the station that it stands in, or in front of, and the gripper there;
  --          nil: elsewhere
  -- stopped  a command that was cut short, without RECOVER or HOME since; else nil
  -- homed    nil: as in the layout
  -- held     the plan of a command that stands still in a phase, and its text; else nil. The host also knows it,
  --          and may give it up
  local states = {}

  local function state_of(robot)
    states[robot] = states[robot] or {}
    return states[robot]
  end

  -- The state of the running command's robot.
  function arm.state()
    return state_of(tasks.current().robot or 1)
  end

  -- By task: its running command, and the door that this goes through, if any.
  local running, running_door = {}, {}

  -- Gives up like a STOP: the arm must then be brought out.
  local function give_up(robot)
    local state = state_of(robot)
    if state.held then
      state.stopped = state.stopped or state.held.text
      state.held = nil
      native.release(robot)
    end
  end

  -- The robot's held plan, if there is one.
  local function find_held(robot)
    local state = state_of(robot)
    if state.held and not native.is_held(robot) then
      give_up(robot)
    end
    return state.held
  end

  -- The robots with a held plan.
  local function find_holding()
    local holding = {}
    for robot in ipairs(native.layout.robots) do
      holding[#holding + 1] = find_held(robot) and robot or nil
    end
    return holding
  end

  local STATION, DOOR = "station %s", "door %s"

  -- With several robots, the gripper of a line that names none; else nil.
  function arm.leader()
    local robot = tasks.current().robot
    return robot and lookup.has_several() and lookup.on_robot(robot)[1] or nil
  end

  -- The station's door for the command's robot.
  local function add_door(needs, station)
    local door = station.doors and needs.robot and station.doors[needs.robot]
    if door then
      needs.door = door
      needs[#needs + 1] = DOOR:format(native.layout.doors[door].name)
      needs.chucks[#needs.chucks + 1] = #native.layout.grippers + door
    end
  end

  -- OPEN and CLOSE need only the door. No robot takes part in them.
  function arm.needs_door(door)
    local name = native.layout.doors[door].name
    return { DOOR:format(name), chucks = { #native.layout.grippers + door }, is_lone = true }
  end

  -- Adds a station's own grippers, which are not on the robot.
  local function add_chucks(chucks, station)
    chucks[#chucks + 1] = station.chuck
    chucks[#chucks + 1] = station.pins
  end

  -- The needs of a command: the robot, and a station with its chuck and pins, if there is one of that name. With
  -- several robots `station_name` and `options` select one; if they do not, `unclear` raises the reason. It needs the
  -- station's door, too, unless it stays `before` it.
  function arm.needs(robot, station_name, options, before)
    local station = type(station_name) == "string" and native.layout.stations[station_name]
    local needs = { chucks = {} }
    if robot then
      local is_clear, which = pcall(lookup.robot_for, station_name, options)
      needs.robot = is_clear and which or 1
      needs.unclear = not is_clear and function()
        lookup.robot_for(station_name, options)
      end or nil
    end
    if station then
      needs[1] = STATION:format(station_name)
      add_chucks(needs.chucks, station)
      if not before then
        add_door(needs, station)
      end
    end
    return needs
  end

  -- The robot that stands there, or nil; robot `but` does not count.
  function tasks.stands_in(resource, but)
    for robot, state in pairs(states) do
      if robot ~= but and state.inside and STATION:format(state.inside.station) == resource then
        return robot
      end
    end
  end

  function tasks.is_inside(resource, robot)
    local state = robot and states[robot]
    return state and state.inside ~= nil and STATION:format(state.inside.station) == resource
  end

  -- The state of the robot that stands in the station.
  function arm.find_inside(station_name)
    for _, state in pairs(states) do
      if state.inside and state.inside.station == station_name then
        return state
      end
    end
  end

  -- Needs the robot, and the station in which it stands.
  function arm.needs_stand(options)
    local needs = arm.needs(true, nil, options)
    local inside = state_of(needs.robot).inside
    local station = inside and native.layout.stations[inside.station]
    if station then
      needs[1] = STATION:format(inside.station)
      add_chucks(needs.chucks, station)
      add_door(needs, station)
    end
    return needs
  end

  local function run_alone(needs, word, action, ...)
    if needs and needs.unclear then
      needs.unclear()
    end
    tasks.take(needs)
    running_door[tasks.current()] = needs and needs.door
    return alarms.meet(word, action, ...)
  end

  -- With several robots, adds the robot's name to a command's text.
  function arm.with_robot(text, needs)
    if not needs or not needs.robot or needs.unclear or not lookup.has_several() then
      return text
    end
    local name = native.layout.robots[needs.robot].name
    return ("%s robot=%s"):format(text, name:find("^[%w_./-]+$") and name or lookup.quote(name))
  end

  -- The phase in which the command that this task ran last is held, or nil.
  function arm.phase()
    local robot = tasks.current().last_robot
    return robot and native.is_held(robot)
  end

  -- The robot of the command that this task ran last.
  function arm.last_robot()
    return tasks.current().last_robot
  end

  -- With several robots a command without a robot marks none. A single robot is marked: somebody pressed
  -- STOP beside it.
  local function marks(task)
    return not task.is_lone and (task.robot or not lookup.has_several())
  end

  -- Raises an error armed to come before the command. The command is recorded nevertheless, because STATUS tells the
  -- error that a completion told.
  local function refuse_armed(word, text)
    local ok, problem = pcall(alarms.refuse, word)
    if not ok then
      native.begin(text, tasks.current().line)
      native.finish(problem.number, problem.text)
      error(problem, 0)
    end
  end

  -- Runs a command: it is recorded with the script's line, its times and its error number. If an exhausted
  -- limit or a STOP from outside ended a command outside of Lua, it is still `running` when the next begins.
  -- `needs`: the parts of the cell that it must have for itself, see arm.needs; nil: none.
  function arm.run(needs, text, action, ...)
    local word, task = text:match("^[%u_]+"), tasks.current()
    text = arm.with_robot(text, needs)
    refuse_armed(word, text)
    native.begin(text, task.line)
    local state = arm.state()
    state.stopped = state.stopped or marks(task) and running[task] or nil
    running[task], task.robot, task.last_robot = text, needs and needs.robot, needs and needs.robot
    task.is_lone = needs and needs.is_lone
    state = arm.state()
    local ok, result = pcall(run_alone, needs, word, action, ...)
    local numbered = type(result) == "table" and math.type(result.number) == "integer"
      and type(result.text) == "string"
    local number = numbered and result.number or lookup.errors.BAD_ARGUMENT.number
    alarms.mend(not ok and number)
    tasks.give_back()
    running[task], running_door[task] = nil, nil
    if ok then
      task.robot = nil
      native.finish()
      return result
    end
    -- The arm did not move if the command has waited for it in vain; nor, with several ports' commands, if it had
    -- no part in this one.
    local had_part = not tasks.has_waited() and (needs == nil or needs.robot or not native.has_jobs())
    if number == lookup.errors.STOPPED.number and had_part then
      for _, robot in ipairs(task.robot and { task.robot } or find_holding()) do
        give_up(robot)
      end
      state.stopped = state.stopped or marks(task) and text or nil
    end
    task.robot = nil
    native.finish(number, numbered and result.text or native.outside(tostring(result)))
    error(result, 0)
  end

  -- The held plan that is in the way. A command without a robot waits for all robots; at one of
  -- several ports for none.
  local function find_in_way()
    local robot = tasks.current().robot or not native.has_jobs() and find_holding()[1]
    return robot and find_held(robot)
  end

  local function run_free(action, ...)
    local held = find_in_way()
    if held then
      local text = "%s is held, %s: CONTINUE or STOP comes first"
      native.fail("IN_PHASE", text:format(held.text, held.phase))
    end
    return action(...)
  end

  -- Runs a command that moves something: it is refused while another one is held.
  function arm.move(needs, text, action, ...)
    return arm.run(needs, text, run_free, action, ...)
  end

  -- Call it before a command that relies on the arm's place.
  function arm.check_homed()
    local state = arm.state()
    if state.homed == nil then
      state.homed = native.layout.homed
    end
    if alarms.take("NOT_HOMED") then
      state.homed = false
    end
    if not state.homed then
      native.fail("NOT_HOMED", "HOME comes first")
    end
  end

  -- Call it before a command that needs the arm outside of stations.
  function arm.check_outside()
    arm.check_homed()
    local state = arm.state()
    if state.inside then
      local text = "the arm stands in %s slot %d since %s: RECOVER or HOME comes first"
      native.fail("STOPPED", text:format(state.inside.station, state.inside.slot, state.since))
    elseif state.stopped then
      native.fail("STOPPED", state.stopped .. " was: RECOVER or HOME comes first")
    end
  end

  -- Checks the station's door before a command that goes through it: an earlier OPEN has ended by now.
  local function check_door()
    local door = running_door[tasks.current()]
    local word = door and native.door(door)
    if door and word ~= "open" then
      local name = native.layout.doors[door].name
      native.fail("DOOR_SHUT", ('%s is %s: open("%s") comes first'):format(name,
        word == "shut" and "shut" or "neither open nor shut", name))
    end
  end

  -- Call it before a command that goes into a station.
  function arm.check_free()
    arm.check_outside()
    check_door()
    local flip = lookup.axis("flip", tasks.current().robot)
    local turned = flip and math.deg(native.axes()[flip.index]) or 0
    if turned ~= 0 and math.abs(turned) ~= 180 then
      native.fail("NOT_LEVEL", ("the blade is turned over by %.6g degrees: FLIP or HOME comes first"):format(turned))
    end
  end

  -- RECOVER and HOME have brought the arm out.
  function arm.set_free()
    local state = arm.state()
    state.inside, state.stopped = nil, nil
  end

  --------------------------------------------------------------------------------------- planning and playing

  -- The index of the first axis of the robot that carries this gripper.
  function arm.first_axis(gripper)
    return native.layout.robots[native.layout.grippers[gripper].robot].first
  end

  -- With two arms or wrists, moves the one that does not go to the point home.
  local function fold_other(request)
    local gripper = native.layout.grippers[request.to.gripper]
    local robot = native.layout.robots[gripper.robot]
    if robot.arms then
      local other = robot.arms[3 - gripper.arm]
      request.axes[other] = robot.home[other - robot.first + 1]
    end
  end

  -- The turn nearest to `near` of an angle.
  local function nearest_turn(angle, near)
    return angle + 2 * math.pi * math.floor((near - angle) / (2 * math.pi) + 0.5)
  end

  -- A station's point in the form for native.plan, for a robot that goes there with `gripper`. Axes that the point does
  -- not give are as in `axes`. With two arms or wrists it gives the axis of this gripper.
  local function via_point(via, robot, gripper, axes)
    local point, arm_number = { blend = via.blend }, native.layout.grippers[gripper].arm
    for index in ipairs(robot.home) do
      point[index] = via[index] or axes[robot.first + index - 1]
    end
    if robot.arms and arm_number == 2 then
      local first, second = robot.arms[1] - robot.first + 1, robot.arms[2] - robot.first + 1
      point[first], point[second] = axes[robot.arms[1]], via[first] or axes[robot.arms[2]]
    end
    if robot.headings and via[1] then
      point[1] = nearest_turn(via[1] - robot.headings[arm_number], axes[robot.first])
    end
    return point
  end

  -- The list of a robot's points at a station; empty for no station, nil.
  local function vias_of(robot, station)
    return station and native.layout.stations[station].vias[robot] or {}
  end

  -- True if the robot has points at the station that it stands in front of or goes to: it then
  -- moves by them.
  local function has_points(robot, front, station)
    return (not front or front.station ~= station) and #vias_of(robot, front and front.station) + #vias_of(robot, station) > 0
  end

  -- A robot's points on the way from the station that it stands in front of (`front`) to the next one (`goal`), or
  -- nil: back along the points of the first, then along those of the second. Both are { station, gripper }, or nil for
  -- elsewhere; `there` are the axes at the end.
  local function vias_between(robot, front, goal, there)
    local here, points, own = native.axes(), { robot = robot }, native.layout.robots[robot]
    if not has_points(robot, front, goal and goal.station) then
      return nil
    end
    local back = vias_of(robot, front and front.station)
    for index = #back, 1, -1 do
      points[#points + 1] = via_point(back[index], own, front.gripper, here)
    end
    for _, via in ipairs(vias_of(robot, goal and goal.station)) do
      points[#points + 1] = via_point(via, own, goal.gripper, there)
    end
    return points
  end

  -- True if the running command's robot moves home by points.
  function arm.goes_home_by_points()
    return has_points(tasks.current().robot or 1, arm.state().front, nil)
  end

  -- The axes with both arms retracted, if the robot turns on its way to the point and has no points
  -- for that.
  local function retracted(request, front)
    local number = native.layout.grippers[request.before.gripper].robot
    local robot, axes = native.layout.robots[number], native.axes()
    if has_points(number, front, request.target.station) then
      return axes
    end
    local there = native.inverse { to = request.before, target = request.target, where = request.where }
    for _, axis in ipairs(math.abs(there[robot.first] - axes[robot.first]) > 1e-9 and robot.arms or {}) do
      axes[axis] = robot.home[axis - robot.first + 1]
    end
    return axes
  end

  -- The station in front of which the arm stands after a request; nil: elsewhere.
  local function in_front(request)
    local target = request.target
    return target and { station = target.station, gripper = target.gripper }
  end

  -- The segment of a request, with the axes for the gripper's goal. Detour 1 turns theta the longer way
  -- round, detour 2 the shorter way plus a whole turn. `front` is the station in front of which the arm
  -- stands.
  local function segment_of(request, target, front)
    if request.before then
      request.axes = retracted(request, front)
    elseif request.to then
      request.axes = native.inverse(request)
      fold_other(request)
      if request.detour then
        local first = arm.first_axis(request.to.gripper)
        local theta = request.axes[first]
        local is_left = theta > native.axes()[first]
        request.axes[first] = theta + ((request.detour == 2) == is_left and 2 or -2) * math.pi
      end
      request.via = request.target
        and vias_between(native.layout.grippers[request.to.gripper].robot, front, in_front(request), request.axes) or nil
    elseif request.homeward then
      request.via = vias_between(tasks.current().robot or 1, front, nil, request.axes)
    elseif request.line then
      request.gripper = request.gripper or request.target and request.target.gripper or target.gripper
    elseif request.moves then
      request.axes = native.axes()
      for axis, at in pairs(request.moves) do
        request.axes[axis] = at
      end
    end
    return request
  end

  -- The answer to a pattern while it is only planned: a segment runs to its end, a question has its own
  -- assumption.
  local function assumed(request)
    return request.assume == nil or request.assume
  end

  -- Returns the pattern's requests, one for each call, with all that the pattern has `told` of passive
  -- pads before it. `detours`: the detour of each way to a point, if any.
  local function requests_of(pattern, detours)
    local step, ways, told = coroutine.wrap(pattern), 0, {}
    return function(answer)
      local request = step(answer)
      while type(request) == "table" and request.carries do
        told[request.carries] = request.wafer
        request = step()
      end
      if type(request) == "table" then
        request.told = told
        if request.to then
          ways = ways + 1
          request.way, request.detour = ways, detours[ways]
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
      request.planned = is_segment and native.plan(segment_of(request, plan.target, front)) or nil
      front = request.to and in_front(request) or front
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

  -- Plans all of a pattern from where the arm stands, without playing it; raises an error if something is
  -- out of reach, and with `judged` for a collision ahead. Returns the plan: the requests in order and, as
  -- `became`, what the pattern returned. It can be played until the next one is made.
  function arm.rehearse(pattern, target, judged)
    return plan_ahead({ pattern = pattern, target = target, answers = {}, detours = {} }, judged)
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

  -- Plays a segment or asks a question. `target.watched`: a wafer lost on the way is an error after the
  -- segment, WAFER_LOST_ON_WAY or `target.lost_as`. The cell knows whether a wafer is on a gripper's pads,
  -- whatever its sensor says; in a real tool someone would look.
  local function perform(request, target)
    if request.centre then
      return centring.answer(request.centre)
    elseif request.is_on then
      return native.sensor(request.is_on)
    elseif request.is_loaded then
      return native.held(request.is_loaded) ~= nil
    elseif request.grip then
      return ask_plunger(request)
    end
    local state = target.robot and state_of(target.robot) or arm.state()
    if request.enters then
      state.inside, state.since = request.enters, running[tasks.current()]
      centring.begin(request.enters)
    end
    alarms.begin_motion(running[tasks.current()])
    local segment = request.planned or segment_of(request, target, state.front)
    if request.to or request.homeward or not request.target and goes_away(request, target.robot) then
      state.front = nil   -- a stopped one ends somewhere between
    end
    local ended, lost = tasks.play(segment)
    if request.leaves then
      state.inside = nil
    end
    if request.to or request.leaves then
      state.front = in_front(request)
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
    plan.phase, plan.text, plan.on = phase, plan.text or running[tasks.current()], sensors_on()
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
    if not ok and type(again) == "table" and plan.answers[#plan.answers] then
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
  function arm.drive(plan, conclude)
    plan.conclude = conclude
    for _, request in ipairs(plan) do
      local answer = answer_to(plan, request)
      if answer == nil then
        return nil
      elseif request.centre then
        return arm.drive(plan_aside(plan), conclude)
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
    local begun = robot and find_held(robot)
    if not begun then
      native.fail("NOT_IN_PHASE", "none is held")
    end
    check_kept(begun)
    local plan = plan_ahead(begun, true)
    plan.text, arm.state().held = begun.text, nil
    native.release(robot)
    arm.drive(plan, begun.conclude)
    return plan.target.centred
  end

  -- Continues the held command, to its next hold or its end; for a PUT that centres it returns the beams'
  -- result. If it is refused before anything moves, it is held as before. With several robots it is the one
  -- that the word is bound to, or the only one with a held command.
  function arm.continue()
    local holding = find_holding()
    local bound = lookup.bound()
    local robot = bound or #holding == 1 and holding[1] or not lookup.has_several() and 1 or nil
    local options = robot and { robot = native.layout.robots[robot].name }
    local needs = robot and find_held(robot) and arm.needs_stand(options)
      or arm.needs(robot ~= nil or #holding > 0, nil, options)
    return arm.run(needs, "CONTINUE", go_on_held)
  end

  -- Gives up held commands: of the robot that the word is bound to, or of all.
  function arm.stop()
    for _, robot in ipairs(find_holding()) do
      if not lookup.bound() or lookup.bound() == robot then
        arm.run(arm.needs(true, nil, { robot = native.layout.robots[robot].name }), "STOP", function()
          give_up(robot)
        end)
      end
    end
  end

  ------------------------------------------------------------------------------------------------ kept states

  -- Copies plain data; functions stay as they are.
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

  -- Copies a held plan without its requests, which are planned again when it continues.
  local function copy_plan(plan)
    local copied = {}
    for name, part in pairs(plan or {}) do
      if type(name) == "string" then
        copied[name] = copy(part)
      end
    end
    return plan and copied
  end

  local function copy_states(all)
    local copied = {}
    for robot, state in pairs(all) do
      local plan = state.held
      copied[robot] = {}
      for name, part in pairs(state) do
        copied[robot][name] = name ~= "held" and copy(part) or nil
      end
      copied[robot].held = copy_plan(plan)
    end
    return copied
  end

  -- Returns a function that restores the arm's present state, and one that tells whether it is unchanged.
  function arm.keep()
    find_holding()
    local kept, insides = copy_states(states), {}
    for robot, state in pairs(states) do
      insides[robot] = state.inside
    end
    return function()
      states = copy_states(kept)
    end, function()
      for robot in ipairs(native.layout.robots) do
        local was, is = kept[robot] or {}, state_of(robot)
        if is.inside ~= insides[robot] or is.stopped ~= was.stopped or is.homed ~= was.homed then
          return false
        end
      end
      return true
    end
  end

  return arm
end
