-- Tasks run side by side, in simulated time. Each is a coroutine. The script itself is the first task, and
-- drives the others while it waits. Order within a slice: the step; segments that are over; then tasks go on in
-- the order of their creation until none can.
--
-- A command gets all mechanisms and stations that it needs at once, first come first served, and never holds one
-- while it waits for another. The station in which a robot stands stays the robot's own. Their words: task_words.lua.

-- Local copies: a script may set globals of these names.
local coroutine, error, ipairs, pcall, setmetatable = coroutine, error, ipairs, pcall, setmetatable
local table, tostring = table, tostring

-- The most tasks besides the script.
local MOST = 64
-- Only one station at a time has the edge sensors: a state brings one scan. A command that needs them always waits.
local SENSORS = "the edge sensors"
-- Only one pass at a time has the beams and probes: a state brings the latches of one arming.
local LATCHES = "the beams and probes"

return function(native, lookup)
  local resume, yield = coroutine.resume, coroutine.yield
  -- The value with which a task's coroutine yields; no script has it.
  local WAITS = setmetatable({}, { __metatable = false })
  local NONE = {}

  local script = { lane = 1, number = 0, name = "the script" }
  local current = script
  local tasks = {}     -- that are alive, in the order of their creation
  local failed = {}    -- that ended with an error which no task has got
  local lanes = {}     -- that are free, the next one last
  local created = 0    -- the number of tasks created
  local is_open = false   -- false: there are no tasks yet, and commands need not wait
  local held = {}      -- resource: the task whose command has it
  local keepers = {}      -- robot: the task whose command it executed last
  local beside = {}       -- tasks that module.beside plays, and the one that waits for them
  local is_ending = false -- the script itself is over, and waits for its tasks
  local requests = {}  -- of commands that wait for resources, in order

  local function switch(task)
    current = task
    native.switch(task.lane, task.number)
  end

  ------------------------------------------------------------------------------------------------- going on

  -- Takes the result of a task's turn; the script's own task is current again. An ended task gives
  -- its lane back.
  local function conclude(task, good, ...)
    switch(script)
    if good and coroutine.status(task.thread) ~= "dead" then
      return
    end
    task.is_over, task.thread = true, nil
    if good then
      task.results = table.pack(...)
    else
      task.problem, failed[#failed + 1] = (...), task
    end
    for place, alive in ipairs(tasks) do
      if alive == task then
        table.remove(tasks, place)
        break
      end
    end
    native.free_lane(task.lane)
    lanes[#lanes + 1] = task.lane
  end

  -- Lets this task go on until it waits or is over.
  local function go_on(task)
    switch(task)
    task.can_go_on = nil
    conclude(task, resume(task.thread))
  end

  -- The text of a deadlock: which task waits for what, in which line, and which one has it. The line of the current
  -- task is that of the error.
  local function complaint()
    local parts = {}
    local function add(task)
      if task.waits_for then
        local line = task ~= current and task.thread and native.line_in(task.thread) or 0
        parts[#parts + 1] = ("%s waits for %s%s"):format(task.name, task.waits_for(), line > 0 and ", in line " .. line or "")
      end
    end
    add(script)
    for _, task in ipairs(tasks) do
      add(task)
    end
    return table.concat(parts, "; ")
  end

  -- If nothing moves, ends waiting jobs as busy. True if there is one.
  local function refuse_waits()
    local is_any = false
    for _, task in ipairs(tasks) do
      if task.job and task.request then
        native.refuse_wait(task.lane)
        is_any = true
      end
    end
    return is_any
  end

  -- While the script waits, other tasks go on, and slices go out, until it can go on. It is asked again when a task
  -- has gone on, or slices have gone out.
  local function drive(can_go_on)
    while not can_go_on() do
      local place = 1
      local went, has_gone = false, false
      while place <= #tasks and not (has_gone and can_go_on()) do
        local task = tasks[place]
        has_gone = task.can_go_on()
        if has_gone then
          go_on(task)
          went = true
        end
        place = place + (tasks[place] == task and 1 or 0)
      end
      if not went then
        if native.runs() then
          native.advance()
        elseif not refuse_waits() then
          native.fail("DEADLOCK", complaint())
        end
      end
    end
  end

  -- The running task waits. `waits_for` names the reason.
  local function wait_until(can_go_on, waits_for)
    if can_go_on() then
      return
    end
    current.waits_for = waits_for
    if current == script then
      local good, problem = pcall(drive, can_go_on)
      current.waits_for = nil
      return good or error(problem, 0)
    end
    if not coroutine.isyieldable() then
      current.waits_for = nil
      native.fail("BUSY", "a command of a task within a function that C calls, such as table.sort's or string.gsub's")
    end
    local task = current
    task.can_go_on = task.job and function()
      return native.is_told(task.lane) or can_go_on()
    end or can_go_on
    yield(WAITS)
    task.waits_for = nil
    if task.job then
      native.heed()
    end
  end

  -- Like wait_until, for a wait without a segment; the wait is reported.
  local function wait_idle(can_go_on, waits_for)
    if not can_go_on() then
      native.waits(waits_for())
      local good, problem = pcall(wait_until, can_go_on, waits_for)
      native.waits(nil)
      return good or error(problem, 0)
    end
  end

  -- For a task's own coroutine: a wait within it passes through it.
  local function through(thread, good, first, ...)
    if good and first == WAITS then
      yield(WAITS)
      return through(thread, resume(thread))
    end
    return good, first, ...
  end

  local function through_resume(thread, ...)
    return through(thread, resume(thread, ...))
  end

  local function or_raise(thread, good, first, ...)
    if not good then
      if coroutine.status(thread) == "dead" then
        coroutine.close(thread)
      end
      error(first, 0)
    end
    return first, ...
  end

  local function open()
    if not is_open then
      is_open = true
      native.open_lanes()
      for lane = MOST + 1, 2, -1 do
        lanes[#lanes + 1] = lane
      end
      coroutine.resume = through_resume
      coroutine.wrap = function(body)
        local thread = coroutine.create(body)
        return function(...)
          return or_raise(thread, through_resume(thread, ...))
        end
      end
    end
  end

  ------------------------------------------------------------------------------------------------- segments

  local module = { MOST = MOST, open = open, wait_idle = wait_idle }

  -- Plays a segment, as native.play does, while others go on.
  function module.play(segment)
    if not is_open then
      return native.play(segment)
    end
    local lane = current.lane
    native.start(segment)
    wait_until(function()
      return not native.runs(lane)
    end, function()
      return "what it plays"
    end)
    return native.outcome()
  end

  ------------------------------------------------------------------------------------------------ resources

  local function holder(resource, needs)
    local robot = not held[resource] and module.stands_in(resource, needs.robot)
    return held[resource] or robot and (keepers[robot] or script) or nil
  end

  -- A resource of the request that another task has, or that an earlier request wants; and that task. For the
  -- station in which its robot stands, the request comes first.
  local function obstacle(request)
    for _, resource in ipairs(request.needs) do
      local owner = holder(resource, request.needs)
      if owner then
        return resource, owner
      end
    end
    for _, earlier in ipairs(requests) do
      if earlier == request then
        return nil
      end
      for _, resource in ipairs(earlier.needs) do
        if request.wants[resource] and not module.is_inside(resource, request.needs.robot) then
          return resource, earlier.task
        end
      end
    end
  end

  local function is_free(request)
    return obstacle(request) == nil
  end

  local function withdraw(request)
    for place, waiting in ipairs(requests) do
      if waiting == request then
        table.remove(requests, place)
        return
      end
    end
  end

  -- The tasks that a task waits for: those that it joins, or the owner of a resource that its command wants.
  local function waited_for(task)
    if task.joins then
      return task.joins
    elseif task.request then
      local _, owner = obstacle(task.request)
      return { owner }
    end
    return {}
  end

  -- The chain of tasks that wait for each other, beginning and ending with this task; or nil.
  local function find_cycle(task, from, seen)
    for _, other in ipairs(waited_for(from)) do
      if other == task then
        return from.name
      elseif not seen[other] and not other.is_over then
        seen[other] = true
        local rest = find_cycle(task, other, seen)
        if rest then
          return from.name .. ", " .. rest
        end
      end
    end
  end

  -- Refuses a wait of the running task that would never end.
  function module.refuse_cycle()
    if find_cycle(current, current, {}) then
      native.fail("DEADLOCK", complaint())
    end
  end

  -- Refuses an occupied station: without tasks the other robot would never leave.
  local function refuse_occupied(needs)
    for _, station in ipairs(needs) do
      local robot = lookup.has_several() and module.stands_in(station, needs.robot)
      if robot then
        native.fail("DEADLOCK", ("%s stands in %s: RECOVER or HOME of that one comes first"):format(
          lookup.robot_text(robot), station))
      end
    end
  end

  -- True if this task's last command has waited for what it needs in vain.
  function module.has_waited()
    return current.has_waited
  end

  -- The running task's command has all that it asked for.
  local function hold(request, needs)
    for _, resource in ipairs(request.needs) do
      held[resource] = current
    end
    request.needs.robot = needs.robot
    current.holds = request.needs
    native.hold_mechanisms(needs.robot or false, table.unpack(needs.chucks or NONE))
  end

  -- A command begins that needs some of these: { robot = index, station = NAME, chucks = list, scan = true, latches = true }.
  function module.take(needs)
    current.has_waited = false
    if not is_open or not needs then
      if needs then
        refuse_occupied(needs)
      end
      return native.hold_mechanisms(needs and needs.robot or false, table.unpack(needs and needs.chucks or {}))
    end
    local task = current
    local request = { task = current, needs = { robot = needs.robot }, wants = {} }
    if needs.robot then
      request.needs[1] = lookup.robot_text(needs.robot)
    end
    if needs.scan then
      request.needs[#request.needs + 1] = SENSORS
    end
    if needs.latches then
      request.needs[#request.needs + 1] = LATCHES
    end
    for _, station in ipairs(needs) do
      request.needs[#request.needs + 1] = station
    end
    for _, resource in ipairs(request.needs) do
      request.wants[resource] = true
    end
    if not task.job and is_free(request) then
      hold(request, needs)
      return
    end
    requests[#requests + 1] = request
    current.request = request
    local waits_for = function()
      local resource, owner = obstacle(request)
      local robot = owner == task and module.stands_in(resource, needs.robot)
      if robot then -- no other task will bring it out
        return ("%s, where %s stands, which has to leave first"):format(resource, lookup.robot_text(robot))
      end
      return ("%s, which %s has"):format(tostring(resource), owner and owner.name or "nobody")
    end
    local good, problem = pcall(function()
      if not is_free(request) then
        current.waits_for = waits_for
        local resource = obstacle(request)
        local is_sure = resource == SENSORS or resource == LATCHES
        if current.job and not current.may_wait and not is_sure then
          native.fail("BUSY", waits_for())
        end
        module.refuse_cycle()
        native.command_waits(true, is_sure)
        native.waits(waits_for())
      end
      wait_until(function()
        return native.is_told(task.lane) or is_free(request)
      end, waits_for)
      native.heed()
    end)
    current.request, current.waits_for = nil, nil
    withdraw(request)
    native.command_waits(false)
    current.has_waited = not good
    if not good then
      native.waits(nil)
      error(problem, 0)
    end
    hold(request, needs)
  end

  -- module.stands_in(resource, but): the robot, other than `but`, that stands in it, or nil; and
  -- module.is_inside(resource, robot): whether that robot does. Both are set by lua/mcs/parts.lua.

  -- The command has ended.
  function module.give_back()
    if not is_open or not current.holds then
      return
    end
    for _, resource in ipairs(current.holds) do
      held[resource] = nil
    end
    if current.holds.robot then
      keepers[current.holds.robot] = current
    end
    current.holds = nil
    native.hold_mechanisms(false)
  end

  -- The running task.
  function module.current()
    return current
  end

  --------------------------------------------------------------------------------------------- tasks begin and end

  -- Begins a task with `body`: it runs when its creator next waits.
  function module.begin(body)
    open()
    created = created + 1
    local task = { thread = coroutine.create(body), name = "task " .. created, number = created,
      lane = table.remove(lanes), line = native.line_of(body) }
    task.can_go_on = function()
      return true
    end
    tasks[#tasks + 1] = task
    return task
  end

  -- True if no other task may begin.
  function module.is_full()
    return #tasks == MOST
  end

  -- Somebody has got the error of this task.
  function module.forget_failed(task)
    for place, other in ipairs(failed) do
      if other == task then
        table.remove(failed, place)
        return
      end
    end
  end

  -- True if these tasks are over.
  function module.all_over(list)
    for _, task in ipairs(list) do
      if not task.is_over then
        return false
      end
    end
    return true
  end

  -- Waits as a command's segment does.
  module.wait = wait_until

  -- Plays these side by side until all are over: a list of { name, line, body }. In a slice they go on in this
  -- order. Raises the first error.
  function module.beside(list)
    local begun = {}
    beside[current] = true
    if #tasks + #list > MOST then
      native.fail("BAD_ARGUMENT", ("%d tasks are needed (expected at most %d)"):format(#tasks + #list, MOST))
    end
    for place, entry in ipairs(list) do
      local task = module.begin(entry.body)
      task.name, task.line, begun[place] = entry.name, entry.line, task
      beside[task] = true
    end
    wait_until(function()
      return module.all_over(begun)
    end, function()
      return "the end of " .. begun[1].name
    end)
    beside = {}
    local failure
    for _, task in ipairs(begun) do
      if not task.results then
        module.forget_failed(task)
        failure = failure or task
      end
    end
    if failure then
      error(failure.problem, 0)
    end
  end

  -- True if some task of the script goes on beside those that module.beside plays.
  function module.may_others_act()
    local may = not beside[script] and not is_ending
    for _, task in ipairs(tasks) do
      may = may or not beside[task]
    end
    return may
  end

  -- Raises the error of the first task that failed, if no task has got it.
  function module.raise_failed()
    if failed[1] then
      error(failed[1].problem, 0)
    end
  end

  -- The running task waits until all others are over. False if there never was one.
  function module.wait_for_all()
    if is_open then
      is_ending = true
      native.begin_word("the script's end")
      wait_idle(function()
        return #tasks == 0
      end, function()
        return "the end of all tasks"
      end)
    end
    return is_open
  end

  ----------------------------------------------------------------------------------------------------- jobs

  -- Gives up all tasks after a stop outside of Lua.
  local function abandon()
    for place = #tasks, 1, -1 do
      local task = table.remove(tasks, place)
      coroutine.close(task.thread)
      native.free_lane(task.lane)
      lanes[#lanes + 1] = task.lane
    end
    held, requests, failed = {}, {}, {}
    switch(script)
  end

  -- Begins a job without a handle: handles are kept, and a host sends many jobs.
  local function begin_job(execute, job)
    local task = module.begin(function()
      local line = job.line
      native.begin_job(job.number)
      while line do
        line = native.end_line(job.number, execute(line))
      end
    end)
    task.job, task.may_wait, task.name = job.number, job.may_wait, "another port"
    task.bound, task.station = job.robot, job.station
  end

  -- Plays the lines of jobs side by side, each job's one after another, until none is left. They come from hosts at
  -- several ports. execute(line) returns the number of the error and the answer.
  function module.serve(execute)
    if created > 0 then
      abandon()
    end
    drive(function()
      local job = native.next_job()
      while job do
        begin_job(execute, job)
        job = native.next_job()
      end
      return #tasks == 0
    end)
    module.raise_failed()
  end

  function module.is_any_alive()
    return #tasks > 0
  end

  return module
end
