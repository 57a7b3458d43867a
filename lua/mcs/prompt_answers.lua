-- The actions of typed commands, with their answers: each function gets the arguments, a list, and the options, a table, and
-- returns the answer's values as text, or nil.

return function(native, commands, queries, lookup, tokens, states, keep, background)
  local answers = {}

  -- WHERE stops after this many bytes: an answer is one line.
  local LONGEST_ANSWER = 60000

  -- Runs a command and returns how long it took.
  local function timed(action, ...)
    local begin = native.utime()
    action(...)
    return { "seconds", (native.utime() - begin) / 1e6 }
  end

  local function held_wafers()
    local held = {}
    for index in ipairs(native.layout.grippers) do
      held[index] = native.held(index)
    end
    return held
  end

  local function effector_for(arguments, options)
    local station = lookup.station(arguments[1])
    local robot = lookup.robot_for(station.name, options)
    return lookup.effector(options.gripper, station.by[robot] or nil, robot)
  end

  -- By robot: the answer of its held command, which CONTINUE gives, too.
  local answers_held = {}

  function states.keep()
    local put_back, is_as_was = keep()
    local robots = #native.layout.robots
    local answers = table.move(answers_held, 1, robots, 1, {})
    return function()
      put_back()
      answers_held = table.move(answers, 1, robots, 1, {})
    end, is_as_was
  end

  -- Runs a command that may be held in a phase. `answer` makes the pairs before the time.
  local function carried(answer, action, ...)
    local time = timed(action, ...)
    local list = answer()
    list[#list + 1] = time
    local phase = lookup.phase()
    list[#list + 1] = phase and { "stop", phase }
    answers_held[lookup.last_robot()] = answer
    return tokens.pairs(list)
  end

  -- Returns a function for the command's gripper, found when the command is first answered: a later CONTINUE need not
  -- name a robot.
  local function asker(arguments, options)
    local gripper
    return function()
      gripper = gripper or effector_for(arguments, options)
      return gripper
    end
  end

  function answers.get(arguments, options)
    local gripper = asker(arguments, options)
    return carried(function()
      return { { "wafer", native.held(gripper()) } }
    end, commands.get, arguments[1], arguments[2], options)
  end

  function answers.put(arguments, options)
    local held, before, gripper = held_wafers(), commands.centring(), asker(arguments, options)
    return carried(function()
      local list, seen = { { "wafer", held[gripper()] } }, commands.centring()
      if seen and seen ~= before then
        list[2], list[3], list[4] = { "dx", seen.dx }, { "dy", seen.dy }, { "sd", seen.sd }
      end
      return list
    end, commands.put, arguments[1], arguments[2], options)
  end

  -- Runs a SWAP; the answer has the taken wafer and the put one.
  function answers.swap(arguments, options)
    local before = held_wafers()
    return carried(function()
      local after, taken, put_down = held_wafers(), nil, nil
      for index, gripper in ipairs(native.layout.grippers) do
        taken = taken or gripper.on_robot and not before[index] and after[index]
        put_down = put_down or gripper.on_robot and not after[index] and before[index]
      end
      return { { "wafer", taken or nil }, { "put", put_down or nil } }
    end, commands.swap, arguments[1], arguments[2], options)
  end

  -- "3" as a number, "1,3" as a list.
  local function slots_of(text)
    if not text or text:match("^%d+$") then
      return text and math.tointeger(tonumber(text))
    end
    local list = {}
    for slot in text:gmatch("[^,]+") do
      list[#list + 1] = slot:match("^%d+$") and math.tointeger(tonumber(slot))
    end
    if not text:find("^%d+[%d,]*$") then
      native.fail("BAD_ARGUMENT", ("wafers: %s (expected how many, or slots such as 1,3)"):format(lookup.quote(text)))
    end
    return list
  end

  -- "3:crossed,5:double" as a table.
  local function changes_of(text)
    local changes = text and {} or nil
    for part in (text or ""):gmatch("[^,]+") do
      local slot, how = part:match("^(%d+):(%a+)$")
      if not slot then
        native.fail("BAD_ARGUMENT", ("slots: %s (expected SLOT:HOW, such as 3:crossed)"):format(lookup.quote(part)))
      end
      changes[math.tointeger(tonumber(slot))] = how
    end
    return changes
  end

  function answers.carrier(arguments, options)
    local name
    local time = timed(function()
      name = commands.carrier(arguments[1], { name = options.name, at = options.at, wafers = slots_of(options.wafers),
        slots = changes_of(options.slots) })
    end)
    return tokens.pairs({ { "carrier", name }, time })
  end

  function answers.port_map(arguments)
    local codes = queries.port_map(arguments[1])
    return ("codes=%s"):format(codes and table.concat(codes) or "none")
  end

  function answers.continue()
    local answer
    local function answer_again()
      return answer()
    end
    return carried(answer_again, function()
      commands.continue()
      answer = answers_held[lookup.last_robot()]
    end)
  end

  function answers.map(arguments, options)
    local codes
    local time = timed(function() codes = commands.map(arguments[1], options) end)
    return ("codes=%s %s"):format(table.concat(codes), tokens.pairs { time })
  end

  -- The answer has the number of samples, and the least and the most of those that came; the samples
  -- themselves are published.
  function answers.edge_scan(arguments)
    local scan, least, most
    local time = timed(function() scan = commands.edge_scan(arguments[1]) end)
    for _, sample in ipairs(scan.samples) do
      if sample >= 0 then
        least = math.min(least or sample, sample)
        most = math.max(most or sample, sample)
      end
    end
    return tokens.pairs { { "count", scan.count }, { "first", scan.first }, { "missed", scan.missed },
      { "least", least }, { "most", most }, time }
  end

  -- The fields of an answer in order, with their names there.
  local ALIGNED = {
    { "mark", "mark" }, { "eccentricity", "eccentricity" }, { "direction", "direction_deg" }, { "dx", "dx" },
    { "dy", "dy" }, { "notch", "notch_deg" }, { "turn", "turn_deg" }, { "correction", "correction" },
    { "correction_angle", "correction_angle_deg" }, { "after_dx", "after_dx" }, { "after_dy", "after_dy" },
    { "after_notch", "after_notch_deg" }, { "radius", "radius" }, { "sd_centre", "sd_centre" },
    { "sd_notch", "sd_notch_deg" }, { "seconds", "seconds" },
  }

  function answers.align(arguments, options)
    local list = {}
    options.angle = arguments[2]
    local found = commands.align(arguments[1], options)
    for _, field in ipairs(ALIGNED) do
      list[#list + 1] = found[field[1]] and { field[2], found[field[1]] }
    end
    return tokens.pairs(list)
  end

  local CALIBRATED = { "offset", "sd_offset", "zero", "sd_zero", "gain", "sd_gain", "latency", "sd_latency",
    "mismatch", "seconds" }

  function answers.calibrate(arguments, options)
    local list = {}
    local found = commands.calibrate(arguments[1], options)
    for place, name in ipairs(CALIBRATED) do
      list[place] = { name, found[name] }
    end
    return tokens.pairs(list)
  end

  function answers.teach(arguments, options)
    local taught
    local time = timed(function() taught = commands.teach(arguments[1], options) end)
    return tokens.pairs {
      { "x", taught.at[1] }, { "y", taught.at[2] }, { "z", taught.at[3] }, { "yaw_deg", taught.rpy[3] }, time,
    }
  end

  local function offset_text(dx, dy, dz, tilt)
    return tokens.pairs { { "dx", dx }, { "dy", dy }, { "dz", dz }, { "tilt_deg", tilt } }
  end

  function answers.offset(arguments)
    return offset_text(queries.offset(arguments[1], arguments[2], arguments[3]))
  end

  function answers.proximity(arguments)
    local p = queries.proximity(arguments[1], arguments[2])
    local failed = {}
    for condition in pairs(p.failed) do
      failed[#failed + 1] = condition
    end
    return tokens.pairs {
      { "ready", tostring(p.ready) }, { "n1_proj_n2", p.n1_proj_n2 }, { "dr_proj_z", p.dr_proj_z },
      { "dr_proj_x", p.dr_proj_xy[1] }, { "dr_proj_y", p.dr_proj_xy[2] },
      { "dr_proj_xy_norm", p.dr_proj_xy_norm },
    } .. " failed=" .. (#failed > 0 and table.concat(failed, ",") or "none")
  end

  function answers.measure(arguments)
    local found = queries.measure(arguments[1], arguments[2])
    return tokens.pairs {
      { "distance", found.distance }, { "dx", found.dx }, { "dy", found.dy }, { "dz", found.dz },
      { "angle_deg", found.angle }, { "turn_deg", found.turn }, { "heading_deg", found.heading },
    }
  end

  function answers.distance(arguments)
    return tokens.pairs { { "distance", queries.distance(arguments[1], arguments[2]) } }
  end

  function answers.angle(arguments)
    return tokens.pairs { { "angle_deg", queries.angle(arguments[1], arguments[2]) } }
  end

  local function describe_wafer(layout, name, index)
    local station, slot = native.locate(index)
    local holder = native.holder(index)
    holder = holder and layout.grippers[holder].name
    local text = tokens.pairs { { "wafer", name }, { "holder", holder }, { "station", station } }
    if station then
      local offset_there = offset_text(native.measure(index, layout.stations[station].index, slot))
      text = ("%s slot=%d %s"):format(text, slot, offset_there)
    end
    return text
  end

  function answers.where(arguments)
    local list, bytes = {}, 0
    local layout = native.layout
    local asked = #arguments > 0 and arguments or native.wafer_names()
    for place, name in ipairs(asked) do
      if bytes > LONGEST_ANSWER then
        list[#list + 1] = ("and %d more"):format(#asked - #list)
        break
      end
      list[#list + 1] = describe_wafer(layout, name, asked == arguments and lookup.wafer(name) or place)
      bytes = bytes + #list[#list]
    end
    return table.concat(list, "; ")
  end

  function answers.axes()
    local at, list = native.axes(), {}
    for _, robot in ipairs(native.layout.robots) do
      local owner = lookup.has_several() and tokens.spell(robot.name) .. "." or ""
      for _, axis in ipairs(robot.axes) do
        local position = at[axis.index]
        list[#list + 1] = { owner .. axis.name, axis.turns and math.deg(position) or position }
      end
    end
    for _, gripper in ipairs(native.layout.grippers) do
      if gripper.axis then
        local position = at[gripper.axis]
        list[#list + 1] = { tokens.spell(gripper.name), gripper.kind == "pins" and position or math.deg(position) }
      end
    end
    return tokens.pairs(list)
  end

  function answers.stations()
    local list = {}
    for name, station in pairs(native.layout.stations) do
      local chuck = station.chuck and { "chuck", native.layout.grippers[station.chuck].name }
      list[#list + 1] = tokens.pairs { { "station", name }, { "slots", station.slots }, chuck }
    end
    return table.concat(list, "; ")
  end

  function answers.station(arguments, options)
    local found, list = queries.station(arguments[1], options), { { "station", arguments[1] } }
    for _, name in ipairs(lookup.standing) do
      list[#list + 1] = found[name] and { name, found[name] }
    end
    return tokens.pairs(list)
  end

  function answers.set_station(arguments, options)
    commands.set_station(arguments[1], options)
    return answers.station(arguments, { robot = options.robot, gripper = options.gripper })
  end

  function answers.alarm(arguments)
    return tokens.pairs { { "fault", commands.fault { error = arguments[1] } } }
  end

  -- A script's command that takes its arguments in order; the answer has its time.
  function answers.moving(action)
    return function(arguments, options)
      return tokens.pairs { timed(action, arguments[1], arguments[2], options) }
    end
  end

  -- Likewise, of a command with one argument and options.
  function answers.moving_of_one(action)
    return function(arguments, options)
      return tokens.pairs { timed(action, arguments[1], options) }
    end
  end

  function answers.pattern(arguments, options)
    return carried(function() return {} end, commands.pattern, arguments[1], arguments[2], arguments[3], options)
  end

  -- While a command runs, STOP bypasses the queue. Here no command runs, but one may be held.
  function answers.stop()
    background.stop()
    commands.stop()
  end

  -- The host executes RESET, which begins the session anew. It comes here only with a word too many.
  function answers.reset()
  end

  -- A task that was begun has no command in the record before simulated time passes.
  function answers.status()
    local text, tasks = native.status(), background.running()
    return tasks and (text:gsub("^phase=idle", function()
      return "phase=running " .. tasks
    end)) or text
  end

  function answers.controller(_, options)
    local found, list = commands.controller(next(options) ~= nil and options or nil), {}
    for _, name in ipairs(lookup.controller_fields) do
      list[#list + 1] = found[name] and { name, found[name] }
    end
    return tokens.pairs(list)
  end

  local function place()
    return tokens.pairs { { "time", native.utime() / 1e6 } }
  end

  function answers.save(arguments)
    states.save(arguments[1])
    return place()
  end

  function answers.restore(arguments)
    states.restore(arguments[1])
    return place()
  end

  function answers.undo()
    local line, left = states.undo()
    return tokens.pairs { { "undone", line }, { "left", left } } .. " " .. place()
  end

  function answers.version()
    return tokens.pairs { { "version", native.version() } }
  end

  function answers.quit()
    native.fail("NO_SUCH_COMMAND", "QUIT is for the prompt alone")
  end

  function answers.clear(arguments)
    commands.clear_fault(arguments[1])
  end

  function answers.holder(arguments)
    return tokens.pairs { { "holder", queries.holder(arguments[1]) } }
  end

  -- A command that takes a table of named numbers.
  function answers.moving_by_name(action)
    return function(_, options)
      return tokens.pairs { timed(action, options) }
    end
  end

  return answers
end
