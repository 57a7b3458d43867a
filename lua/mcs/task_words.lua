-- The words of tasks: task and join, signal and await; and the script's end, which waits for all tasks.

-- Local copies: a script may set globals of these names.
local error, ipairs, math, pairs, pcall, print = error, ipairs, math, pairs, pcall, print
local select, setmetatable, table, type = select, setmetatable, table, type

return function(native, lookup, tasks)
  local words = {}
  local signals = {} -- name: the number not yet taken
  local waiters = {} -- name: the tasks that await it, in order

  local handles = {}
  local handle_metatable = {
    __name = "task",
    __metatable = false,
    __tostring = function(handle)
      return handles[handle].name
    end,
  }

  local function task_of(value, place)
    local task = type(value) == "table" and handles[value]
    if not task then
      local text = "task %d: %s (expected what task() has returned)"
      native.fail("BAD_ARGUMENT", text:format(place, lookup.quote(value)))
    end
    return task
  end

  -- Begins a task with `body`: it runs when its creator next waits.
  function words.task(body)
    if type(body) ~= "function" then
      native.fail("BAD_ARGUMENT", ("body: %s (expected a function)"):format(lookup.quote(body)))
    elseif tasks.is_full() then
      native.fail("BAD_ARGUMENT", ("%d tasks are alive (expected no more)"):format(tasks.MOST))
    end
    local handle = setmetatable({}, handle_metatable)
    handles[handle] = tasks.begin(body)
    return handle
  end

  -- Waits until these tasks are over; returns what they returned, one after another, or raises the first's error.
  function words.join(...)
    local list, names, results, current = {}, {}, {}, tasks.current()
    for place = 1, select("#", ...) do
      list[place] = task_of((select(place, ...)), place)
      names[place] = list[place].name
      if list[place] == current then
        native.fail("BAD_ARGUMENT", ("%s joins itself (expected another task)"):format(current.name))
      end
    end
    current.joins = list
    current.waits_for = function()
      return "the end of " .. table.concat(names, ", ")
    end
    local good, problem = pcall(function()
      tasks.refuse_cycle()
      tasks.wait_idle(function()
        return tasks.all_over(list)
      end, current.waits_for)
    end)
    current.joins, current.waits_for = nil, nil
    if not good then
      error(problem, 0)
    end
    for _, task in ipairs(list) do
      if not task.results then
        tasks.forget_failed(task)
        error(task.problem, 0)
      end
      table.move(task.results, 1, task.results.n, (results.n or 0) + 1, results)
      results.n = (results.n or 0) + task.results.n
    end
    return table.unpack(results, 1, results.n or 0)
  end

  local function check_name(name)
    if type(name) ~= "string" then
      native.fail("BAD_ARGUMENT", ("name: %s (expected a text)"):format(lookup.quote(name)))
    end
    return name
  end

  local function hand_out(name)
    local queue = waiters[name] or {}
    while #queue > 0 and (signals[name] or 0) > 0 do
      table.remove(queue, 1).is_taken = true
      signals[name] = signals[name] - 1
    end
  end

  -- Adds n signals of that name, for those who await them.
  function words.signal(name, n)
    n = n == nil and 1 or n
    if math.type(n) ~= "integer" or n < 1 or n > 1000000 then
      native.fail("BAD_ARGUMENT", ("n: %s (expected a whole number from 1 to 1000000)"):format(lookup.quote(n)))
    end
    signals[check_name(name)] = (signals[name] or 0) + n
    hand_out(name)
  end

  local function leave(name, waiter)
    for place, other in ipairs(waiters[name]) do
      if other == waiter then
        table.remove(waiters[name], place)
        return
      end
    end
  end

  -- Takes one signal of that name, and waits for it if there is none: at most so many simulated seconds. False: none came.
  function words.await(name, timeout)
    local waiter = {}
    waiters[check_name(name)] = waiters[name] or {}
    local queue, limit = waiters[name], timeout ~= nil and lookup.number("timeout", timeout, lookup.ranges.seconds)
    queue[#queue + 1] = waiter
    hand_out(name)
    if not waiter.is_taken and limit then
      tasks.open()
      native.hold_mechanisms(false)
      native.start { dwell = limit }
    end
    local lane = tasks.current().lane
    local good, problem = pcall(tasks.wait_idle, function()
      return waiter.is_taken or limit and not native.runs(lane)
    end, function()
      return "a signal " .. lookup.quote(name)
    end)
    if not waiter.is_taken then
      leave(name, waiter)
    elseif limit then
      native.drop_segment()
    end
    if not good then
      error(problem, 0)
    elseif limit and not waiter.is_taken then
      native.outcome()
    end
    return waiter.is_taken == true
  end

  -- The script has come to its end; the run ends when all tasks are over. A failed task whose error no task has got
  -- fails the run.
  local function finish()
    if not tasks.wait_for_all() then
      return
    end
    local names = {}
    for name, count in pairs(signals) do
      names[#names + 1] = count > 0 and name or nil
    end
    table.sort(names)
    for _, name in ipairs(names) do
      print(("signal %s: %d left that nobody awaited"):format(lookup.quote(name), signals[name]))
    end
    tasks.raise_failed()
  end

  return words, finish
end
