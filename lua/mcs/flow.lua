-- The word that takes lots through a tool. Robots that are times alone are played by the engine: lib/flow/flow.h. In a
-- cell with axes the engine decides, and each robot is a task that plays its commands; see lib/mcs/flow_played.h.

-- Local copies: a script may set globals of these names.
local error, ipairs, math, pcall, rawget, tostring, type = error, ipairs, math, pcall, rawget, tostring, type

return function(native, tasks, commands, lookup, slot_map, calls)
  local flows = {}
  -- A handler that always answers "retry" comes to an end.
  local most_retries = 100

  -------------------------------------------------------------------------------------------------- commands

  local play = {}

  function play.move(action)
    commands.ready(action.station, action.slot, { gripper = action.gripper })
  end

  function play.open(action)
    commands.open(action.door)
  end

  function play.pick(action)
    if action.map and not action.is_mapped then
      commands.map(action.station, { gripper = action.gripper })
      action.is_mapped = true
    end
    commands.get(action.station, action.slot, { gripper = action.gripper })
  end

  function play.place(action)
    if not action.is_placed then
      commands.put(action.station, action.slot, { gripper = action.gripper, centre = action.centre or nil })
      action.is_placed = true
    end
    if action.map then
      commands.map(action.station, { gripper = action.gripper })
    end
  end

  function play.swap(action)
    if action.has_taken then
      commands.put(action.station, action.slot, { gripper = action.gripper })
    else
      commands.swap(action.station, action.slot, { robot = action.robot })
    end
  end

  ----------------------------------------------------------------------------------------------------- errors

  -- Asks on_error of a failed command; it may move the robot. Returns what it says, and whether it failed itself.
  local function ask(problem)
    local on_error, tool = native.begin_on_error()
    if not on_error then
      return nil
    end
    local good, answer = pcall(on_error, tool, problem)
    native.end_on_error()
    if not good then
      native.fail_flow("on_error failed")
      error(answer, 0)
    end
    return answer
  end

  -- True if another gripper of this one's robot holds a wafer.
  local function holds_another(gripper)
    for _, index in ipairs(lookup.on_robot(native.layout.grippers[gripper].robot)) do
      if index ~= gripper and native.sensor(index) then
        return true
      end
    end
    return false
  end

  -- True if the command that failed has done its work after all, as the gripper's sensor has it.
  local function is_done(action)
    local gripper = action.gripper and lookup.gripper(action.gripper)
    if action.what == "pick" then
      return native.sensor(gripper)
    end
    if action.what == "swap" then
      action.has_taken = holds_another(gripper)
      return action.has_taken and not native.sensor(gripper)
    end
    if calls[action.what] then
      return calls.is_done(action)
    end
    return action.what == "place" and not action.is_placed and not native.sensor(gripper)
  end

  -- "VAC: pick at PM1 1: error 74 WAFER_MISSING: ..."
  local function cause_of(action, robot, problem)
    local where = action.door or action.station .. (action.slot and " " .. action.slot or "")
    return ("%s%s at %s: %s"):format(robot and robot .. ": " or "", action.what, where, problem.text)
  end

  -- Plays an action to its end. False: it failed, and the flow ends with the cause.
  local function carry_out(action, robot, begin)
    while true do
      local good, problem = pcall(begin, action)
      if good then
        return true
      elseif type(problem) ~= "table" or math.type(problem.number) ~= "integer" then
        error(problem, 0)
      end
      local answer = ask { kind = "error", robot = robot, station = action.station, slot = action.slot, action = action.what,
                           number = problem.number, name = problem.name, text = problem.text }
      if answer ~= "retry" then
        native.fail_flow(type(answer) == "string" and answer or cause_of(action, robot, problem))
        return false
      elseif is_done(action) then
        return true
      end
      action.retries = (action.retries or 0) + 1
      if action.retries > most_retries then
        native.fail_flow(("%s; retried %d times"):format(cause_of(action, robot, problem), most_retries))
        return false
      end
    end
  end

  ------------------------------------------------------------------------------------------------------ tasks

  -- How many actions are under way.
  local under_way = 0

  -- Waits for what `take` gives, carries it out, and tells that; to the flow's end.
  local function serve(take, carry, done, index)
    local function wait()
      local first, second
      tasks.wait(function()
        first, second = take(index)
        return first ~= nil
      end, function()
        return "what the flow has for it"
      end)
      return first, second
    end
    local action, value = wait()
    while action do
      under_way = under_way + 1
      local good = carry(action, value)
      under_way = under_way - 1
      if not good then
        return
      end
      done(index)
      action, value = wait()
    end
  end

  local function serve_robot(index, name)
    serve(native.take_action, function(action)
      action.robot = #native.layout.robots > 1 and name or nil
      return calls.await_open(action.station) and carry_out(action, name, play[action.what])
    end, native.end_action, index)
  end

  -- Shuts the station's doors behind the blade.
  local function serve_doors(index, name)
    serve(native.take_shutting, function(doors)
      for _, door in ipairs(doors) do
        if not carry_out({ what = "close", station = name, door = door }, nil, function(action)
          commands.close(action.door)
        end) then
          return false
        end
      end
      return true
    end, native.end_shutting, index)
  end

  local work = {}

  function work.align(action)
    commands.align(action.station, { angle = action.degrees })
  end

  function work.flip(action)
    commands.flip(action.station)
  end

  local function serve_work(index, name)
    serve(native.take_work, function(what, degrees)
      return carry_out({ what = what, station = name, degrees = degrees }, nil, work[what])
    end, native.end_work, index)
  end

  -- Carriers that come with lots, and go when these are over.
  local function serve_port(index, name)
    serve(native.take_call, function(what, carrier)
      local action = { what = what, station = name, carrier = carrier }
      if not carry_out(action, nil, calls[what]) then
        return false
      end
      local cause = what == "comes" and native.is_port_open(index) and calls.look(name, ask) or nil
      if cause then
        native.fail_flow(cause)
      end
      return not cause
    end, native.end_call, index)
  end

  -- Plays the flow's present instant; the book of slots hears of the wafers that robots which are times alone have
  -- carried.
  local function step_instant()
    local seconds = native.step_flow()
    local station, slot, is_there = native.next_carried()
    while station do
      local note = is_there and slot_map.note_put or slot_map.note_taken
      note { station = station, slot = slot }
      station, slot, is_there = native.next_carried()
    end
    return seconds
  end

  -- Asks on_error of a station that takes too long, or does not begin: "retry" waits for it as long again. False: all goes on.
  local function ask_of_stall()
    local station, name, action, text = native.take_stall()
    if not station then
      return false
    end
    local answer = ask { kind = "error", station = name, action = action, number = 110, name = "STATION_TIMEOUT", text = text }
    if answer ~= "retry" then
      native.fail_flow(type(answer) == "string" and answer or text)
    elseif not native.wait_on(station) then
      native.fail_flow(("%s; retried %d times"):format(text, most_retries))
    end
    return true
  end

  -- Plays the present instant; s until the next one, nil: the flow is over.
  local function step_once()
    local seconds = step_instant()
    while seconds and ask_of_stall() do
      seconds = step_instant()
    end
    return seconds
  end

  -- Steps the flow whenever something has ended, or is to.
  local function step()
    local lane = tasks.current().lane
    local seconds = step_once()
    while seconds do
      native.hold_mechanisms(false)
      native.start { dwell = seconds }
      tasks.wait(function()
        return native.is_flow_due() or not native.runs(lane)
      end, function()
        return "time to pass"
      end)
      if native.runs(lane) then
        native.drop_segment()
      else
        local good, problem = pcall(native.outcome)
        if not good and under_way == 0 then -- a STOP, and no command to hear of it
          native.fail_flow(type(problem) == "table" and problem.text or "STOPPED")
        end
      end
      seconds = step_once()
    end
  end

  -- The flow's step comes last, when all that ended in a slice has told so.
  local function begin_tasks(robots, stations, line)
    local list = {}
    local function add(name, body)
      list[#list + 1] = { name = name, line = line, body = function()
        local good, problem = pcall(body)
        if not good then
          native.fail_flow("an error of the script") -- so that the others come to their end
          error(problem, 0)
        end
      end }
    end
    for index, name in ipairs(robots) do
      add("the flow's " .. name, function()
        serve_robot(index, name)
      end)
    end
    for index, name in ipairs(stations) do
      local station = native.layout.stations[name]
      if station.doors then
        add("the flow's doors of " .. name, function()
          serve_doors(index, name)
        end)
      end
      if station.chuck then
        add("the flow's " .. name, function()
          serve_work(index, name)
        end)
      end
      if station.is_port then
        add("the flow's carriers at " .. name, function()
          serve_port(index, name)
        end)
      end
    end
    add("the flow", step)
    return list
  end

  local function play_flow(description)
    tasks.open()
    local robots, stations, line = native.begin_flow(description)
    local good, problem = pcall(tasks.beside, begin_tasks(robots, stations, line))
    under_way = 0
    if good then
      return native.end_flow()
    end
    native.end_flow(type(problem) == "table" and type(problem.text) == "string" and problem.text or tostring(problem))
    error(problem, 0)
  end

  ------------------------------------------------------------------------------------------------------ words

  function flows.flow(description)
    if rawget(native, "layout") and not native.layout.timed then
      return play_flow(description)
    end
    return native.flow(description)
  end

  -- The words that a cell of times alone has.
  local has = { flow = true, expect = true, cell = true, study = true, robot = true }

  -- Refuses the others: nothing stands anywhere in it.
  function flows.refuse(name)
    local layout = rawget(native, "layout")
    if layout and layout.timed and not has[name] then
      native.fail("BAD_ARGUMENT", name .. ": this cell's robots are times alone (expected flow, or robots with axes)")
    end
  end

  return flows
end
