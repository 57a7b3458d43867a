-- Reads a typed line's words, and writes answers in that spelling: it can read back its own text.
--
-- Words stand between blanks. A name with blanks stands in double quotes, in which \" is a quote and \\ a
-- backslash. name=value is an option; its value may be quoted, too.

return function(native)
  local tokens = {}

  -- The longest line, in bytes.
  local LONGEST = 1000

  local function refuse(text, ...)
    native.fail("BAD_ARGUMENT", text:format(...))
  end

  -- Refuses a text that is not a line, before it is read.
  function tokens.check(line)
    if #line > LONGEST then
      refuse("the line is longer than %d bytes", LONGEST)
    end
    local control = line:find("[\0-\31\127]") or line:find("\xC2[\x80-\x9F]")
    if control then
      refuse("byte %d of the line is a control character (expected text)", control)
    end
    if not utf8.len(line) then
      refuse("the line is not UTF-8")
    end
  end

  ---------------------------------------------------------------------------------------------------- reading

  -- The text of the quotes that open at `at`, and the place after them.
  local function read_quoted(line, at)
    local parts, from = {}, at + 1
    while true do
      local stop = line:find('["\\]', from)
      if not stop then
        refuse("%s: the quote has no end", line:sub(at))
      end
      parts[#parts + 1] = line:sub(from, stop - 1)
      if line:sub(stop, stop) == '"' then
        return table.concat(parts), stop + 1
      end
      if not line:find('^["\\]', stop + 1) then
        refuse('%s: a lone backslash (expected \\" or \\\\ in quotes)', line:sub(stop))
      end
      parts[#parts + 1] = line:sub(stop + 1, stop + 1)
      from = stop + 2
    end
  end

  local function read_value(line, at)
    if line:sub(at, at) == '"' then
      local text, after = read_quoted(line, at)
      if line:find("^[^ ]", after) then
        refuse("%s: no blank after the quotes", line:sub(at))
      end
      return text, after
    end
    local text = line:match("^[^ ]*", at)
    if text:find('"', 1, true) then
      refuse("%s: a quote within a word (expected quotes around all of it)", text)
    end
    return text, at + #text
  end

  -- A list of { text = , quoted = , name = the option's name or nil, raw = as typed }.
  function tokens.split(line)
    local list, at = {}, line:find("[^ ]")
    while at do
      local word, from = {}, at
      local name = line:match("^(%a[%w_]*)=", at)
      if name then
        word.name = name:lower()
        at = at + #name + 1
      end
      word.quoted = line:sub(at, at) == '"'
      word.text, at = read_value(line, at)
      word.raw = line:sub(from, at - 1)
      list[#list + 1] = word
      at = line:find("[^ ]", at)
    end
    return list
  end

  -- A plain decimal number: no hexadecimal, no inf, no nan.
  function tokens.number(what, word)
    local mantissa = word.text:gsub("[eE][+-]?%d+$", "")
    local plain = mantissa:find("^[+-]?%d+%.?%d*$") or mantissa:find("^[+-]?%.%d+$")
    local value = plain and not word.quoted and tonumber(word.text)
    if not value or value - value ~= 0 then
      local typed = word.name and word.raw:sub(#word.name + 2) or word.raw
      refuse("%s: %s (expected a number)", what, typed == "" and '""' or typed)
    end
    return value
  end

  -- The `known` name that equals the text, else the only one that differs just in case, else the
  -- text itself.
  function tokens.match(text, known)
    local found
    for _, name in ipairs(known) do
      if name == text then
        return name
      end
      if name:lower() == text:lower() then
        found = found == nil and name
      end
    end
    return found or text
  end

  ---------------------------------------------------------------------------------------------------- writing

  -- The shortest decimals that read back as the same double.
  function tokens.exact(value)
    if math.type(value) == "integer" then
      return ("%d"):format(value)
    end
    for digits = 15, 17 do
      local text = ("%." .. digits .. "g"):format(value + 0.0)
      if tonumber(text) == value then
        return text
      end
    end
    return "nan"
  end

  -- A name as it can be typed. An unquoted None is never a name.
  function tokens.spell(name)
    if name == nil then
      return "none"
    end
    if name:find("^[%w_./-]+$") and name:lower() ~= "none" then
      return name
    end
    return '"' .. name:gsub('["\\]', "\\%0") .. '"'
  end

  -- tokens.pairs { { name, value }, ... }: name=value name=value
  function tokens.pairs(list)
    local text = {}
    for _, pair in ipairs(list) do
      local value = pair[2]
      value = type(value) == "number" and tokens.exact(value) or tokens.spell(value)
      text[#text + 1] = pair[1] .. "=" .. value
    end
    return table.concat(text, " ")
  end

  return tokens
end
