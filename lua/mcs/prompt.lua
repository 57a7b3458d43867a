-- Executes an operator's line with the words of scripts, and answers it in one line: OK and values, or ERROR,
-- a number of the catalogue, its name and the reason. A line is only read, never run as Lua.

return function(native, prompt_commands, tokens, lookup, states, alarms, bind, background)
  local function refuse(text, ...)
    native.fail("BAD_ARGUMENT", text:format(...))
  end

  -- Converts a word to its kind. An unknown name passes: the command refuses it with its own number.
  local function convert(what, kind, word)
    local known = prompt_commands.kinds[kind]
    if not known then
      return tokens.number(what, word)
    end
    local text = tokens.match(word.text, known())
    if kind == "switch" and (text == "true" or text == "false") then
      return text == "true"
    end
    return text
  end

  -- The kind of an option; with several robots each command may name its robot.
  local function kind_of(command, name)
    return command.options and command.options[name] or name == "robot" and lookup.has_several() and "robot"
  end

  local function take_option(name, command, options, word)
    local kind = kind_of(command, word.name)
    if not kind then
      local known = lookup.names(command.options or {})
      local expected = known[1] and "expected " .. lookup.listed(known) or name .. " takes no options"
      refuse("%s: no such option (%s%s)", word.raw, expected, lookup.nearest(word.name, known))
    end
    if options[word.name] ~= nil then
      refuse("%s: given twice", word.name)
    end
    options[word.name] = convert(word.name, kind, word)
  end

  local function take_argument(name, command, arguments, word)
    local place = #arguments + 1
    local kind = command.takes[place] or command.repeated and command.takes[#command.takes]
    if not kind then
      refuse("%s: one too many (expected %s)", word.raw, prompt_commands.usage(name))
    end
    arguments[place] = convert(kind, kind, word)
  end

  -- True if the gripper belongs to the controller's robot or station.
  local function is_own(gripper, robot, station)
    local index = lookup.gripper(gripper)
    if robot then
      return native.layout.grippers[index].robot == robot
    end
    return native.layout.stations[station].chuck == index or native.layout.stations[station].pins == index
  end

  local function is_own_door(door, station)
    local index = lookup.door(door)
    for _, own in pairs(native.layout.stations[station].doors or {}) do
      if own == index then
        return true
      end
    end
    return false
  end

  -- By kind: whether the name belongs to another controller.
  local is_other = {
    station = function(name, _, station) return station and name ~= station end,
    gripper = function(name, robot, station) return not is_own(name, robot, station) end,
    flips = function(name, robot, station)
      return name ~= station and (native.layout.stations[name] ~= nil or not is_own(name, robot, station))
    end,
    door = function(name, _, station) return station and not is_own_door(name, station) end,
  }

  -- A line of a controller for one robot or station: it knows no others.
  local OTHERS = {
    station = "NO_SUCH_STATION", gripper = "NO_SUCH_GRIPPER", flips = "NO_SUCH_GRIPPER", robot = "NO_SUCH_ROBOT",
    door = "BAD_ARGUMENT",
  }

  local function refuse_other(kind, name, own)
    native.fail(OTHERS[kind], ("%s (expected %s, whose controller this is)"):format(lookup.quote(name), own))
  end

  -- The options of FAULT that name a part.
  local PARTS = { "gripper", "station", "door" }

  local function check_own(command, arguments, options, other)
    local robot, station = lookup.bound(), lookup.bound_station()
    local own = station or robot and native.layout.robots[robot].name
    if not own or command.asks and not (robot and command.of_robot or station and command.of_station) then
      return
    end
    if robot and other and other ~= robot then
      refuse_other("robot", native.layout.robots[other].name, own)
    end
    for place, kind in ipairs(command.takes) do
      local name = arguments[place]
      if name and is_other[kind] and is_other[kind](name, robot, station) then
        refuse_other(kind, name, own)
      end
    end
    -- A load port's MAP names a gripper of the robot that it calls.
    for _, kind in ipairs((robot or command.breaks) and PARTS or {}) do
      local name = options[kind]
      if name and is_other[kind](name, robot, station) then
        refuse_other(kind, name, own)
      end
    end
  end

  local function read(name, command, list)
    local arguments, options = {}, {}
    for place = 2, #list do
      if list[place].name then
        take_option(name, command, options, list[place])
      else
        take_argument(name, command, arguments, list[place])
      end
    end
    local robot = options.robot and lookup.robot(options.robot)
    options.robot = nil
    check_own(command, arguments, options, robot)
    local needed = #command.takes - (command.optional and 1 or 0)
    if #arguments < needed or command.needs_option and next(options) == nil then
      refuse("too few words (expected %s)", prompt_commands.usage(name))
    end
    return arguments, options, robot
  end

  local function run(command, arguments, options, robot)
    if robot then
      return bind(robot, command.run, arguments, options)
    end
    return command.run(arguments, options)
  end

  -- The name and the command at the beginning of the words.
  local function find(list)
    if not list[1] then
      native.fail("NO_SUCH_COMMAND", "an empty line (HELP lists them)")
    end
    local name = list[1].raw:upper()
    local command = prompt_commands.commands[name]
    if not command then
      prompt_commands.refuse(list[1].raw)
    end
    alarms.refuse_line(name)
    return name, command
  end

  -- TASK and the words of a command: the command is read now, and executed beside the next lines.
  local function begin(list)
    local words = table.move(list, 2, #list, 1, {})
    if not words[1] then
      refuse("too few words (expected %s)", prompt_commands.usage("TASK"))
    end
    local name, command = find(words)
    if command.keeps or command.asks or command.alone then
      refuse("%s: no command for a task (expected one that moves something)", name)
    end
    local arguments, options, robot = read(name, command, words)
    local raw = {}
    for place, word in ipairs(words) do
      raw[place] = word.raw
    end
    return background.begin(name, table.concat(raw, " "), function()
      return run(command, arguments, options, robot)
    end)
  end

  local function carry_out(line, name, command, list)
    if command.asks then
      alarms.refuse(name)
      alarms.check(name)
    end
    if command.keeps or native.is_part() or native.has_jobs() or background.is_any() then
      return run(command, read(name, command, list))
    end
    return states.follow(line, run, command, read(name, command, list))
  end

  -- RESTORE and UNDO are in no record. One that fails is a command that failed all the same, for STATUS to tell.
  local function recorded(line, action, ...)
    local ok, result = pcall(action, ...)
    if ok then
      return result
    end
    if type(result) == "table" and math.type(result.number) == "integer" and pcall(native.begin, line) then
      native.finish(result.number, result.text)
    end
    error(result, 0)
  end

  local function perform(line)
    tokens.check(line)
    local list = tokens.split(line)
    local name, command = find(list)
    if name == "TASK" then
      return begin(list)
    end
    if command.alone then
      background.check_none(name)
    end
    if command.asks and command.alone then
      return recorded(line, carry_out, line, name, command, list)
    end
    return carry_out(line, name, command, list)
  end

  -- The cell's complaints since `mark`, as text, or nil.
  local function complaints_since(mark, expectations)
    local texts = {}
    for _, complaint in ipairs(native.complaints(mark, expectations)) do
      local wafer = complaint.wafer and (' "%s"'):format(complaint.wafer) or ""
      local height = complaint.height and (", %.3f mm high"):format(complaint.height) or ""
      texts[#texts + 1] = complaint.kind .. wafer .. height
    end
    return texts[1] and table.concat(texts, "; ")
  end

  local function answer(head, text, complaints)
    if text and text ~= "" then
      head = head .. " " .. text
    end
    return complaints and head .. "; " .. complaints or head
  end

  -- execute(line): the number of the error, 0 for none, and the answer.
  return function(line)
    local begin, expectations = native.mark()
    local ok, result = pcall(perform, line)
    local complaints = complaints_since(begin, expectations)
    if ok then
      return 0, answer("OK", result, complaints)
    end
    if type(result) == "table" and math.type(result.number) == "integer" then
      return result.number, answer("ERROR", result.text:gsub("^error ", ""), complaints)
    end
    local bad = lookup.errors.BAD_ARGUMENT
    result = ("%d BAD_ARGUMENT: %s"):format(bad.number, tostring(result))
    return bad.number, answer("ERROR", result, complaints)
  end
end
