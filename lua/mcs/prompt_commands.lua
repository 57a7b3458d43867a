-- The commands that can be typed: for each its arguments, its options, its action, and its answer.
--
-- takes     kinds of the arguments in order; the last one may be left out if `optional`, repeated if `repeated`
-- options   kinds of the options by name; with `needs_option` at least one must be there
-- run       a function of prompt_answers.lua, in most cases
-- of_robot    true: a question; at a robot's own port it asks only that robot
-- of_station  true: likewise, at a load port's or an aligner's own port
-- asks      true: it has no record, so injected errors are looked for here
-- keeps     true: it changes nothing that UNDO could take back, or handles UNDO itself
-- alone     true: not while a task is alive

return function(native, commands, answers, lookup, tokens, states, background, own)
  local prompt_commands = {}

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
    e84_step = function() return { "tp1", "tp2", "tp3", "tp4", "tp5" } end,
    up_or_down = function() return lookup.up_or_down.values end,
    side = function() return lookup.sides end,
    power = function() return lookup.controller_words.power end,
    brakes = function() return lookup.controller_words.brakes end,
    estop = function() return lookup.controller_words.estop end,
    servo = function() return lookup.controller_words.servo end,
    operation = function() return lookup.controller_words.mode end,
    axis = function() return lookup.own_axes(lookup.bound() or 1) end,
    port_state = function() return lookup.port_states end,
    carrier = function() return native.layout.carriers end,
    pattern = own.names, door = names_of "doors", robot = names_of "robots", flips = flips_names,
    name = function() return {} end, save = states.names,
    slots = function() return {} end, changes = function() return {} end,
  }

  local share_options = { speed = "number", acceleration = "number" }
  local station_options = { gripper = "gripper", force = "switch", speed = "number", acceleration = "number" }
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

  -- Faults of a robot's own controller: with several robots, of the one that is named or whose port this is.
  local OF_ROBOTS = { power_lost = true, emergency_stop = true, servo_error = true }

  -- The names of turns in a line, and the fault's options.
  local TURNS = { "rx", "ry", "rz" }
  local fault_options = { gripper = "gripper", wafer = "wafer", onto = "wafer", door = "door", station = "station", step = "e84_step" }
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
    if OF_ROBOTS[description.kind] and lookup.has_several() and lookup.bound() then
      description.robot = native.layout.robots[lookup.bound()].name
    end
    return tokens.pairs { { "fault", commands.fault(description) } }
  end

  --------------------------------------------------------------------------------------------------- commands

  prompt_commands.commands = {
    GET = { takes = { "station", "slot" }, options = get_options, run = answers.get,
            does = "takes the wafer there" },
    PUT = { takes = { "station", "slot" }, options = put_options, run = answers.put,
            does = "sets the wafer down there" },
    CONTINUE = { takes = {}, run = answers.continue,
                 does = "goes on with what is held, to its next stop or its end" },
    SWAP = { takes = { "station", "slot" }, options = swap_options, run = answers.swap,
             does = "takes the wafer there with the empty gripper and puts down the other's" },
    READY = { takes = { "station", "slot" }, options = station_options, run = answers.moving(commands.ready),
              does = "goes in front of the slot, to where GET or PUT enters" },
    PATTERN = { takes = { "pattern", "station", "slot" }, options = pattern_options, run = answers.pattern,
                does = "plays a pattern that a file of patterns adds" },
    MAP = { takes = { "station" }, options = station_options, run = answers.map,
            does = "sweeps over the slots: 0 empty, 1 single, 2 double, 3 protruded, 4 crossed, 5 thick, 6 thin" },
    TEACH = { takes = { "station" }, options = { by = "teaching", keep = "switch", yaw = "switch" }, run = answers.teach,
              does = "finds out where the station truly is, by its beam and the wafer in slot 1, or by its block" },
    HOME = { takes = {}, options = share_options, run = answers.moving_by_name(commands.home),
             does = "out of the station if the arm stands in one, then home" },
    RECOVER = { takes = {}, options = share_options, run = answers.moving_by_name(commands.recover),
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
    STOP = { takes = {}, run = answers.stop, does = "ends the command that runs, gives up one that is held" },
    RESET = { takes = {}, run = answers.reset, keeps = true,
              does = "reads the layout anew and begins another run, with the layout's wafers" },
    SAVE = { takes = { "name" }, run = answers.save, keeps = true, alone = true,
             does = "keeps under this name all that simulator and motion control are" },
    RESTORE = { takes = { "save" }, run = answers.restore, asks = true, alone = true,
                does = "puts back what was saved under this name" },
    UNDO = { takes = {}, run = answers.undo, asks = true, keeps = true, alone = true,
             does = "takes back the last command that changed something, several times" },
    STATUS = { takes = {}, run = answers.status, keeps = true,
               does = "what goes on, where the robot is, what is held, the last error" },
    VERSION = { takes = {}, run = answers.version, keeps = true, does = "the program's version" },
    ROTATE = { takes = { "station", "degrees" }, run = answers.moving(commands.rotate),
               does = "turns a prealigner's chuck by so much" },
    EDGE_SCAN = { takes = { "station" }, run = answers.edge_scan,
                  does = "turns a prealigner's chuck once round while its edge sensor looks at the wafer" },
    ALIGN = { takes = { "station", "degrees" }, optional = true, options = align_options, run = answers.align,
              does = "turns a prealigner's wafer until its notch points there, to 0 without degrees; "
                .. "the next GET makes good how it lies" },
    CALIBRATE = { takes = { "station" }, options = fields(lookup.names(lookup.calibrate_fields)), run = answers.calibrate,
                  does = "finds out what a prealigner's edge sensor is off by, and takes it off from then on" },
    OPEN = { takes = { "door" }, run = answers.moving(commands.open), does = "opens a door, and waits until it is" },
    CLOSE = { takes = { "door" }, run = answers.moving(commands.close),
              does = "shuts a door, unless an arm stands in its station, and waits until it is shut" },
    LIFT = { takes = { "station", "up_or_down" }, run = answers.moving(commands.lift),
             does = "UP: pins lift what lies on a prealigner's chuck; DOWN: they set it down there again" },
    VALVE = { takes = { "gripper", "level" }, run = answers.moving(commands.valve),
              does = "0 opens it (vacuum on), 1 closes it" },
    MOVE = { takes = {}, options = fields(lookup.axes, fields(lookup.pose_fields, fields(lookup.shares, { elbow = "elbow" }))),
             beside = fields(lookup.pose_fields, fields(lookup.shares, { elbow = "elbow" })), of_axes = true, needs_option = true,
             run = answers.moving_by_name(commands.move),
             does = "moves the named axes to these positions, degrees and mm; with x, y or elbow the gripper to that pose" },
    FLIP = { takes = { "flips" }, options = share_options, run = answers.moving_of_one(commands.flip),
             does = "turns the blade over, or back; of a flipper the wafer in its clamp" },
    LINE = { takes = {}, options = fields(lookup.line_fields), needs_option = true,
             run = answers.moving_by_name(commands.line),
             does = "moves the end-effector straight by so much, or to x, y, z, mm and mm/s; "
               .. "without a speed as fast as the axes go" },
    WAIT_FOR = { takes = { "station", "seconds" }, optional = true, run = answers.moving(commands.wait_for),
                 does = "waits until nothing runs in the station by itself, at most so long" },
    PUMP = { takes = { "station", "side" }, run = answers.moving(commands.pump),
             does = "brings a load lock to vacuum or to atmosphere, and waits until it has it" },
    CARRIER = { takes = { "station" }, options = { name = "carrier", wafers = "slots", slots = "changes", at = "number" },
                run = answers.carrier,
                does = "a carrier comes to a load port, at once or at a time in s; wafers=3 or wafers=1,3; slots=3:crossed" },
    PORT = { takes = { "station", "port_state" }, run = answers.moving(commands.port),
             does = "brings a load port with its carrier to this state, and waits until it has it" },
    PORT_MAP = { takes = { "station" }, run = answers.port_map, asks = true, of_station = true, keeps = true,
                 does = "the codes by slot that a load port has mapped of its carrier, as MAP has them, or none" },
    TAKE_AWAY = { takes = { "station" }, run = answers.moving(commands.take_away),
                  does = "the carrier of a load port goes, with what lies in it" },
    CONTROLLER = { takes = {}, options = { power = "power", brakes = "brakes", estop = "estop", servo = "servo", mode = "operation",
                   exceeded = "axis", at = "number", override = "number" }, run = answers.controller,
                   does = "what a robot's own controller has from now on: power, brakes, emergency stop, servos, mode, "
                     .. "an axis beyond its soft limit, the part of all speeds; without options it tells them" },
    WAIT = { takes = { "seconds" }, run = answers.moving(commands.wait), does = "stands still" },
    FAULT = { takes = { "fault" }, optional = true, options = fault_options, run = fault, breaks = true,
              does = "lets a fault begin, and tells its number; error=NUMBER as ALARM" },
    ALARM = { takes = { "error" }, run = answers.alarm,
              does = "lets the next command that can answer the error of this number do so; tells the fault's number" },
    CLEAR = { takes = { "number" }, run = answers.clear, does = "ends the fault of this number" },
    SET_STATION = { takes = { "station" }, options = fields(lookup.standing, { robot = "robot", gripper = "gripper" }),
                    of_axes = true, run = answers.set_station,
                    does = "from now on the station lies where the gripper is with these axes" },
    STATION = { takes = { "station" }, options = { robot = "robot", gripper = "gripper" }, run = answers.station, asks = true,
                of_robot = true, keeps = true, does = "where the axes stand with the gripper in its slot 1, degrees and mm" },
    OFFSET = { takes = { "wafer", "station", "slot" }, run = answers.offset, asks = true, keeps = true,
               does = "where the wafer is in that slot's frame" },
    HOLDER = { takes = { "wafer" }, run = answers.holder, asks = true, keeps = true, does = "the gripper that holds the wafer" },
    PROXIMITY = { takes = { "wafer", "gripper" }, run = answers.proximity, asks = true, keeps = true,
                  does = "the check of the wafer against the gripper" },
    MEASURE = { takes = { "frame", "frame" }, run = answers.measure, asks = true, keeps = true,
                does = "how the second frame lies in the first one's axes: "
                  .. "a wafer, gripper, station, slot (A/1) or base" },
    DISTANCE = { takes = { "frame", "frame" }, run = answers.distance, asks = true, keeps = true, does = "of two frames' origins" },
    ANGLE = { takes = { "frame", "frame" }, run = answers.angle, asks = true, keeps = true, does = "between two frames' z axes" },
    WHERE = { takes = { "wafer" }, optional = true, repeated = true, run = answers.where, asks = true, keeps = true,
              does = "where wafers are; without a name, all" },
    AXES = { takes = {}, run = answers.axes, keeps = true, does = "where the axes stand, degrees and mm" },
    STATIONS = { takes = {}, run = answers.stations, keeps = true, does = "the stations of the cell" },
    HELP = { takes = { "command" }, optional = true, run = help, keeps = true,
             does = "the commands, or how one is typed" },
    QUIT = { takes = {}, run = answers.quit, keeps = true, does = "leaves the prompt" },
  }

  return prompt_commands
end
