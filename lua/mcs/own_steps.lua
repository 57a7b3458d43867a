-- The steps that a pattern of one's own is made of: those of lua/mcs/steps.lua, with their arguments checked. A pattern
-- sees its target as a table of plain values, a view, and names its grippers "gripper" and "chuck".

-- Local copies: a script may set globals of these names.
local coroutine, error, ipairs, math, pairs, pcall, type = coroutine, error, ipairs, math, pairs, pcall, type
local yield = coroutine.yield

-- The longest way and the longest time of a step, mm and s.
local FARTHEST, LONGEST = 10000, 3600

-- The fields of a target that a view has with the values that they have there.
local PLAIN = { "station", "slot", "offset", "stroke", "retract", "release", "wait", "retries", "vacuum_delay", "timeout",
                "pickup_speed", "pickup_acceleration", "handover", "asks", "stop", "touch", "loaded", "margin", "height",
                "map_speed" }

return function(native, lookup, steps)
  local own = {}

  local OPEN, CLOSED = steps.OPEN, steps.CLOSED

  local function name_of(gripper)
    return gripper and native.layout.grippers[gripper].name
  end

  -- A target as a pattern of one's own sees it: a new table, so that no pattern changes what ours go by.
  local function view_of(target)
    local view = {}
    for _, field in ipairs(PLAIN) do
      view[field] = target[field]
    end
    view.robot = native.layout.robots[target.robot].name
    view.gripper, view.chuck = name_of(target.gripper), name_of(target.chuck)
    view.grip = native.layout.grippers[target.gripper].grip
    view.side = target.touch and "above" or "below"
    view.centre = target.centre and true or false
    view.enters_empty, view.enters_loaded = target.plane.enter(target, false), target.plane.enter(target, true)
    if target.stands then
      view.above, view.inside = steps.beside(target.place, target.stands)
      view.inside = view.inside + target.retract
    end
    return view
  end

  ---------------------------------------------------------------------------------------------------- arguments

  local function refuse(step, text, ...)
    error(("%s: %s"):format(step, text:format(...)), 0)
  end

  local function read_number(step, what, value, least, most, unit)
    if type(value) ~= "number" or not (value >= least and value <= most) then
      refuse(step, "%s: %s (expected a number from %.10g to %.10g %s)", what, lookup.quote(value), least, most, unit)
    end
    return value
  end

  local function read_word(step, what, value, ...)
    for _, word in ipairs({ ... }) do
      if value == word then
        return word
      end
    end
    refuse(step, "%s: %s (expected %s)", what, lookup.quote(value), lookup.listed({ ... }))
  end

  local function read_switch(step, what, value)
    if value ~= nil and type(value) ~= "boolean" then
      refuse(step, "%s: %s (expected true, false or nothing)", what, lookup.quote(value))
    end
    return value
  end

  ---------------------------------------------------------------------------------------------------------- steps

  -- By name: a function with the step's name, the target and the rest.
  local kinds = {}

  function kinds.approach(step, target, height)
    steps.approach(target, read_number(step, "height", height, -FARTHEST, FARTHEST, "mm"))
  end

  function kinds.enter(_, target)
    steps.enter(target)
  end

  function kinds.leave(_, target)
    local way
    if target.stands then
      local _, inward = steps.beside(target.place, target.stands)
      way = math.max(inward + target.retract, 0)
    end
    steps.leave(target, way)
  end

  -- Reads { speed = , acceleration = }.
  local function read_limits(step, target, limits)
    limits = limits == nil and {} or limits
    if type(limits) ~= "table" then
      refuse(step, "limits: %s (expected { speed = , acceleration = }, or nothing)", lookup.quote(limits))
    end
    for name in pairs(limits) do
      read_word(step, "limits", name, "speed", "acceleration")
    end
    local speed = limits.speed and read_number(step, "speed", limits.speed, 1e-6, FARTHEST, "mm/s")
    local acceleration = limits.acceleration and read_number(step, "acceleration", limits.acceleration, 1e-6, 1e6, "mm/s^2")
    return speed or target.pickup_speed, acceleration or target.pickup_acceleration
  end

  function kinds.stroke(step, target, by, limits)
    read_number(step, "by", by, -FARTHEST, FARTHEST, "mm")
    local speed, acceleration = read_limits(step, target, limits)
    yield { line = steps.upward(target.place, by), speed = speed, acceleration = acceleration, target = target, where = "in" }
  end

  -- To the left of the way in, seen from above the slot.
  local function leftward(place)
    local up, x, y, z = place.up or { 0, 0, 1 }, place.dir_x, place.dir_y, place.up and place.dir_z or 0
    return { up[2] * z - up[3] * y, up[3] * x - up[1] * z, up[1] * y - up[2] * x }
  end

  function kinds.line(step, target, inward, left, up, limits)
    read_number(step, "inward", inward, -FARTHEST, FARTHEST, "mm")
    read_number(step, "left", left, -FARTHEST, FARTHEST, "mm")
    read_number(step, "up", up, -FARTHEST, FARTHEST, "mm")
    local speed, acceleration = read_limits(step, target, limits)
    local along, aside, rise = steps.along(target.place, inward), leftward(target.place), steps.upward(target.place, up)
    local line = {}
    for i = 1, 3 do
      line[i] = along[i] + left * aside[i] + rise[i]
    end
    yield { line = line, speed = speed, acceleration = acceleration, target = target, where = "in" }
  end

  function kinds.wait(step, _, seconds)
    yield { dwell = read_number(step, "seconds", seconds, 0, LONGEST, "s") }
  end

  function kinds.pause(step, target, phase)
    steps.pause(target, read_word(step, "phase", phase, "extended", "up"))
  end

  -- The index of "gripper" or "chuck".
  local function read_who(step, target, who)
    local index = target[read_word(step, "who", who, "gripper", "chuck")]
    if not index then
      refuse(step, 'who: "chuck" (expected "gripper": %s is no prealigner and has no chuck)', target.station)
    end
    return index
  end

  local function read_valve(step, target, who)
    local index = read_who(step, target, who)
    if native.layout.grippers[index].grip == "passive" then
      refuse(step, 'who: "%s" (expected one with a valve: %s has passive pads)', who, name_of(index))
    end
    return index
  end

  function kinds.open(step, target, who)
    steps.switch(read_valve(step, target, who), OPEN)
  end

  function kinds.close(step, target, who)
    steps.switch(read_valve(step, target, who), CLOSED)
  end

  function kinds.hand_over(step, target, from, to)
    local giver, taker = read_valve(step, target, from), read_valve(step, target, to)
    if giver == taker then
      refuse(step, '"%s" to itself (expected "gripper" and "chuck", or the other way)', from)
    end
    steps.hand_over(target, giver, taker)
  end

  function kinds.is_on(step, target, who, assume)
    return steps.is_on(read_who(step, target, who), read_switch(step, "assume", assume) or false)
  end

  function kinds.is_loaded(step, target, who, assume)
    return steps.is_loaded(read_who(step, target, who), read_switch(step, "assume", assume))
  end

  function kinds.await(step, target, who, seconds)
    return steps.await(read_who(step, target, who), read_number(step, "seconds", seconds, 0, LONGEST, "s"))
  end

  function kinds.holds(step, target, who)
    return steps.holds(target, read_who(step, target, who))
  end

  function kinds.centre(_, target)
    return steps.centre(target)
  end

  function kinds.ready(step, target, loaded)
    return target.grip.ready(target, read_switch(step, "loaded", loaded) or false)
  end

  function kinds.take(_, target)
    return target.grip.take(target)
  end

  function kinds.give(_, target)
    return target.grip.give(target)
  end

  ------------------------------------------------------------------------------------------------------- one run

  -- The view of a target, the steps for one run of a pattern, which `run.thread` is, and our own patterns that it may
  -- use, from `shipped`. While one of them works, `run.is_ours` is true: requests come from nowhere else. `run.given` has
  -- the results that they gave.
  function own.make(run, target, shipped)
    local targets, made, ours = {}, {}, {}

    local function see(one)
      local view = view_of(one)
      targets[view] = one
      return view
    end

    local function add(list, name, needs_target, action)
      list[name] = function(view, ...)
        local real = targets[view]
        if coroutine.running() ~= run.thread then
          refuse(name, "called outside of its pattern (expected within it)")
        elseif needs_target and not real then
          refuse(name, "target: %s (expected the one that the pattern got)", lookup.quote(view))
        end
        run.is_ours = true
        local good, answer
        if needs_target then
          good, answer = pcall(action, name, real, ...)
        else
          good, answer = pcall(action, name, nil, view)
        end
        run.is_ours = false
        if not good then
          error(answer, 0)
        elseif type(answer) == "string" then
          run.given[answer] = true
        end
        return answer
      end
    end

    for name, action in pairs(kinds) do
      add(made, name, name ~= "wait", action)
    end
    for name, pattern in pairs(shipped) do
      add(ours, name, true, function(_, real)
        return pattern(real)
      end)
    end
    if target.get then
      local view = { get = see(target.get), put = see(target.put) }
      targets[view] = target
      return view, made, ours
    end
    return see(target), made, ours
  end

  return own
end
