-- The operator's words that carry wafers: GET, PUT, SWAP; READY, which only goes there; MAP, which only
-- looks.

-- Kept, for a script may set globals of these names.
local ipairs, pcall = ipairs, pcall

return function(native, patterns, lookup, arm, targets)
  local transfer = {}

  local slot_map = native.module("mcs/slot_map.lua")(native)

  ------------------------------------------------------------------------------------------------ GET and PUT

  -- A sensor that is on behind a closed valve says nothing of wafers.
  local function check_empty(target)
    if target.asks and native.sensor(target.gripper) then
      native.fail(native.is_open(target.gripper) and "WAFER_ON_GRIPPER" or "VACUUM_BEFORE_PICK")
    end
  end

  local function check_loaded(target)
    if target.asks and not native.sensor(target.gripper) then
      native.fail("NO_WAFER_ON_GRIPPER")
    end
  end

  -- Why the running command took nothing with it.
  local function explain(gripper)
    local wafer, reasons = native.closest(gripper)
    return wafer and ("closest to %s: %s"):format(wafer, reasons) or "no wafer came near"
  end

  -- What a GET's pattern found, as an error unless it is a wafer.
  local function judge_get(target, found)
    if found == "missing" then
      native.fail("WAFER_MISSING", explain(target.gripper))
    elseif found == "late" then
      native.fail("VACUUM_TIMEOUT", "a wafer lay on the pads")
    elseif found == "early" then
      native.fail("VACUUM_BEFORE_PICK", "with the valve open below the slot")
    end
  end

  local function judge_put(target, became)
    if became == "lost" then
      native.fail("WAFER_LOST", explain(target.chuck))
    elseif became == "loose" then
      native.fail("VACUUM_TIMEOUT", "the wafer lies on the chuck")
    end
  end

  local transfers = {
    get = { pattern = patterns.get, check_gripper = check_empty, check_slot = slot_map.check_get,
            judge = judge_get, note = slot_map.note_taken },
    put = { pattern = patterns.put, check_gripper = check_loaded, check_slot = slot_map.check_put,
            judge = judge_put, note = slot_map.note_put },
  }

  local function carry(word, station, slot, options)
    local kind, target = transfers[word], targets.at(word, station, slot, options)
    arm.check_free()
    kind.check_gripper(target)
    kind.check_slot(target)
    local plan = arm.rehearse(kind.pattern, target, true)
    slot_map.forget(target)
    kind.judge(target, arm.drive(kind.pattern, target, plan))
    kind.note(target)
  end

  function transfer.get(station, slot, options)
    arm.run(lookup.command("GET", station, slot), carry, "get", station, slot, options)
  end

  function transfer.put(station, slot, options)
    arm.run(lookup.command("PUT", station, slot), carry, "put", station, slot, options)
  end

  ------------------------------------------------------------------------------------------------------- SWAP

  -- The robot's grippers: the first empty one and the first that holds a wafer, as the sensors tell.
  local function choose_grippers()
    local empty, loaded, count
    count = 0
    for index, gripper in ipairs(native.layout.grippers) do
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
    lookup.slot(lookup.station(station), slot)
    local empty, loaded = choose_grippers()
    local take = targets.at("get", station, slot, options, empty)
    local give = targets.at("put", station, slot, options, loaded)
    local target = { get = take, put = give, watched = take.watched }
    arm.check_free()
    check_empty(take)
    slot_map.check_get(take)
    local plan = arm.rehearse(patterns.swap, target, true)
    slot_map.forget(take)
    local became = arm.drive(patterns.swap, target, plan)
    judge_get(take, became)
    judge_put(give, became)
    slot_map.note_put(give)
  end

  -- Takes the wafer there with the empty gripper and puts down what another one holds.
  function transfer.swap(station, slot, options)
    arm.run(lookup.command("SWAP", station, slot), swap, station, slot, options)
  end

  ------------------------------------------------------------------------------------------------------ READY

  local function ready(station, slot, options)
    local target = targets.at("get", station, slot, options)
    arm.check_free()
    target.loaded = native.sensor(target.gripper)
    arm.play(patterns.ready, target)
  end

  -- Goes in front of the slot, to where a GET or, with a wafer, a PUT enters.
  function transfer.ready(station, slot, options)
    arm.run(lookup.command("READY", station, slot), ready, station, slot, options)
  end

  -------------------------------------------------------------------------------------------------------- MAP

  local function map(name, options)
    local target = targets.at("get", name, 1, options)
    local station = lookup.station(name)
    arm.check_free()
    target.margin = station.pitch / 2
    target.height = (station.slots - 1) * station.pitch
    arm.play(patterns.map, target)
    local codes = native.scan(station.index)
    slot_map.map(name, codes)
    return codes
  end

  -- Sweeps over the station's slots; returns a list of their codes: 0 empty, 1 single, 2 double, 4 crossed.
  function transfer.map(station, options)
    return arm.run(lookup.command("MAP", station), map, station, options)
  end

  -------------------------------------------------------------------------------------------------- rehearsal

  -- Plans GET and PUT at a slot from where the arm stands, without playing them; returns what is out of
  -- reach.
  function transfer.rehearse(station, slot)
    local _, problem = pcall(function()
      arm.rehearse(patterns.get, targets.at("get", station, slot))
      arm.rehearse(patterns.put, targets.at("put", station, slot))
    end)
    return problem
  end

  return transfer
end
