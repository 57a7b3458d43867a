-- The commands that can be typed: for each its arguments, its options, its action, and its answer.
--
-- takes     kinds of the arguments in order; the last one may be left out if `optional`, repeated if `repeated`
-- options   kinds of the options by name; with `needs_option` at least one must be there
-- run       gets the arguments, a list, and the options, a table; returns the answer's values as text or nil

-- of_robot  true: a question; at a robot's own port it asks only that robot
-- asks      true: it has no record, so injected errors are looked for here
-- keeps     true: it changes nothing that UNDO could take back, or handles UNDO itself
-- alone     true: not while a task is alive

return function(native, commands, queries, lookup, tokens, states, keep, background, own)
  local prompt_commands = {}

  -- WHERE stops after this many bytes: an answer is one line.
  local LONGEST_ANSWER = 60000

  ------------------------------------------------------------------------------------------------------ kinds

  local function station_names()
    local list = {}
    for name in pairs(native.layout.stations) do
      list[#list + 1] = name
    end
    return list
  end

  -- The names of the layout's entries of a kind.
  local function names_of(kind)
    return function()
      return lookup.names_of(native.layout[kind])
    end
  end

  -- The names that FLIP accepts.
  local function flips_names()
    local list = lookup.names_of(native.layout.grippers)
    for name, station in pairs(native.layout.stations) do
      list[#list + 1] = station.flipper and name or nil
    end
    return list
  end

  local function command_names()
    local list = {}
    for name in pairs(prompt_commands.commands) do
      list[#list + 1] = name
    end
    return list
  end

  -- For each kind of argument the existing names, or nil for a number.
  prompt_commands.kinds = {
    station = station_names, gripper = names_of "grippers", wafer = native.wafer_names, command = command_names,
    fault = native.fault_kinds, frame = lookup.frames,
    handover = function() return lookup.parameters.handover.values end,
    vacuum_check = function() return lookup.parameters.vacuum_check.values end,
    switch = function() return { "true", "false" } end,
    phase = function() return lookup.phases end,
    mode = function() return lookup.align_fields.mode.values end,
    teaching = function() return { "beam", "touch" } end,
    mark = function() return lookup.align_fields.mark.values end,
    elbow = function() return { "left", "right" } end,
    up_or_down = function() return lookup.up_or_down.values end,
    side = function() return lookup.sides end,
    port_state = function() return lookup.port_states end,
    carrier = function() return native.layout.carriers end,
    pattern = own.names, door = names_of "doors", robot = names_of "robots", flips = flips_names,
    name = function() return {} end, save = states.names,
    slots = function() return {} end, changes = function() return {} end,
  }

  local station_options = { gripper = "gripper", force = "switch" }
  for name, kind in pairs(lookup.parameters) do
    station_options[name] = kind[2] and "number" or kind.values[1] == true and "switch" or name
  end

  -- The options of a command that carries a wafer: with its corrections, and where it stops.
  local function carrying_options(...)
    local options = {}
    for name, kind in pairs(station_options) do
      options[name] = kind
    end
    for _, prefix in ipairs({ ... }) do
      for _, name in ipairs(lookup.correction_fields) do
        options[prefix .. name] = "number"
      end
      options[prefix .. "stop"] = "phase"
      options[prefix .. "centre"] = "switch"
    end
    return options
  end

  local get_options, put_options = carrying_options(""), carrying_options("")
  local swap_options = carrying_options("get_", "put_")
  local pattern_options = {}
  for name, kind in pairs(get_options) do
    pattern_options[name] = kind
  end
  get_options.correct, swap_options.get_correct = "switch", "switch"
  swap_options.gripper = nil

  local align_options = { mode = "mode", mark = "mark", glass = "number", turns = "number", correct = "switch" }

  local function fields(list, options)
    options = options or {}
    for _, name in ipairs(list) do
      options[name] = "number"
    end
    return options
  end

  ---------------------------------------------------------------------------------------------------- answers

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

  local function get(arguments, options)
    local gripper = asker(arguments, options)
    return carried(function()
      return { { "wafer", native.held(gripper()) } }
    end, commands.get, arguments[1], arguments[2], options)
  end

  local function put(arguments, options)
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
  local function swap(arguments, options)
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

  local function carrier(arguments, options)
    local name
    local time = timed(function()
      name = commands.carrier(arguments[1], { name = options.name, at = options.at, wafers = slots_of(options.wafers),
        slots = changes_of(options.slots) })
    end)
    return tokens.pairs({ { "carrier", name }, time })
  end

  local function continue()
    local answer
    local function answer_again()
      return answer()
    end
    return carried(answer_again, function()
      commands.continue()
      answer = answers_held[lookup.last_robot()]
    end)
  end

  local function map(arguments, options)
    local codes
    local time = timed(function() codes = commands.map(arguments[1], options) end)
    return ("codes=%s %s"):format(table.concat(codes), tokens.pairs { time })
  end

  -- The answer has the number of samples, and the least and the most of those that came; the samples
  -- themselves are published.
  local function edge_scan(arguments)
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

  local function align(arguments, options)
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

  local function calibrate(arguments, options)
    local list = {}
    local found = commands.calibrate(arguments[1], options)
    for place, name in ipairs(CALIBRATED) do
      list[place] = { name, found[name] }
    end
    return tokens.pairs(list)
  end

  local function teach(arguments, options)
    local taught
    local time = timed(function() taught = commands.teach(arguments[1], options) end)
    return tokens.pairs {
      { "x", taught.at[1] }, { "y", taught.at[2] }, { "z", taught.at[3] }, { "yaw_deg", taught.rpy[3] }, time,
    }
  end

  local function offset_text(dx, dy, dz, tilt)
    return tokens.pairs { { "dx", dx }, { "dy", dy }, { "dz", dz }, { "tilt_deg", tilt } }
  end

  local function offset(arguments)
    return offset_text(queries.offset(arguments[1], arguments[2], arguments[3]))
  end

  local function proximity(arguments)
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

  local function measure(arguments)
    local found = queries.measure(arguments[1], arguments[2])
    return tokens.pairs {
      { "distance", found.distance }, { "dx", found.dx }, { "dy", found.dy }, { "dz", found.dz },
      { "angle_deg", found.angle }, { "turn_deg", found.turn }, { "heading_deg", found.heading },
    }
  end

  local function distance(arguments)
    return tokens.pairs { { "distance", queries.distance(arguments[1], arguments[2]) } }
  end

  local function angle(arguments)
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

  local function where(arguments)
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

  local function axes()
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

  local function stations()
    local list = {}
    for name, station in pairs(native.layout.stations) do
      local chuck = station.chuck and { "chuck", native.layout.grippers[station.chuck].name }
      list[#list + 1] = tokens.pairs { { "station", name }, { "slots", station.slots }, chuck }
    end
    return table.concat(list, "; ")
  end

  local function station(arguments, options)
    local found, list = queries.station(arguments[1], options), { { "station", arguments[1] } }
    for _, name in ipairs(lookup.standing) do
      list[#list + 1] = found[name] and { name, found[name] }
    end
    return tokens.pairs(list)
  end

  local function set_station(arguments, options)
    commands.set_station(arguments[1], options)
    return station(arguments, { robot = options.robot, gripper = options.gripper })
  end

  -- A command's options; for axes, those that the robots have.
  function prompt_commands.options(command)
    local options = command.options or {}
    if command.of_axes then
      local own = { robot = options.robot, gripper = options.gripper }
      for _, robot in ipairs(native.layout.robots) do
        for _, axis in ipairs(robot.axes) do
          own[axis.name] = options[axis.name]
        end
      end
      for name, kind in pairs(command.beside or {}) do
        own[name] = kind
      end
      options = own
    end
    return options
  end

  -- The form of a command: GET STATION SLOT [option=value ...]; with `all`, every option by name.
  function prompt_commands.usage(name, all)
    local command = prompt_commands.commands[name]
    local text = { name }
    for place, kind in ipairs(command.takes) do
      local word = (kind == "pattern" and "NAME" or kind:upper()) .. (command.repeated and place == #command.takes and " ..." or "")
      text[#text + 1] = command.optional and place == #command.takes and "[" .. word .. "]" or word
    end
    for option, kind in pairs(all and prompt_commands.options(command) or {}) do
      text[#text + 1] = ("[%s=%s]"):format(option, kind:upper())
    end
    if command.options and not all then
      text[#text + 1] = command.needs_option and "option=value ..." or "[option=value ...]"
    end
    return table.concat(text, " ")
  end

  function prompt_commands.refuse(name)
    local near = lookup.nearest(name, command_names())
    native.fail("NO_SUCH_COMMAND", ("%s (HELP lists them%s)"):format(name, near))
  end

  local function help(arguments)
    local name = arguments[1] and arguments[1]:upper()
    if not name then
      return table.concat(command_names(), " ") .. "; HELP COMMAND tells how it is typed"
    end
    if not prompt_commands.commands[name] then
      prompt_commands.refuse(arguments[1])
    end
    return ("%s: %s"):format(prompt_commands.usage(name, true), prompt_commands.commands[name].does)
  end

  -- The names of turns in a line, and the fault's options.
  local TURNS = { "rx", "ry", "rz" }
  local fault_options = { gripper = "gripper", wafer = "wafer", onto = "wafer", door = "door", station = "station" }
  for _, name in ipairs({ "value", "dx", "dy", "dz", "rx", "ry", "rz", "after", "lasting", "error", "beam" }) do
    fault_options[name] = "number"
  end

  local function fault(arguments, options)
    local description = { kind = arguments[1] }
    if not arguments[1] and not options.error then
      native.fail("BAD_ARGUMENT", ("too few words (expected %s)"):format(prompt_commands.usage("FAULT")))
    end
    for place, name in ipairs(TURNS) do
      if options[name] then
        description.rpy = description.rpy or { 0, 0, 0 }
        description.rpy[place] = options[name]
        options[name] = nil
      end
    end
    for name, value in pairs(options) do
      description[name] = value
    end
    return tokens.pairs { { "fault", commands.fault(description) } }
  end

  local function alarm(arguments)
    return tokens.pairs { { "fault", commands.fault { error = arguments[1] } } }
  end

  --------------------------------------------------------------------------------------------------- commands

  -- A script's command that takes its arguments in order; the answer has its time.
  local function moving(action)
    return function(arguments, options)
      return tokens.pairs { timed(action, arguments[1], arguments[2], options) }
    end
  end

  local function pattern(arguments, options)
    return carried(function() return {} end, commands.pattern, arguments[1], arguments[2], arguments[3], options)
  end

  -- While a command runs, STOP bypasses the queue. Here no command runs, but one may be held.
  local function stop()
    background.stop()
    commands.stop()
  end

  -- The host executes RESET, which begins the session anew. It comes here only with a word too many.
  local function reset()
  end

  -- A task that was begun has no command in the record before simulated time passes.
  local function status()
    local text, tasks = native.status(), background.running()
    return tasks and (text:gsub("^phase=idle", function()
      return "phase=running " .. tasks
    end)) or text
  end

  local function place()
    return tokens.pairs { { "time", native.utime() / 1e6 } }
  end

  local function save(arguments)
    states.save(arguments[1])
    return place()
  end

  local function restore(arguments)
    states.restore(arguments[1])
    return place()
  end

  local function undo()
    local line, left = states.undo()
    return tokens.pairs { { "undone", line }, { "left", left } } .. " " .. place()
  end

  local function version()
    return tokens.pairs { { "version", native.version() } }
  end

  local function quit()
    native.fail("NO_SUCH_COMMAND", "QUIT is for the prompt alone")
  end

  local function clear(arguments)
    commands.clear_fault(arguments[1])
  end

  local function holder(arguments)
    return tokens.pairs { { "holder", queries.holder(arguments[1]) } }
  end

  -- A command that takes a table of named numbers.
  local function moving_by_name(action)
    return function(_, options)
      return tokens.pairs { timed(action, options) }
    end
  end

  prompt_commands.commands = {
    GET = { takes = { "station", "slot" }, options = get_options, run = get,
            does = "takes the wafer there" },
    PUT = { takes = { "station", "slot" }, options = put_options, run = put,
            does = "sets the wafer down there" },
    CONTINUE = { takes = {}, run = continue,
                 does = "goes on with what is held, to its next stop or its end" },
    SWAP = { takes = { "station", "slot" }, options = swap_options, run = swap,
             does = "takes the wafer there with the empty gripper and puts down the other's" },
    READY = { takes = { "station", "slot" }, options = station_options, run = moving(commands.ready),
              does = "goes in front of the slot, to where GET or PUT enters" },
    PATTERN = { takes = { "pattern", "station", "slot" }, options = pattern_options, run = pattern,
                does = "plays a pattern that a file of patterns adds" },
    MAP = { takes = { "station" }, options = station_options, run = map,
            does = "sweeps over the slots: 0 empty, 1 single, 2 double, 3 protruded, 4 crossed, 5 thick, 6 thin" },
    TEACH = { takes = { "station" }, options = { by = "teaching", keep = "switch", yaw = "switch" }, run = teach,
              does = "finds out where the station truly is, by its beam and the wafer in slot 1, or by its block" },
    HOME = { takes = {}, run = moving(commands.home),
             does = "out of the station if the arm stands in one, then home" },
    RECOVER = { takes = {}, run = moving(commands.recover),
                does = "straight out of the station that the arm stands in" },
    TASK = { takes = { "command" }, repeated = true, keeps = true,
             does = "begins a command that goes on beside those that follow; tells the task's number" },
    JOIN = { takes = { "number" }, repeated = true, keeps = true, run = background.join,
             does = "waits until these tasks are over, and answers as their commands do" },
    TASKS = { takes = {}, keeps = true, run = background.list, does = "the tasks that were not joined" },
    SIGNAL = { takes = { "name", "number" }, optional = true, keeps = true, run = background.signal,
               does = "adds a signal of this name, or so many, for those who await it" },
    AWAIT = { takes = { "name", "seconds" }, optional = true, run = background.await,
              does = "takes one signal of this name, and waits for it, at most so long" },
    STOP = { takes = {}, run = stop, does = "ends the command that runs, gives up one that is held" },
    RESET = { takes = {}, run = reset, keeps = true,
              does = "reads the layout anew and begins another run, with the layout's wafers" },
    SAVE = { takes = { "name" }, run = save, keeps = true, alone = true,
             does = "keeps under this name all that simulator and motion control are" },
    RESTORE = { takes = { "save" }, run = restore, asks = true, alone = true,
                does = "puts back what was saved under this name" },
    UNDO = { takes = {}, run = undo, asks = true, keeps = true, alone = true,
             does = "takes back the last command that changed something, several times" },
    STATUS = { takes = {}, run = status, keeps = true,
               does = "what goes on, where the robot is, what is held, the last error" },
    VERSION = { takes = {}, run = version, keeps = true, does = "the program's version" },
    ROTATE = { takes = { "station", "degrees" }, run = moving(commands.rotate),
               does = "turns a prealigner's chuck by so much" },
    EDGE_SCAN = { takes = { "station" }, run = edge_scan,
                  does = "turns a prealigner's chuck once round while its edge sensor looks at the wafer" },
    ALIGN = { takes = { "station", "degrees" }, optional = true, options = align_options, run = align,
              does = "turns a prealigner's wafer until its notch points there, to 0 without degrees; "
                .. "the next GET makes good how it lies" },
    CALIBRATE = { takes = { "station" }, options = fields(lookup.names(lookup.calibrate_fields)), run = calibrate,
                  does = "finds out what a prealigner's edge sensor is off by, and takes it off from then on" },
    OPEN = { takes = { "door" }, run = moving(commands.open), does = "opens a door, and waits until it is" },
    CLOSE = { takes = { "door" }, run = moving(commands.close),
              does = "shuts a door, unless an arm stands in its station, and waits until it is shut" },
    LIFT = { takes = { "station", "up_or_down" }, run = moving(commands.lift),
             does = "UP: pins lift what lies on a prealigner's chuck; DOWN: they set it down there again" },
    VALVE = { takes = { "gripper", "level" }, run = moving(commands.valve),
              does = "0 opens it (vacuum on), 1 closes it" },
    MOVE = { takes = {}, options = fields(lookup.axes, fields(lookup.pose_fields, fields(lookup.shares, { elbow = "elbow" }))),
             beside = fields(lookup.pose_fields, fields(lookup.shares, { elbow = "elbow" })), of_axes = true, needs_option = true,
             run = moving_by_name(commands.move),
             does = "moves the named axes to these positions, degrees and mm; with x, y or elbow the gripper to that pose" },
    FLIP = { takes = { "flips" }, run = moving(commands.flip),
             does = "turns the blade over, or back; of a flipper the wafer in its clamp" },
    LINE = { takes = {}, options = fields(lookup.line_fields), needs_option = true,
             run = moving_by_name(commands.line),
             does = "moves the end-effector straight by so much, or to x, y, z, mm and mm/s; "
               .. "without a speed as fast as the axes go" },
    WAIT_FOR = { takes = { "station", "seconds" }, optional = true, run = moving(commands.wait_for),
                 does = "waits until nothing runs in the station by itself, at most so long" },
    PUMP = { takes = { "station", "side" }, run = moving(commands.pump),
             does = "brings a load lock to vacuum or to atmosphere, and waits until it has it" },
    CARRIER = { takes = { "station" }, options = { name = "carrier", wafers = "slots", slots = "changes", at = "number" },
                run = carrier,
                does = "a carrier comes to a load port, at once or at a time in s; wafers=3 or wafers=1,3; slots=3:crossed" },
    PORT = { takes = { "station", "port_state" }, run = moving(commands.port),
             does = "brings a load port with its carrier to this state, and waits until it has it" },
    TAKE_AWAY = { takes = { "station" }, run = moving(commands.take_away),
                  does = "the carrier of a load port goes, with what lies in it" },
    WAIT = { takes = { "seconds" }, run = moving(commands.wait), does = "stands still" },
    FAULT = { takes = { "fault" }, optional = true, options = fault_options, run = fault, breaks = true,
              does = "lets a fault begin, and tells its number; error=NUMBER as ALARM" },
    ALARM = { takes = { "error" }, run = alarm,
              does = "lets the next command that can answer the error of this number do so; tells the fault's number" },
    CLEAR = { takes = { "number" }, run = clear, does = "ends the fault of this number" },
    SET_STATION = { takes = { "station" }, options = fields(lookup.standing, { robot = "robot", gripper = "gripper" }),
                    of_axes = true, run = set_station,
                    does = "from now on the station lies where the gripper is with these axes" },
    STATION = { takes = { "station" }, options = { robot = "robot", gripper = "gripper" }, run = station, asks = true,
                of_robot = true, keeps = true, does = "where the axes stand with the gripper in its slot 1, degrees and mm" },
    OFFSET = { takes = { "wafer", "station", "slot" }, run = offset, asks = true, keeps = true,
               does = "where the wafer is in that slot's frame" },
    HOLDER = { takes = { "wafer" }, run = holder, asks = true, keeps = true, does = "the gripper that holds the wafer" },
    PROXIMITY = { takes = { "wafer", "gripper" }, run = proximity, asks = true, keeps = true,
                  does = "the check of the wafer against the gripper" },
    MEASURE = { takes = { "frame", "frame" }, run = measure, asks = true, keeps = true,
                does = "how the second frame lies in the first one's axes: "
                  .. "a wafer, gripper, station, slot (A/1) or base" },
    DISTANCE = { takes = { "frame", "frame" }, run = distance, asks = true, keeps = true, does = "of two frames' origins" },
    ANGLE = { takes = { "frame", "frame" }, run = angle, asks = true, keeps = true, does = "between two frames' z axes" },
    WHERE = { takes = { "wafer" }, optional = true, repeated = true, run = where, asks = true, keeps = true,
              does = "where wafers are; without a name, all" },
    AXES = { takes = {}, run = axes, keeps = true, does = "where the axes stand, degrees and mm" },
    STATIONS = { takes = {}, run = stations, keeps = true, does = "the stations of the cell" },
    HELP = { takes = { "command" }, optional = true, run = help, keeps = true,
             does = "the commands, or how one is typed" },
    QUIT = { takes = {}, run = quit, keeps = true, does = "leaves the prompt" },
  }

  return prompt_commands
end
