-- The operator's words that move something: GET, PUT, ROTATE, VALVE, MOVE, LINE, WAIT.

-- Kept, for a script may set globals of these names.
local coroutine, error, ipairs, math, pairs, pcall, table = coroutine, error, ipairs, math, pairs, pcall, table
local tostring, type = tostring, type

return function(native, patterns, names)
  local commands = {}

  -- Runs a command: it is recorded with the script's line, its times and its error number.
  local function run(text, action, ...)
    native.begin(text)
    local ok, result = pcall(action, ...)
    if ok then
      native.finish()
      return result
    end
    local numbered = type(result) == "table" and math.type(result.number) == "integer" and type(result.text) == "string"
    native.finish(numbered and result.number or names.errors.BAD_ARGUMENT.number, numbered and result.text or tostring(result))
    error(result, 0)
  end

  local function play(pattern, job)
    local step = coroutine.wrap(pattern)
    local segment = step(job)
    while type(segment) == "table" do
      segment = step(native.play(segment))
    end
    return segment
  end

  -------------------------------------------------------------------------------- what a command works on

  local parameters = names.parameters

  local function check_options(options)
    if options ~= nil and type(options) ~= "table" then
      native.fail("BAD_ARGUMENT", "options: " .. tostring(options) .. " (expected a table)")
    end
    for name, value in pairs(options or {}) do
      local expected = name == "gripper" and "string" or parameters[name]
      if type(value) ~= expected then
        local what = expected and "a " .. expected or "gripper or a station parameter"
        native.fail("BAD_ARGUMENT", ("%s: %s (expected %s)"):format(tostring(name), tostring(value), what))
      end
    end
    return options or {}
  end

  -- Strokes end where the neighbouring slots begin: a GET from below the next one would take its wafer.
  local function check_job(job, station, layout)
    local window = layout.tolerance.projz / layout.slice
    local pitch = station.slots > 1 and station.pitch or math.huge
    local rules = {
      { "stroke", job.stroke > 0, "above 0" },
      { "offset", job.offset >= 0 and job.offset <= job.stroke, "from 0 to the stroke" },
      { "stroke", math.max(job.stroke - job.offset, job.offset) < pitch,
        ("within the pitch of %.10g mm below and above the slot"):format(pitch) },
      { "retract", job.retract > 0, "above 0" },
      { "release", job.release >= job.offset - job.stroke and job.release <= job.offset, "within the stroke" },
      { "pickup_speed", job.pickup_speed > 0, "above 0" },
      { "pickup_speed", not layout.sampled or job.pickup_speed <= window,
        ('at most %.10g mm/s with these slices, or a layout with check = "swept"'):format(window) },
      { "vacuum_delay", job.vacuum_delay >= 0, "0 or more" },
      { "timeout", job.timeout >= 0, "0 or more" },
      { "handover", job.handover == "new_first" or job.handover == "same_slice", '"new_first" or "same_slice"' },
    }
    for _, rule in ipairs(rules) do
      if not rule[2] then
        local value = names.quote(job[rule[1]])
        native.fail("BAD_ARGUMENT", ("%s: %s (expected %s)"):format(rule[1], value, rule[3]))
      end
    end
    return job
  end

  local function job_at(station_name, slot, options)
    local layout = native.layout()
    local station = names.station(station_name)
    options = check_options(options)
    local job = { chuck = station.chuck }
    job.place = native.slot(station.index, names.slot(station, slot))
    job.gripper = names.effector(options.gripper)
    function job.inverse(x, y, z, heading)
      return native.inverse(x, y, z, heading, job.gripper)
    end
    for name in pairs(parameters) do
      job[name] = options[name] == nil and station[name] or options[name]
    end
    return check_job(job, station, layout)
  end

  local function number_text(value)
    return math.type(value) == "float" and value == value and ("%.10g"):format(value) or tostring(value)
  end

  local function command_text(word, ...)
    local text = { word }
    for _, value in ipairs({ ... }) do
      text[#text + 1] = value ~= "" and number_text(value) or nil
    end
    return table.concat(text, " ")
  end

  -------------------------------------------------------------------------------------------- GET and PUT

  local function get(station, slot, options)
    local job = job_at(station, slot, options)
    if native.sensor(job.gripper) then
      native.fail("WAFER_ON_GRIPPER")
    end
    if not play(patterns.get, job) then
      native.fail("WAFER_MISSING", native.explain(job.gripper))
    end
  end

  local function put(station, slot, options)
    local job = job_at(station, slot, options)
    if not native.sensor(job.gripper) then
      native.fail("NO_WAFER_ON_GRIPPER")
    end
    if not play(patterns.put, job) then
      native.fail("WAFER_LOST", native.explain(job.chuck))
    end
  end

  function commands.get(station, slot, options)
    run(command_text("GET", station, slot), get, station, slot, options)
  end

  function commands.put(station, slot, options)
    run(command_text("PUT", station, slot), put, station, slot, options)
  end

  ------------------------------------------------------------------------------------------ single moves

  local function rotate(station_name, degrees)
    local station = names.station(station_name)
    if not station.chuck then
      native.fail("NOT_A_PREALIGNER", names.quote(station_name))
    end
    local axis = native.layout().grippers[station.chuck].axis
    local axes = native.axes()
    axes[axis] = axes[axis] + math.rad(names.number("degrees", degrees))
    native.play { axes = axes }
  end

  function commands.rotate(station, degrees)
    run(command_text("ROTATE", station, degrees), rotate, station, degrees)
  end

  local function valve(gripper, level)
    if level ~= 0 and level ~= 1 then
      native.fail("BAD_VALVE", "valve: " .. names.quote(level) .. " (expected 0, open, or 1, closed)")
    end
    native.play { valves = { [names.gripper(gripper)] = math.tointeger(level) } }
  end

  function commands.valve(gripper, level)
    run(command_text("VALVE", gripper, level), valve, gripper, level)
  end

  local function axis_of(name)
    for axis, known in ipairs(names.axes) do
      if name == known then
        return axis
      end
    end
    native.fail("BAD_ARGUMENT", tostring(name) .. ": no such axis (expected theta, r, z or yaw)")
  end

  local function move(targets)
    local axes = native.axes()
    for name, value in pairs(names.table("move", targets)) do
      local axis = axis_of(name)
      local turns = name == "theta" or name == "yaw"
      axes[axis] = turns and math.rad(names.number(name, value)) or names.number(name, value)
    end
    native.play { axes = axes }
  end

  local function text_of(targets, order)
    local text = {}
    for _, name in ipairs(order) do
      if type(targets) == "table" and targets[name] ~= nil then
        text[#text + 1] = ("%s=%s"):format(name, number_text(targets[name]))
      end
    end
    return table.concat(text, " ")
  end

  -- move { theta = , r = , z = , yaw = }: degrees and mm; an axis that is not named stays.
  function commands.move(targets)
    run(command_text("MOVE", text_of(targets, names.axes)), move, targets)
  end

  local function line(by)
    local parts = { dx = 0, dy = 0, dz = 0, speed = 0 }
    for name, value in pairs(names.table("line", by)) do
      if parts[name] == nil then
        native.fail("BAD_ARGUMENT", tostring(name) .. ": no such field (expected dx, dy, dz or speed)")
      end
      parts[name] = names.number(name, value)
    end
    native.play { line = { parts.dx, parts.dy, parts.dz }, speed = parts.speed }
  end

  -- line { dx = , dy = , dz = , speed = }: the end-effector straight by so many mm in base, its heading kept.
  function commands.line(by)
    run(command_text("LINE", text_of(by, names.line_fields)), line, by)
  end

  local function wait(seconds)
    if names.number("seconds", seconds) < 0 or seconds > 1e6 then
      native.fail("BAD_ARGUMENT", ("seconds: %s (expected 0 to 1e6)"):format(tostring(seconds)))
    end
    native.play { dwell = seconds }
  end

  function commands.wait(seconds)
    run(command_text("WAIT", seconds), wait, seconds)
  end

  ---------------------------------------------------------------------------------------------- rehearsal

  -- Plans GET and PUT at a slot from where the arm stands, without playing them; an error says what is out of reach.
  function commands.rehearse(station, slot)
    native.rehearse(true)
    local ok, problem = pcall(function()
      play(patterns.get, job_at(station, slot))
      play(patterns.put, job_at(station, slot))
    end)
    native.rehearse(false)
    if not ok then
      return problem
    end
  end

  return commands
end
