-- Executes one operator's line by the same words that scripts use, and answers it in one line: OK and values,
-- or ERROR, a number of the catalogue, its name and the reason. A line is only ever read, never run as Lua.

return function(native, prompt_commands, tokens, lookup, states, alarms, bind, background)
  local function refuse(text, ...)
    native.fail("BAD_ARGUMENT", text:format(...))
  end

  -- A word as its kind wants it. A name that is not known passes: the command refuses it by its own number.
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

  -- With several robots each command may say which.
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

  -- Whose gripper it is that the controller stands for.
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

  -- By kind, if that name is of something that another controller stands for.
  local is_other = {
    station = function(name, _, station) return station and name ~= station end,
    gripper = function(name, robot, station) return not is_own(name, robot, station) end,
    flips = function(name, robot, station)
      return name ~= station and (native.layout.stations[name] ~= nil or not is_own(name, robot, station))
    end,
    door = function(name, _, station) return station and not is_own_door(name, station) end,
  }

  -- A line of a controller that stands for one robot or station: it knows no other.
  local OTHERS = {
    station = "NO_SUCH_STATION", gripper = "NO_SUCH_GRIPPER", flips = "NO_SUCH_GRIPPER", robot = "NO_SUCH_ROBOT",
    door = "BAD_ARGUMENT",
  }

  local function refuse_other(kind, name, own)
    native.fail(OTHERS[kind], ("%s (expected %s, whose controller this is)"):format(lookup.quote(name), own))
  end

  local function check_own(command, arguments, gripper, other)
    local robot, station = lookup.bound(), lookup.bound_station()
    local own = station or robot and native.layout.robots[robot].name
    if not own or command.asks and not command.of_robot then
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
    if gripper and robot and not is_own(gripper, robot) then
      refuse_other("gripper", gripper, own)
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
    check_own(command, arguments, options.gripper, robot)
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

  -- The name and the command that the words begin with.
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

  -- TASK and the words of a command: it is read now, and carried out beside what follows.
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
    return background.begin(name, function()
      return run(command, arguments, options, robot)
    end)
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
    if command.asks then
      alarms.refuse(name)
      alarms.check(name)
    end
    if command.keeps or native.is_part() or native.has_jobs() or background.is_any() then
      return run(command, read(name, command, list))
    end
    return states.follow(line, run, command, read(name, command, list))
  end

  -- What the cell complained of since `mark`, as text, or nil.
  local function complaints_since(mark)
    local texts = {}
    for _, complaint in ipairs(native.complaints(mark)) do
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
    local begin = native.mark()
    local ok, result = pcall(perform, line)
    local complaints = complaints_since(begin)
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
