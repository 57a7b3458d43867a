-- Writes the tables of the manual's chapters anew, from the rows, errors and words that the program goes by. In a chapter
--
--   <!-- tables of fields: station approach -->   begins the tables of these classes,
--   <!-- tables of errors -->                     the table of all errors,
--   <!-- tables of errors on purpose -->          that of the errors that a command can answer, and
--   <!-- tables of axes -->                       that of the usual robot's axes,
--   <!-- tables of words -->                      that of a script's words;
--   <!-- end of tables -->                        ends each of them.
--
-- The arguments are the chapters. Each class must stand in exactly one of them. tests/end_to_end/tools/manual_tables.c runs this.

local chapters = { ... }
local words = dofile "lua/mcs/words.lua"

local alarms = dofile "lua/mcs/alarm_errors.lua"
local NONE = ""

-- Errors on purpose: what breaks, or for whom else a check is.
local NOTES = {
  WAFER_MISSING = "with vacuum: the valve of the gripper is stuck",
  NO_WAFER_ON_GRIPPER = "the gripper's sensor stays off",
  WAFER_ON_GRIPPER = "the gripper's valve is open and its sensor stays on",
  WAFER_LOST = "the gripper's sensor stays on; onto a chuck, the chuck's valve is stuck",
  FLIP_TIMEOUT = "what carries the gripper or the clamp stands still",
  STOPPED = "a STOP comes 0.1 s after it has begun to move; it waits for another one if that has ended by then",
  VACUUM_TIMEOUT = "the gripper's sensor stays off; of a PUT onto a chuck, the chuck's",
  VACUUM_BEFORE_PICK = "the gripper's sensor stays on",
  NOT_HOMED = "the robot no longer knows where it is, until HOME",
  WAFER_LOST_ON_WAY = "the gripper's pump dies as the arm sets out",
  PLUNGER_STUCK = "with an edge grip: its plunger is stuck",
  GRIP_TIMEOUT = "with an edge grip that is open: its plunger creeps",
  UNGRIP_TIMEOUT = "with an edge grip: its plunger creeps",
  SENSORS_DISAGREE = "with an edge grip: its sensor stays off",
  DOOR_TIMEOUT = "the door is stuck",
  TOO_FEW_SAMPLES = "of a PUT with `centre`, too",
  CENTRE_NOT_SURE = "of a PUT with `centre`, too",
}

-- The words that people use for many commands at once.
local GROUPS = { { "all that moves", alarms.groups[1] }, { "all at stations", alarms.groups[2] }, { "questions", alarms.groups[3] } }

local function read(path)
  local file <close> = assert(io.open(path))
  return file:read "a"
end

local by_name, home, lines = {}, {}, {}
for _, class in ipairs(classes) do
  by_name[class.name] = class
end

