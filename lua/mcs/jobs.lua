-- What a command at a station works on: its place, its gripper, and the station's parameters, each of which the
-- command may set for itself. All is checked before anything moves.

-- Kept, for a script may set globals of these names.
local ipairs, math, pairs, tostring, type = ipairs, math, pairs, tostring, type

return function(native, names, arm)
  local jobs = {}

  local parameters = names.parameters

  local function check_options(options)
    if options ~= nil and type(options) ~= "table" then
      native.fail("BAD_ARGUMENT", "options: " .. tostring(options) .. " (expected a table)")
    end
    for name, value in pairs(options or {}) do
      local expected = names.options[name] or parameters[name]
      if type(value) ~= expected then
        local what = expected and "a " .. expected or "gripper, force or a station parameter"
        native.fail("BAD_ARGUMENT", ("%s: %s (expected %s)"):format(tostring(name), tostring(value), what))
      end
    end
    return options or {}
  end

  local function is_one_of(value, ...)
    for _, known in ipairs({ ... }) do
      if value == known then
        return true
      end
    end
    return false
  end

  -- Strokes end where the neighbouring slots begin: a GET from below the next one would take its wafer.
  local function stroke_rules(job, station)
    local pitch = station.slots > 1 and station.pitch or math.huge
    return {
      { "stroke", job.stroke > 0, "above 0" },
      { "offset", job.offset >= 0 and job.offset <= job.stroke, "from 0 to the stroke" },
      { "stroke", math.max(job.stroke - job.offset, job.offset) < pitch,
        ("within the pitch of %.10g mm below and above the slot"):format(pitch) },
      { "retract", job.retract > 0, "above 0" },
      { "release", job.release >= job.offset - job.stroke and job.release <= job.offset, "within the stroke" },
    }
  end

  local function other_rules(job, layout)
    local window = layout.tolerance.projz / layout.slice
    return {
      { "pickup_speed", job.pickup_speed > 0, "above 0" },
      { "pickup_speed", not layout.sampled or job.pickup_speed <= window,
        ('at most %.10g mm/s with these slices, or a layout with check = "swept"'):format(window) },
      { "pickup_acceleration", job.pickup_acceleration == 0 or job.pickup_acceleration >= 1e-6, "0, or 1e-6 or more" },
      { "map_speed", job.map_speed > 0, "above 0" },
      { "vacuum_delay", job.vacuum_delay >= 0, "0 or more" },
      { "timeout", job.timeout >= 0, "0 or more" },
      { "wait", job.wait >= 0, "0 or more" },
      { "retries", math.tointeger(job.retries) and job.retries >= 0 and job.retries <= 100, "a whole number from 0 to 100" },
      { "handover", is_one_of(job.handover, "new_first", "same_slice"), '"new_first" or "same_slice"' },
      { "vacuum_check", is_one_of(job.vacuum_check, "both", "get", "put", "none"), '"both", "get", "put" or "none"' },
    }
  end

  local function check(job, rules)
    for _, rule in ipairs(rules) do
      if not rule[2] then
        native.fail("BAD_ARGUMENT", ("%s: %s (expected %s)"):format(rule[1], names.quote(job[rule[1]]), rule[3]))
      end
    end
  end

  -- The job of `word`, "get" or "put", at a slot. `gripper` (an index) overrules what the station says.
  function jobs.at(word, station_name, slot, options, gripper)
    local station = names.station(station_name)
    local number = names.slot(station, slot)
    options = check_options(options)
    if not station.taught then
      native.fail("NOT_TAUGHT", names.quote(station.name))
    end
    local job = { station = station.name, slot = number, chuck = station.chuck, force = options.force, watched = true }
    job.gripper = gripper or names.effector(options.gripper, station.effector)
    job.place = native.slot(station.index, number)
    job.is_on, job.is_loaded = arm.is_on, arm.is_loaded
    for name in pairs(parameters) do
      job[name] = options[name]
      if job[name] == nil then
        job[name] = station[name]
      end
    end
    check(job, stroke_rules(job, station))
    check(job, other_rules(job, native.layout()))
    job.asks = job.vacuum_check == "both" or job.vacuum_check == word
    job.watched = job.asks
    function job.inverse(x, y, z, heading)
      return native.inverse(x, y, z, heading, job.gripper)
    end
    return job
  end

  return jobs
end
