-- Completes the word before the cursor: a command, a name of the right kind, or an option.

return function(prompt_commands, tokens)
  -- A longer list does not help a reader.
  local MOST = 200

  -- The place where the text's last word begins, if it has not ended; else where the next one would begin.
  local function start_of_word(text)
    local start = 1
    local at = text:find("[^ ]")
    while at do
      start = at
      local _, name_end = text:find("^%a[%w_]*=", at)
      at = name_end and name_end + 1 or at
      if text:sub(at, at) == '"' then
        at = at + 1
        while text:find("^[^\"]", at) do
          at = at + (text:sub(at, at) == "\\" and 2 or 1)
        end
      end
      local blank = text:find(" ", at, true)
      if not blank then
        return start
      end
      at = text:find("[^ ]", blank)
    end
    return #text + 1
  end

  local function is_prefix(prefix, text)
    return text:sub(1, #prefix):lower() == prefix:lower()
  end

  -- The known names that begin like the word, spelt as they can be typed, with `before` and `after`
  -- around them.
  local function choose(known, word, before, after)
    local list = {}
    local typed = word:gsub('^"', ""):gsub('\\(["\\])', "%1")
    for _, name in ipairs(known) do
      if #list < MOST and is_prefix(typed, name) then
        list[#list + 1] = before .. (after == "=" and name or tokens.spell(name)) .. after
      end
    end
    return list
  end

  local function values(command, name, word)
    local kind = command.options and command.options[name:lower()]
    local known = prompt_commands.kinds[kind]
    return known and choose(known(), word, name .. "=", "") or {}
  end

  local function sorted_keys(map)
    local list = {}
    for key in pairs(map or {}) do
      list[#list + 1] = key
    end
    return list
  end

  local function candidates(list, word)
    local command = list[1] and prompt_commands.commands[list[1].raw:upper()]
    if not list[1] then
      return choose(sorted_keys(prompt_commands.commands), word, "", "")
    end
    if not command then
      return {}
    end
    local name, value = word:match("^(%a[%w_]*)=(.*)$")
    if name then
      return values(command, name, value)
    end
    local place = 0
    for _, finished in ipairs(list) do
      place = place + (finished.name and 0 or 1)
    end
    local kind = command.takes[place] or command.repeated and command.takes[#command.takes]
    if kind then
      local known = prompt_commands.kinds[kind]
      return known and choose(known(), word, "", "") or {}
    end
    return choose(sorted_keys(command.options), word, "", "=")
  end

  -- complete(text before the cursor): the place where the word begins, and a list of its candidates.
  return function(text)
    local start = start_of_word(text)
    local ok, list = pcall(tokens.split, text:sub(1, start - 1))
    return start, ok and candidates(list, text:sub(start)) or {}
  end
end
