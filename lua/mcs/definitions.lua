-- Makes annotations of layouts and scripts for the Lua language server, which editors use. The sources are
-- the tables of the layout readers (native.classes), the words (lua/mcs/words.lua), and the options that
-- commands look up.

-- Local copies: a script may set globals of these names.
local ipairs, pairs, select, table = ipairs, pairs, select, table

-- The type of all other fields of a table: a misspelt field then has a type that no value fits.
local UNKNOWN = "waferhand.no_such_field"

return function(native, lookup, targets, words, wh)
  local lines = {}

  local function add(text, ...)
    lines[#lines + 1] = select("#", ...) > 0 and text:format(...) or text
  end

  -- Adds a field to tables of this class. An optional one ends in ?, like its type in words.lua.
  local function add_field(name, kind, text, optional)
    add("---@field %s%s %s%s", name, optional and "?" or "", kind, text ~= "" and " " .. text or "")
  end

  local function open(name, text)
    add("")
    add("---%s", text)
    add("---@class waferhand.%s", name)
  end

  -- Closes a table that is written by hand: no other fields.
  local function close()
    add("---@field [string] %s", UNKNOWN)
  end

  ------------------------------------------------------------------------------------------------- layouts

  -- The text of a field, and the range of a number; commands have a station's range, too.
  local function with_range(field)
    return field.least and ("%s; from %.10g to %.10g"):format(field.text, field.least, field.most) or field.text
  end

  local function with_default(field)
    return field.usual and with_range(field) .. "; by default " .. field.usual or with_range(field)
  end

  local function add_layouts()
    local faults = {}
    for _, class in ipairs(native.classes()) do
      open(class.name, class.text)
      for _, field in ipairs(class.fields) do
        add_field(field.name, field.type, with_default(field), not field.required)
      end
      close()
      faults[#faults + 1] = class.name:find("^fault") and "waferhand." .. class.name or nil
    end
    open("fault_error", "An error on purpose: the next command that can answer it does.")
    add_field("error", "integer", "its number")
    close()
    faults[#faults + 1] = "waferhand.fault_error"
    add("")
    add("---@alias waferhand.fault %s", table.concat(faults, "|"))
  end

  ------------------------------------------------------------------------------------------------- options

  local function type_of(kind)
    if not kind.values then
      return kind[3] and "number" or "string"
    end
    local list = {}
    for place, value in ipairs(kind.values) do
      if value == true then
        return "boolean"
      end
      list[place] = lookup.quote(value)
    end
    return table.concat(list, "|")
  end

  local function unit_of(kind)
    local unit = kind[3] or ""
    return kind[2] and ("%s from %.10g to %.10g"):format(unit, kind[1], kind[2]):gsub("^ ", "") or unit
  end

  local of_stations = {}
  for _, class in ipairs(native.classes()) do
    for _, field in ipairs(class.name == "station" and class.fields or {}) do
      of_stations[field.name] = with_range(field)
    end
  end

  -- An option that replaces a station's field has that field's text. SWAP has the options of its GET and of
  -- its PUT.
  local function text_of(name, kind)
    local command, bare = name:match("^([gp][eu]t)_(.*)$")
    local text, unit = words.options[bare or name], unit_of(kind)
    text = not text and (of_stations[bare or name] or unit) or unit ~= "" and unit .. ": " .. text or text
    return command and ("%s (of the %s)"):format(text, command:upper()) or text
  end

  local function add_numbers(name, text, fields)
    open(name, text)
    for _, field in ipairs(fields) do
      add_field(field, "number", unit_of(lookup.ranges[field]), true)
    end
    close()
  end

  -- The fields of MOVE by name.
  local function move_fields()
    local fields = { elbow = { values = { "left", "right" } } }
    for _, list in ipairs({ lookup.axes, lookup.pose_fields }) do
      for _, name in ipairs(list) do
        fields[name] = lookup.ranges[name]
      end
    end
    for _, name in ipairs(lookup.shares) do
      fields[name] = lookup.ranges.speed_share
    end
    return fields
  end

  local function add_options(name, text, ...)
    open(name, text)
    for _, kinds in ipairs({ ... }) do
      for field, kind in pairs(kinds) do
        add_field(field, type_of(kind), text_of(field, kind), true)
      end
    end
    close()
  end

  local function add_all_options()
    local own, common = targets.fields, { lookup.options, lookup.parameters }
    local axes, served = {}, { gripper = lookup.options.gripper, robot = lookup.options.robot }
    for _, name in ipairs(lookup.standing) do
      axes[name] = lookup.ranges[name]
    end
    add_options("command_options", "Options of READY and MAP.", common[1], common[2])
    add_options("get_options", "Options of GET.", own.get, common[1], common[2])
    add_options("put_options", "Options of PUT.", own.put, common[1], common[2])
    add_options("swap_options", "Options of SWAP, for its GET and its PUT.", own.swap, lookup.swap_options, common[2])
    add_options("align_options", "Options of ALIGN.", lookup.align_fields)
    add_options("calibrate_options", "Options of CALIBRATE.", lookup.calibrate_fields,
      { robot = lookup.options.robot })
    add_options("positions", "Where axes go, or the gripper, degrees and mm, and with what part of the limits.",
      move_fields())
    add_options("served_by", "The robot whose way into a station this is.", served)
    add_options("standing", "Where axes stand with a gripper in slot 1: degrees and mm.", axes, served)
    add_numbers("way", "How far the end-effector goes: mm, and mm/s.", lookup.line_fields)
    add("")
    add('---@alias waferhand.clearance_kind "%s"', table.concat(native.clearance_kinds(), '"|"'))
  end

  --------------------------------------------------------------------------------------------------- words

  local function add_results()
    for _, class in ipairs(words.classes) do
      open(class[1], class[2])
      for place = 3, #class do
        local kind, optional = class[place][2]:gsub("%?$", "")
        add_field(class[place][1], kind, class[place][3], optional == 1)
      end
    end
  end

  local function add_function(name, word)
    local names = {}
    add("")
    add("---%s", word.does)
    for place, parameter in ipairs(word.takes) do
      local kind, optional = parameter[2]:gsub("%?$", "")
      names[place] = parameter[1]
      add("---@param %s%s %s %s", parameter[1], optional == 1 and "?" or "", kind, parameter[3])
    end
    for _, result in ipairs(word.gives or {}) do
      add("---@return %s %s", result[1], result[2])
    end
    add("function %s(%s) end", name, table.concat(names, ", "))
  end

  -- The type of a word that is bound to a robot.
  local function method_of(word)
    local takes, gives = { "self: table" }, {}
    for place, parameter in ipairs(word.takes) do
      takes[place + 1] = parameter[1] .. ": " .. parameter[2]
    end
    for place, result in ipairs(word.gives or {}) do
      gives[place] = result[1]
    end
    return ("fun(%s)%s"):format(table.concat(takes, ", "), gives[1] and ": " .. table.concat(gives, ", ") or "")
  end

  local function add_bound_words()
    open("bound_words", "The words that move one of several robots: called with a colon.")
    for _, word in ipairs(words.scripts) do
      if word.bound then
        add_field(word[1], method_of(word), "as " .. word[1])
      end
    end
  end

  local function add_module()
    local names = {}
    for name in pairs(wh.errors) do
      names[#names + 1] = ('"%s"'):format(name)
    end
    add("")
    add("---@alias waferhand.error_name %s", table.concat(names, "|"))
    add("")
    add("---The check and the grasp table, and the catalogue of errors.")
    add("---@class waferhand.module")
    add("---@field version string of the program")
    add("---@field errors table<waferhand.error_name, { number: integer, text: string }> each by its name")
    add("wh = {}")
    for name, word in pairs(words.module) do
      add_function("wh." .. name, word)
    end
  end

  return function()
    add("---@meta")
    add("-- The fields and words of layouts and scripts of Waferhand %s: printed by `waferhand definitions`.", native.version())
    add("")
    add("---What no such table has: a typo?")
    add("---@class %s", UNKNOWN)
    add_layouts()
    add_all_options()
    add_results()
    add_bound_words()
    add("")
    add("---@alias waferhand.pattern fun(target: waferhand.pattern_target, steps: waferhand.pattern_steps, "
      .. "shipped: table<string, fun(target: waferhand.pattern_target): string|nil>): string|nil, string|nil")
    for _, word in ipairs(words.scripts) do
      add_function(word[1], word)
    end
    for name, word in pairs(words.checks) do
      add_function(name, word)
    end
    add("")
    add("---In a file of checks: what `run --json` prints of the recorded run.")
    add("---@type table")
    add("run = {}")
    add_module()
    add("")
    add("---What --set NAME=VALUE handed over.")
    add("---@type table<string, number|string|boolean>")
    add("params = {}")
    add("")
    add("return {}")
    return table.concat(lines, "\n") .. "\n"
  end
end
