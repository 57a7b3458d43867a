-- The operator's words that carry wafers: GET, PUT, SWAP; READY, which only goes there; MAP, which only looks.

-- Kept, for a script may set globals of these names.
local ipairs, pcall = ipairs, pcall

return function(native, patterns, names, arm, jobs)
  local transfer = {}

  local book = native.module("mcs/book.lua")(native)

  --------------------------------------------------------------------------------------------- GET and PUT

  -- A sensor that is on behind a closed valve says nothing of wafers.
  local function check_empty(job)
    if job.asks and native.sensor(job.gripper) then
      native.fail(native.is_open(job.gripper) and "WAFER_ON_GRIPPER" or "VACUUM_BEFORE_PICK")
    end
  end

  local function check_loaded(job)
    if job.asks and not native.sensor(job.gripper) then
      native.fail("NO_WAFER_ON_GRIPPER")
    end
  end

  -- What a GET's pattern found, as an error unless it is a wafer.
  local function judge_get(job, found)
    if found == "missing" then
      native.fail("WAFER_MISSING", native.explain(job.gripper))
    elseif found == "late" then
      native.fail("VACUUM_TIMEOUT", "a wafer lay on the pads")
    elseif found == "early" then
      native.fail("VACUUM_BEFORE_PICK", "with the valve open below the slot")
    end
  end

  local function judge_put(job, became)
    if became == "lost" then
      native.fail("WAFER_LOST", native.explain(job.chuck))
    elseif became == "loose" then
      native.fail("VACUUM_TIMEOUT", "the wafer lies on the chuck")
    end
  end

  local function get(station, slot, options)
    local job = jobs.at("get", station, slot, options)
    arm.check_free()
    check_empty(job)
    book.check_get(job)
    arm.rehearse(patterns.get, job, true)
    book.forget(job)
    judge_get(job, arm.drive(patterns.get, job))
    book.note_taken(job)
  end

  local function put(station, slot, options)
    local job = jobs.at("put", station, slot, options)
    arm.check_free()
    check_loaded(job)
    book.check_put(job)
    arm.rehearse(patterns.put, job, true)
    book.forget(job)
    judge_put(job, arm.drive(patterns.put, job))
    book.note_put(job)
  end

  function transfer.get(station, slot, options)
    arm.run(names.command("GET", station, slot), get, station, slot, options)
  end

  function transfer.put(station, slot, options)
    arm.run(names.command("PUT", station, slot), put, station, slot, options)
  end

  ---------------------------------------------------------------------------------------------------- SWAP

  -- The robot's grippers: the first empty one and the first that holds a wafer, as the sensors tell.
  local function choose_grippers()
    local empty, loaded, count
    count = 0
    for index, gripper in ipairs(native.layout().grippers) do
      if gripper.on_robot then
        count = count + 1
        if native.sensor(index) then
          loaded = loaded or index
        else
          empty = empty or index
        end
      end
    end
    if count < 2 then
      native.fail("NO_SUCH_GRIPPER", "SWAP takes with one and puts with another (expected two on the robot)")
    elseif not loaded then
      native.fail("NO_WAFER_ON_GRIPPER", "SWAP puts what one of them holds")
    elseif not empty then
      native.fail("WAFER_ON_GRIPPER", "SWAP takes with an empty one")
    end
    return empty, loaded
  end

  local function swap(station, slot, options)
    names.slot(names.station(station), slot)
    local empty, loaded = choose_grippers()
    local take = jobs.at("get", station, slot, options, empty)
    local give = jobs.at("put", station, slot, options, loaded)
    local job = { get = take, put = give, watched = take.watched }
    arm.check_free()
    check_empty(take)
    book.check_get(take)
    arm.rehearse(patterns.swap, job, true)
    book.forget(take)
    local became = arm.drive(patterns.swap, job)
    judge_get(take, became)
    judge_put(give, became)
    book.note_put(give)
  end

  -- Takes the wafer there with the empty gripper and puts down what another one holds.
  function transfer.swap(station, slot, options)
    arm.run(names.command("SWAP", station, slot), swap, station, slot, options)
  end

  --------------------------------------------------------------------------------------------------- READY

  local function ready(station, slot, options)
    local job = jobs.at("get", station, slot, options)
    arm.check_free()
    job.loaded = native.sensor(job.gripper)
    arm.play(patterns.ready, job)
  end

  -- Goes in front of the slot, to where a GET or, with a wafer, a PUT enters.
  function transfer.ready(station, slot, options)
    arm.run(names.command("READY", station, slot), ready, station, slot, options)
  end

  ----------------------------------------------------------------------------------------------------- MAP

  local function map(name, options)
    local job = jobs.at("get", name, 1, options)
    local station = names.station(name)
    arm.check_free()
    job.margin = station.pitch / 2
    job.height = (station.slots - 1) * station.pitch
    arm.play(patterns.map, job)
    local codes = native.scan(station.index)
    book.map(name, codes)
    return codes
  end

  -- Sweeps over the station's slots; returns a list of their codes: 0 empty, 1 single, 2 double, 4 crossed.
  function transfer.map(station, options)
    return arm.run(names.command("MAP", station), map, station, options)
  end

  ----------------------------------------------------------------------------------------------- rehearsal

  -- Plans GET and PUT at a slot from where the arm stands, without playing them; returns what is out of reach.
  function transfer.rehearse(station, slot)
    local _, problem = pcall(function()
      arm.rehearse(patterns.get, jobs.at("get", station, slot))
      arm.rehearse(patterns.put, jobs.at("put", station, slot))
    end)
    return problem
  end

  return transfer
end
