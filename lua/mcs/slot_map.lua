-- The slot map: what the controller knows of each slot, from the last MAP and from its own GETs and PUTs
-- since. It never looks into the cell: what it has not seen is unknown, and unknown slots may be entered.

-- Kept, for a script may set globals of these names.
local ipairs, pairs = ipairs, pairs

return function(native)
  local slot_map = {}

  local EMPTY, SINGLE, DOUBLE, CROSSED = 0, 1, 2, 4
  local WORDS = { [EMPTY] = "empty", [SINGLE] = "single", [DOUBLE] = "doubled", [CROSSED] = "crossed" }

  -- By station: codes by slot, and if the station has been mapped.
  local known = {}

  local function of_station(station)
    known[station] = known[station] or { mapped = false, codes = {} }
    return known[station]
  end

  function slot_map.map(station, codes)
    local copy = {}
    for slot, code in ipairs(codes) do
      copy[slot] = code
    end
    known[station] = { mapped = true, codes = copy }
  end

  -- What is in the slot is unknown from here on.
  function slot_map.forget(target)
    of_station(target.station).codes[target.slot] = nil
  end

  function slot_map.note_taken(target)
    of_station(target.station).codes[target.slot] = EMPTY
  end

  function slot_map.note_put(target)
    of_station(target.station).codes[target.slot] = SINGLE
  end

  -- A doubled or crossed slot, or one beside it: the blade would run into a wafer.
  local function check_way(target, codes)
    for slot = target.slot - 1, target.slot + 1 do
      if codes[slot] == DOUBLE or codes[slot] == CROSSED then
        local beside = slot ~= target.slot and (", beside slot %d,"):format(target.slot) or ""
        local text = "%s slot %d%s is %s"
        native.fail("BAD_SLOT", text:format(target.station, slot, beside, WORDS[codes[slot]]))
      end
    end
  end

  local function check_mapped(target)
    if target.check_map and not of_station(target.station).mapped then
      native.fail("NOT_MAPPED", ("%s: MAP comes first, for check_map is true"):format(target.station))
    end
  end

  -- Refuses if the blade may not go in, or for what is known of the slot; `force` asks nothing of the map.
  local function check_entry(target, judge)
    if not target.force then
      check_mapped(target)
      local entry = of_station(target.station)
      check_way(target, entry.codes)
      judge(target, entry)
    end
  end

  local function is_there(target, entry)
    if entry.mapped and entry.codes[target.slot] == EMPTY then
      local text = "%s slot %d is empty by the slot book; nothing has moved"
      native.fail("WAFER_MISSING", text:format(target.station, target.slot))
    end
  end

  local function is_room(target, entry)
    local place = ("%s slot %d"):format(target.station, target.slot)
    if entry.codes[target.slot] == SINGLE then
      native.fail("WAFER_ALREADY_THERE", place .. ", by the slot book: from a MAP or a PUT")
    elseif target.chuck and native.sensor(target.chuck) then
      local chuck = native.layout.grippers[target.chuck].name
      native.fail("WAFER_ALREADY_THERE", ("%s: the sensor of its chuck, %s, is on"):format(place, chuck))
    end
  end

  function slot_map.check_get(target)
    check_entry(target, is_there)
  end

  function slot_map.check_put(target)
    check_entry(target, is_room)
  end

  -- A function that makes the map again what it is now.
  function slot_map.keep()
    local function copy(map)
      local copied = {}
      for station, entry in pairs(map) do
        copied[station] = { mapped = entry.mapped, codes = {} }
        for slot, code in pairs(entry.codes) do
          copied[station].codes[slot] = code
        end
      end
      return copied
    end
    local kept = copy(known)
    return function()
      known = copy(kept)
    end
  end

  return slot_map
end
