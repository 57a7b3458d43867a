-- Patterns of one's own: a Lua file that a layout or a script names returns functions, which take the place of ours or
-- come beside them. They are planned and played as ours are. Each runs in a coroutine of its own, within that of the
-- pattern, so that its errors can be told by file and line.

-- Local copies: a script may set globals of these names.
local coroutine, error, getmetatable, ipairs, math, next, pairs = coroutine, error, getmetatable, ipairs, math, next, pairs
local pcall, rawget, setmetatable, table, tostring, type = pcall, rawget, setmetatable, table, tostring, type

-- The most requests of one run of a pattern.
local MOST = 1000

-- A blade that is nearer to its place than this, mm, is there.
local BESIDE = 1e-3

return function(native, lookup, patterns, steps, own_steps)
  local own = {}

  -- The patterns that may be replaced.
  local NAMES = { "get", "put", "swap", "ready", "map", "recover" }

  -- Ours, as they are without a file.
  local shipped = {}
  for _, name in ipairs(NAMES) do
    shipped[name] = patterns[name]
  end

  -- The file that the script names, or nil; the added patterns by name; true while user's code of the file runs.
  local said, added, is_running = nil, {}, false

  ----------------------------------------------------------------------------------------------------- faults

  -- A fault of the file is no error of the cell: nothing takes it for a refused motion.
  local fault_metatable = { __metatable = "waferhand.fault", __tostring = function(fault)
    return fault.message
  end }

  local function fail(place, text, ...)
    error(setmetatable({ message = ("%s: %s"):format(place, text:format(...)) }, fault_metatable), 0)
  end

  local function is_fault(problem)
    return type(problem) == "table" and getmetatable(problem) == "waferhand.fault"
  end

  -- Like pcall, but a fault of the file is raised again.
  function own.attempt(action, ...)
    local function conclude(good, ...)
      if not good and is_fault((...)) then
        error((...), 0)
      end
      return good, ...
    end
    return conclude(pcall(action, ...))
  end

  -- Raises the error with which a pattern has ended: { error, its place, how a message of Lua begins there }.
  local function fail_at(entry, ended)
    local problem, place, short = table.unpack(ended)
    if is_fault(problem) then
      error(problem, 0)
    end
    local text = native.outside(tostring(problem))
    if short ~= "" and text:sub(1, #short) == short then
      text = text:sub(#short + 1)
    end
    fail(place ~= "" and place or entry.path, "%s: %s", entry.name, text)
  end

  -- Refuses a script's word in a pattern, and while the file is read.
  function own.refuse(word)
    if is_running then
      error(("%s is a script's word (expected the steps that a pattern gets)"):format(word), 0)
    end
  end

  ---------------------------------------------------------------------------------------------------- results

  local PLUNGER = { "jammed", "unmoved", "unclosed", "unopened", "disagree" }

  local function add_all(list, words)
    for _, word in ipairs(words) do
      list[#list + 1] = word
    end
    return list
  end

  local function get_results(target)
    return add_all({ "taken", "missing", "late", "early" }, target.plunger and PLUNGER or {})
  end

  local function put_results(target)
    local list = add_all({ "kept", "stuck" }, target.chuck and { "lost", "loose" } or {})
    add_all(list, target.centre and { "uncentred" } or {})
    return add_all(list, target.plunger and PLUNGER or {})
  end

  -- By pattern: what it may return, a list of words. The others return nothing.
  local RESULTS = {
    get = get_results, put = put_results,
    swap = function(target)
      return add_all(put_results(target.put), table.move(get_results(target.get), 2, #PLUNGER + 4, 1, {}))
    end,
  }

  -- The place of a pattern's result.
  local function end_of(entry)
    local line = native.line_of(entry.play)
    return line > 0 and ("%s:%d"):format(entry.path, line) or entry.path
  end

  local function fail_result(entry, became, expected)
    fail(end_of(entry), "%s: returned %s (expected %s)", entry.name,
      lookup.quote(became), expected)
  end

  -- An added pattern returns nothing, or the name of a numbered error and why.
  local function check_added(entry, became, why)
    if became == nil then
      return nil
    elseif type(became) ~= "string" or became == "OK" or not lookup.errors[became] or why ~= nil and type(why) ~= "string" then
      fail_result(entry, became, "nothing, or the name of an error and a text")
    end
    return became .. (why and " " .. why or "")
  end

  local function check_result(entry, target, became, why)
    if entry.is_added then
      return check_added(entry, became, why)
    end
    local words = RESULTS[entry.name] and RESULTS[entry.name](target)
    for _, word in ipairs(words or {}) do
      if became == word then
        return became
      end
    end
    if words or became ~= nil then
      fail_result(entry, became, words and lookup.listed(words) or "nothing")
    end
  end

  ------------------------------------------------------------------------------------------------------- a run

  -- A request as text: what it asks for, to the last bit.
  local function sign(request)
    local parts = {}
    local function add(key, value)
      if type(value) == "number" then
        parts[#parts + 1] = ("%s=%.17g"):format(key, value)
      elseif type(value) ~= "table" then
        parts[#parts + 1] = ("%s=%s"):format(key, tostring(value))
      end
    end
    for key, value in pairs(request) do
      add(key, value)
      for inner, part in pairs(key ~= "target" and key ~= "enters" and type(value) == "table" and value or {}) do
        add(("%s.%s"):format(key, inner), part)
      end
    end
    return table.concat(parts, " ")
  end

  local function is_same_answer(one, other)
    return one == other or type(one) == "table" and type(other) == "table" and one[1] == other[1] and one[2] == other[2]
  end

  -- A pattern runs once to be planned, and may run again while that plan is played. The first time it is kept with the
  -- target what it asked and what was answered; as long as the answers are those, it must ask the same.
  local function follow(entry, target)
    local log = target.asked[entry.name] or {}
    local count, is_as_before = 0, true
    target.asked[entry.name] = log

    local function refuse()
      fail(entry.path, "%s: asks for other steps when it runs again (expected the same: it is planned, then played)",
        entry.name)
    end

    local function ask(thread, request)
      count = count + 1
      if count > MOST then
        fail(native.place_in(thread), "%s: more than %d steps (expected a pattern that ends)", entry.name, MOST)
      end
      local asked, before = sign(request), log[count]
      if is_as_before and (before and before.asked ~= asked or not before and log.is_over) then
        refuse()
      end
      log[count] = { asked = asked, answer = is_as_before and before and before.answer }
    end

    local function hear(answer)
      local now = log[count]
      if now.answer ~= nil and not is_same_answer(now.answer, answer) then
        is_as_before, log.is_over = false, nil
        for later = count + 1, #log do
          log[later] = nil
        end
      end
      now.answer = answer
    end

    local function finish()
      if is_as_before and #log > count then
        refuse()
      end
      log.is_over = true
    end

    return ask, hear, finish
  end

  -- Follows where the blade is: a pattern ends outside of the station.
  local function watch(entry, target)
    local is_inside = target.stands ~= nil
    local function refuse(thread, text)
      fail(thread and native.place_in(thread) or end_of(entry), "%s: %s", entry.name, text)
    end
    return function(thread, request)
      if request.enters and is_inside then
        refuse(thread, "enter: the blade is in the station (expected leave before it)")
      elseif request.leaves and not is_inside then
        refuse(thread, "leave: the blade is not in the station (expected enter before it)")
      elseif (request.to or request.before) and is_inside then
        refuse(thread, "approach: the blade is in the station (expected leave before it)")
      end
      is_inside = (is_inside or request.enters ~= nil) and not request.leaves
    end, function()
      if is_inside then
        refuse(nil, "ends in the station (expected leave)")
      end
    end
  end

  -- Follows which heights the blade sweeps in front of a station: a MAP's beams see what they pass, and no more. Returns
  -- the functions for a request and for the pattern's end.
  local function watch_beams(entry, target)
    local at
    local swept = {}   -- { from, to }, in order

    local function height_of(place)
      local height, inward = steps.beside(target.place, place)
      return math.abs(inward + target.retract) < BESIDE and height or nil
    end

    local function follow_line(line)
      local from = height_of(at)
      at = { at[1] + line[1], at[2] + line[2], at[3] + line[3] }
      local to = height_of(at)
      if from and to then
        swept[#swept + 1] = { math.min(from, to), math.max(from, to) }
      end
    end

    local function is_swept(from, to)
      for _, part in ipairs(swept) do
        if part[1] < from + BESIDE and part[2] > from then
          from = part[2]
        end
      end
      return from > to - BESIDE
    end

    return function(request)
      if request.to then
        at = { request.to.x, request.to.y, request.to.z }
      elseif request.line and at then
        follow_line(request.line)
      end
    end, function()
      table.sort(swept, function(one, other) return one[1] < other[1] end)
      local pitch, unseen = 2 * target.margin, {}
      for slot = 1, math.tointeger((target.height / pitch + 0.5) // 1) + 1 do
        local middle = (slot - 1) * pitch
        unseen[#unseen + 1] = not is_swept(middle - target.margin, middle + target.margin) and slot or nil
      end
      if unseen[1] then
        fail(end_of(entry), "%s: the beams do not pass all slots, not %s (expected a sweep in front of the station, by half a pitch "
          .. "below and above each slot)", entry.name, lookup.listed(unseen))
      end
    end
  end

  -- Runs the user's code until it asks for something: returns the request; or true and the results, or false and the
  -- error.
  local function resume(run, ...)
    local was = is_running
    is_running = true
    local good, first, second, third = coroutine.resume(run.thread, ...)
    is_running = was
    if not good then
      error(first, 0)
    end
    return first, second, third
  end

  -- The target keeps whose pattern it was, and a result that no step and no shipped pattern gave: nothing is known of
  -- its causes.
  local function note_source(entry, target, became)
    for _, part in ipairs({ target, target.get, target.put }) do
      part.source = { pattern = ("%s of %s"):format(entry.name, entry.path),
        claimed = became and ("%s: %s returned %s"):format(end_of(entry), entry.name, lookup.quote(became)) }
    end
  end

  -- Our own patterns that one may use: the one that it replaces, and the parts of a SWAP.
  local function ours(entry)
    local list = { [entry.name] = shipped[entry.name] }
    if entry.is_added or entry.name == "swap" then
      list.get, list.put = shipped.get, shipped.put
    end
    return list
  end

  local function play(entry, target)
    local run = { given = {}, thread = coroutine.create(function(...)
      return native.call_own(entry.play, ...)
    end) }
    local ask, hear, finish = follow(entry, target)
    local move, check_outside = watch(entry, target)
    local pass, check_passed = function() end, function() end
    if entry.name == "map" then
      pass, check_passed = watch_beams(entry, target)
    end
    local request, became, why = resume(run, own_steps.make(run, target, ours(entry)))
    while coroutine.status(run.thread) ~= "dead" do
      if not run.is_ours or type(request) ~= "table" then
        fail(native.place_in(run.thread), "%s: yields by itself (expected steps alone)", entry.name)
      end
      ask(run.thread, request)
      move(run.thread, request)
      pass(request)
      request.where = request.where and ("at %s, %s"):format(native.place_in(run.thread), request.where)
      local answer = coroutine.yield(request)
      hear(answer)
      request, became, why = resume(run, answer)
    end
    if not request then
      fail_at(entry, became)
    end
    finish()
    check_outside()
    check_passed()
    local result = check_result(entry, target, became, why)
    note_source(entry, target, not run.given[became] and became or nil)
    return result
  end

  --------------------------------------------------------------------------------------------------- the file

  local function make(path, name, value, is_added)
    if type(value) ~= "function" then
      fail(path, "%s: %s (expected a function)", name, lookup.quote(value))
    end
    local entry = { path = path, name = name, play = value, is_added = is_added }
    return function(target)
      return play(entry, target)
    end
  end

  local function take_added(path, list)
    if type(list) ~= "table" then
      fail(path, "added: %s (expected a table of functions)", lookup.quote(list))
    elseif next(list) == nil then
      fail(path, "added: an empty table (expected functions by name)")
    end
    for name, value in pairs(list) do
      if type(name) ~= "string" or not name:find("^[%a_][%w_]*$") then
        fail(path, "added: %s (expected names of letters, digits and _)", lookup.quote(name))
      end
      added[name] = make(path, "added." .. name, value, true)
    end
  end

  local function take(path, list)
    local known = add_all({ "added" }, NAMES)
    if type(list) ~= "table" then
      fail(path, "returns %s (expected a table of functions: %s)", lookup.quote(list), lookup.listed(known))
    end
    local is_any = false
    for name, value in pairs(list) do
      is_any = true
      if name == "added" then
        take_added(path, value)
      elseif shipped[name] then
        patterns[name] = make(path, name, value)
      else
        fail(path, "%s: no such pattern (expected %s%s)", lookup.quote(name), lookup.listed(known),
          lookup.nearest(name, known))
      end
    end
    if not is_any then
      fail(path, "returns an empty table (expected %s)", lookup.listed(known))
    end
  end

  -- patterns "FILE.lua", relative to the script.
  function own.patterns(path)
    if type(path) ~= "string" or path == "" then
      error(("patterns: %s (expected a file's path)"):format(lookup.quote(path)), 0)
    elseif said then
      error("patterns: given twice (expected one file of patterns a script)", 0)
    elseif rawget(native, "layout") then
      error("patterns: a cell was set up already (expected patterns before cell)", 0)
    end
    said = path
  end

  -- Takes the file that the script names, or else the layout. Without one nothing changes.
  function own.open(layout)
    local path, is_of_script = said or layout.patterns, said ~= nil
    if path and layout.timed then
      error(("%s: patterns: robots that are times alone have none (expected robots with axes)"):format(layout.path), 0)
    elseif path then
      is_running = true
      local good, list, where = pcall(native.patterns, path, is_of_script)
      is_running = false
      if not good then
        error(list, 0)
      end
      take(where, list)
    end
  end

  -- True while GET and PUT are ours.
  function own.has_shipped()
    return patterns.get == shipped.get and patterns.put == shipped.put
  end

  ------------------------------------------------------------------------------------------- added patterns

  function own.names()
    local list = {}
    for name in pairs(added) do
      list[#list + 1] = name
    end
    return list
  end

  -- The added pattern of this name.
  function own.find(name)
    local found = type(name) == "string" and added[name]
    if not found then
      local names = own.names()
      native.fail("BAD_ARGUMENT", ("pattern: %s (expected %s)"):format(lookup.quote(name),
        #names > 0 and lookup.listed(names) .. lookup.nearest(name, names)
          or "one that a file of patterns adds; there is none"))
    end
    return found
  end

  -- The number and text of what an added pattern has returned; nothing if it went well.
  function own.judge(became)
    if became then
      local name, why = became:match("^(%S+) ?(.*)$")
      native.fail(name, why ~= "" and why or nil)
    end
  end

  return own
end
