-- The controller's knowledge of its arms: which command runs and what it needs, where an arm stands, and whether a
-- command may begin there. lua/mcs/ways.lua says how it goes, lua/mcs/player.lua plans and plays that.

-- Local copies: a script may set globals of these names.
local error, ipairs, math, pairs, pcall = error, ipairs, math, pairs, pcall
local tostring, type = tostring, type

return function(native, lookup, tasks, alarms)
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

  -- The state of a robot, without one of the running command's.
  function arm.state(robot)
    robot = robot or tasks.current().robot or 1
    local state = states[robot] or {}
    states[robot] = state
    return state
  end

  -- By task: its running command, and the door that this goes through, if any.
  local running, running_door = {}, {}

  -- The running command's text.
  function arm.running()
    return running[tasks.current()]
  end

  -- Gives up like a STOP: the arm must then be brought out.
  local function give_up(robot)
    local state = arm.state(robot)
    if state.held then
      state.stopped = state.stopped or state.held.text
      state.held = nil
      native.release(robot)
    end
  end

  -- The robot's held plan, if there is one.
  function arm.find_held(robot)
    local state = arm.state(robot)
    if state.held and not native.is_held(robot) then
      give_up(robot)
    end
    return state.held
  end

  -- The robots with a held plan.
  function arm.find_holding()
    local holding = {}
    for robot in ipairs(native.layout.robots) do
      holding[#holding + 1] = arm.find_held(robot) and robot or nil
    end
    return holding
  end

  local STATION, DOOR = "station %s", "door %s"

  -- By a station's name its text as a resource, made once.
  local station_texts = {}

  local function station_text(name)
    local text = station_texts[name] or STATION:format(name)
    station_texts[name] = text
    return text
  end

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

  -- OPEN and CLOSE need only the door, and the other doors of its load lock. No robot takes part in them.
  function arm.needs_door(door)
    local needs = { DOOR:format(native.layout.doors[door].name), chucks = { #native.layout.grippers + door }, is_lone = true }
    for _, station in pairs(native.layout.stations) do
      for other in pairs(station.door_sides and station.door_sides[door] and station.door_sides or {}) do
        needs[#needs + 1] = other ~= door and DOOR:format(native.layout.doors[other].name) or nil
      end
    end
    return needs
  end

  -- PUMP needs the load lock and all of its doors.
  function arm.needs_lock(station_name)
    local station = type(station_name) == "string" and native.layout.stations[station_name]
    local needs = { station and station_text(station_name) or nil, chucks = {}, is_lone = true }
    for door in pairs(station and station.door_sides or {}) do
      needs[#needs + 1] = DOOR:format(native.layout.doors[door].name)
    end
    return needs
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
      needs[1] = station_text(station_name)
      add_chucks(needs.chucks, station)
      if not before then
        add_door(needs, station)
      end
    end
    return needs
  end

  -- The robot that stands there, or nil; robot `but` does not count.
  function arm.stands_in(resource, but)
    for robot = 1, #native.layout.robots do
      local state = states[robot]
      if robot ~= but and state and state.inside and station_text(state.inside.station) == resource then
        return robot
      end
    end
  end

  -- True if that robot stands there.
  function arm.is_inside(resource, robot)
    local state = robot and states[robot]
    return state and state.inside ~= nil and station_text(state.inside.station) == resource
  end

  -- The state of the robot that stands in the station.
  function arm.find_inside(station_name)
    for robot = 1, #native.layout.robots do
      local state = states[robot]
      if state and state.inside and state.inside.station == station_name then
        return state
      end
    end
  end

  -- Needs the robot, and the station in which it stands.
  function arm.needs_stand(options)
    local needs = arm.needs(true, nil, options)
    local inside = arm.state(needs.robot).inside
    local station = inside and native.layout.stations[inside.station]
    if station then
      needs[1] = station_text(inside.station)
      add_chucks(needs.chucks, station)
      add_door(needs, station)
    end
    return needs
  end

  -- Commands that a robot's own controller does not refuse: they move no axis of it.
  local STANDING_STILL = { STOP = true, VALVE = true }

  local function run_alone(needs, word, action, ...)
    if needs and needs.unclear then
      needs.unclear()
    end
    tasks.take(needs)
    if needs and needs.robot and not STANDING_STILL[word] then
      native.check_controller(needs.robot, word == "HOME")
    end
    if needs and needs.robot then
      native.sets_out(needs.robot)
    end
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
    if not native.alarms() then
      return
    end
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
    task.is_lone, task.share = needs and needs.is_lone, nil
    state = arm.state()
    local ok, result = pcall(run_alone, needs, word, action, ...)
    local was_cut = native.was_cut()
    local numbered = type(result) == "table" and math.type(result.number) == "integer"
      and type(result.text) == "string"
    local number = numbered and result.number or lookup.errors.BAD_ARGUMENT.number
    alarms.mend(not ok and number)
    tasks.give_back()
    running[task], running_door[task] = nil, nil
    if task.robot and not arm.state().held then
      native.brings(task.robot)
    end
    if ok then
      task.robot = nil
      native.finish()
      return result
    end
    -- The arm did not move if the command has waited for it in vain; nor, with several ports' commands, if it had
    -- no part in this one.
    local had_part = not tasks.has_waited() and (needs == nil or needs.robot or not native.has_jobs())
    if (number == lookup.errors.STOPPED.number or was_cut) and had_part then
      for _, robot in ipairs(task.robot and { task.robot } or arm.find_holding()) do
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
    local robot = tasks.current().robot or not native.has_jobs() and arm.find_holding()[1]
    return robot and arm.find_held(robot)
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

  -- The index of the first axis of the robot that carries this gripper.
  function arm.first_axis(gripper)
    return native.layout.robots[native.layout.grippers[gripper].robot].first
  end

  -- RECOVER and HOME have brought the arm out.
  function arm.set_free()
    local state = arm.state()
    state.inside, state.stopped = nil, nil
    native.stands_in(tasks.current().robot or 1)
  end

  -- Gives up held commands: of the robot that the word is bound to, or of all.
  function arm.stop()
    for _, robot in ipairs(arm.find_holding()) do
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
    arm.find_holding()
    local kept, insides = copy_states(states), {}
    for robot, state in pairs(states) do
      insides[robot] = state.inside
    end
    return function()
      states = copy_states(kept)
    end, function()
      for robot in ipairs(native.layout.robots) do
        local was, is = kept[robot] or {}, arm.state(robot)
        if is.inside ~= insides[robot] or is.stopped ~= was.stopped or is.homed ~= was.homed then
          return false
        end
      end
      return true
    end
  end

  return arm
end
