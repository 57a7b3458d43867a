-- Executes one operator's line by the same words that scripts use, and answers it in one line: OK and values,
-- or ERROR, a number of the catalogue, its name and the reason. A line is only ever read, never run as Lua.

return function(native, prompt_commands, tokens, lookup, states)
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

  local function take_option(name, command, options, word)
    local kind = command.options and command.options[word.name]
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

  local function read(name, command, list)
    local arguments, options = {}, {}
    for place = 2, #list do
      if list[place].name then
        take_option(name, command, options, list[place])
      else
        take_argument(name, command, arguments, list[place])
      end
    end
    local needed = #command.takes - (command.optional and 1 or 0)
    if #arguments < needed or command.needs_option and next(options) == nil then
      refuse("too few words (expected %s)", prompt_commands.usage(name))
    end
    return arguments, options
  end

  local function perform(line)
    tokens.check(line)
    local list = tokens.split(line)
    if not list[1] then
      native.fail("NO_SUCH_COMMAND", "an empty line (HELP lists them)")
    end
    local name = list[1].raw:upper()
    local command = prompt_commands.commands[name]
    if not command then
      prompt_commands.refuse(list[1].raw)
    end
    if command.keeps then
      return command.run(read(name, command, list))
    end
    return states.follow(line, command.run, read(name, command, list))
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