local function add(text, ...)
  lines[#lines + 1] = select("#", ...) > 0 and text:format(...) or text
end

-- A | within code ends a cell, too.
local function cell(text)
  return (text:gsub("|", "\\|"))
end

local function row(...)
  local cells = { ... }
  for i, text in ipairs(cells) do
    cells[i] = cell(text)
  end
  add("| %s |", table.concat(cells, " | "))
end

local function head(...)
  row(...)
  add("|%s", ("---|"):rep(select("#", ...)))
end

local function number(value)
  local text = ("%.12g"):format(value)
  local zeros = text:match "^10*$"
  text = zeros and #zeros > 5 and ("1e%d"):format(#zeros - 1) or text
  return (text:gsub("^%-", "−"):gsub("e%+?(%-?)0*(%d)", "e%1%2"))
end

---------------------------------------------------------------------------------------------------------------- fields

local function link(name, here)
  local file = home[name]
  local anchor = name:gsub("%.", "")
  return ("[%s](%s#%s)"):format(name, file == here and "" or file:match "[^/]*$", anchor)
end

-- The unit of what a field holds, or its type as people say it.
local function kind_of(field, here)
  local kind = field.type:gsub("|", " or "):gsub('"[^"]*"', "`%0`"):gsub("table<string, (.*)>", "%1 by name")
  kind = kind:gsub("waferhand%.([%w_.]+)%[%]", "list of waferhand.%1"):gsub("number%[%]", "list of numbers")
  kind = kind:gsub("(%a+)%[%] by name", "lists of %1 by name"):gsub("(%a+)%[%]", "list of %1"):gsub("table<.*>", "table"):gsub("boolean", "`true` or `false`")
  kind = kind:gsub("string", "text"):gsub("integer", "whole number")
  kind = kind:gsub("waferhand%.fault%f[^%w_.]", "fault"):gsub("waferhand%.([%w_.]+)", function(name)
    return by_name[name] and link(name, here) or name
  end)
  return field.unit ~= "" and (kind:gsub("^number", field.unit, 1)) or kind
end

-- The text without the unit that has a column of its own.
local function text_of(field)
  local rest = field.unit ~= "" and field.text:sub(#field.unit + 1) or field.text
  return (rest:gsub("^[:,;]?%s+", ""))
end

local function add_class(name, here)
  local class = assert(by_name[name], name .. ": no such class")
  add("### %s\n\n%s\n", name, class.text)
  head("field", "unit or type", "range", "default", "what it is")
  for _, field in ipairs(class.fields) do
    local range = field.least and ("%s to %s"):format(number(field.least), number(field.most)) or NONE
    local usual = field.required and "*required*" or field.usual and (field.usual:find '^"[^" ]*"$' and "`%s`" or "%s"):format(
      field.usual:gsub("^%-", "−")) or NONE
    row("`" .. field.name .. "`", kind_of(field, here), range, usual, text_of(field))
  end
  add ""
end

local function add_axes()
  head("axis", "travel", "home", "speed", "acceleration", "jerk")
  for _, axis in ipairs(axes) do
    local unit, to = axis.turns and "°" or " mm", axis.turns and "°" or ""
    local per = axis.turns and " °" or " mm"
    row("`" .. axis.name .. "`", number(axis.least) .. to .. " to " .. number(axis.most) .. unit, number(axis.home) .. unit,
      number(axis.speed) .. per .. "/s", number(axis.acceleration) .. per .. "/s²", number(axis.jerk) .. per .. "/s³")
  end
  add ""
end

---------------------------------------------------------------------------------------------------------------- errors

local function add_errors()
  head("number", "name", "what it says")
  for _, status in ipairs(statuses) do
    if status.number > 0 then
      row(("%d"):format(status.number), status.name, status.text)
    end
  end
  add ""
end

-- "all that moves, OFFSET" for a list of commands that has all of a group's.
local function commands_of(list)
  local said, left = {}, " " .. list .. " "
  for _, group in ipairs(GROUPS) do
    local without, is_whole = left, true
    for word in group[2]:gmatch "%S+" do
      local count
      without, count = without:gsub(" " .. word .. " ", " ", 1)
      is_whole = is_whole and count == 1
    end
    if is_whole then
      said[#said + 1], left = group[1], without
    end
  end
  for word in left:gmatch "%S+" do
    said[#said + 1] = word
  end
  return table.concat(said, ", ")
end

local function add_alarms()
  local known = 0
  head("error", "answered by", "raised by")
  for _, status in ipairs(statuses) do
    local how = alarms.how[status.name]
    if how then
      known = known + 1
      row(("%d %s"):format(status.number, status.name), commands_of(how[2]), how[1] .. (NOTES[status.name] and ": " .. NOTES[status.name] or ""))
    end
  end
  for name in pairs(alarms.how) do
    known = known - 1
    assert(known >= 0, name)
  end
  add ""
end

----------------------------------------------------------------------------------------------------------------- words

local function add_words()
  head("word", "gives", "what it does")
  for _, word in ipairs(words.scripts) do
    local takes, gives = {}, {}
    for i, parameter in ipairs(word.takes) do
      takes[i] = parameter[1] .. (parameter[2]:find "%?$" and "?" or "")
    end
    for i, result in ipairs(word.gives or {}) do
      gives[i] = result[2] .. (result[1]:find "%?$" and "?" or "")
    end
    row(("`%s(%s)`"):format(word[1], table.concat(takes, ", ")), #gives > 0 and "`" .. table.concat(gives, ", ") .. "`" or NONE, word.does)
  end
  add ""
end

-------------------------------------------------------------------------------------------------------------- chapters

local MARK, LAST = "^<!%-%- tables of (.-) %-%->$", "<!-- end of tables -->"
local makers = { axes = add_axes, errors = add_errors, ["errors on purpose"] = add_alarms, words = add_words }

for _, path in ipairs(chapters) do
  for list in read(path):gmatch "<!%-%- tables of fields: (.-) %-%->" do
    for name in list:gmatch "%S+" do
      assert(not home[name], name .. ": in two places")
      home[name] = path
    end
  end
end
for _, class in ipairs(classes) do
  assert(home[class.name], class.name .. ": in no chapter")
end

for _, path in ipairs(chapters) do
  local text, is_old = read(path), false
  lines = {}
  for line in text:gmatch "([^\n]*)\n" do
    local mark = line:match(MARK)
    local fields = mark and mark:match "^fields: (.*)$"
    is_old = is_old and line ~= LAST
    if not is_old then
      lines[#lines + 1] = line
    end
    if fields or makers[mark] then
      assert(not is_old, path .. ": " .. line .. ": no end before")
      is_old = true
      add ""
      for name in (fields or ""):gmatch "%S+" do
        add_class(name, path)
      end
      if not fields then
        makers[mark]()
      end
    end
  end
  assert(not is_old, path .. ": no " .. LAST)
  local new = table.concat(lines, "\n") .. "\n"
  if new ~= text then
    local file <close> = assert(io.open(path, "w"))
    file:write(new)
    print(path)
  end
end
