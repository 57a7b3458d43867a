-- The word for patterns that a file of patterns adds: see lua/mcs/own_patterns.lua.

-- A local copy: a script may set a global of this name.
local table = table

return function(native, lookup, arm, player, targets, align, centring, slot_map, times, own)
  local words = {}

  -- A blade without a wafer is prepared for it as for a GET, one with a wafer as for a PUT.
  local function target_of(station, slot, options)
    local target = targets.at("get", station, slot, options, nil, "")
    if native.sensor(target.gripper) then
      target = targets.at("put", station, slot, options, nil, "")
      target.loaded = true
    end
    return target
  end

  local function play(name, station, slot, options)
    local target = target_of(station, slot, options)
    local pattern = own.find(name)
    arm.check_free()
    times.check(target.loaded and "put" or "get", target)
    slot_map.check_way(target)
    local plan = player.rehearse(pattern, target, true)
    slot_map.forget(target)
    align.forget(target.station)
    player.drive(plan, function(became)
      centring.know_notch(target.gripper)
      own.judge(became)
    end)
  end

  -- pattern("look", "A", 1).
  function words.pattern(name, station, slot, options)
    local fields = table.move(lookup.correction_fields, 1, #lookup.correction_fields, 1, {})
    fields[#fields + 1], fields[#fields + 2] = "stop", "force"
    local text = lookup.command("PATTERN", name, station, slot, lookup.fields_text(options, fields))
    arm.move(arm.needs(true, station, options), text, play, name, station, slot, options)
  end

  return words
end
