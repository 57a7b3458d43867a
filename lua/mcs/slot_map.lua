-- The slot map: the controller's knowledge of each slot, from the last MAP and from its own GETs and PUTs
-- since. It never looks into the cell: an unseen slot is unknown, and unknown slots may be entered.

-- Local copies: a script may set globals of these names.
local ipairs, pairs = ipairs, pairs

return function(native)
  local slot_map = {}

  -- lib/mcs/slot_codes.h has the rule.
  local EMPTY, SINGLE, DOUBLE, PROTRUDED, CROSSED, THICK, THIN = 0, 1, 2, 3, 4, 5, 6
  local WORDS = { [DOUBLE] = "doubled", [PROTRUDED] = "protruded", [CROSSED] = "crossed",
    [THICK] = "too thick", [THIN] = "too thin" }

  -- Codes for which no blade may enter the neighbouring slots either: the wafer may be in its way there.
  local BESIDE = { [DOUBLE] = true, [CROSSED] = true, [THICK] = true }

  -- By station: codes by slot, and whether the station has been mapped.
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
    known[station] = { mapped = true, codes = copy, changes = of_station(station).changes }
  end

  -- Takes what a load port has mapped in place of all that was known of the station; `changes` tells one map from another.
  function slot_map.take(station, changes, codes)
    local entry = known[station]
    if (entry and entry.changes or 0) ~= changes then
      known[station] = nil
      if codes then
        slot_map.map(station, codes)
      end
      of_station(station).changes = changes
    end
  end

  -- The slot's content is unknown from here on.
  function slot_map.forget(target)
    of_station(target.station).codes[target.slot] = nil
  end

  function slot_map.note_taken(target)
    of_station(target.station).codes[target.slot] = EMPTY
  end

  function slot_map.note_put(target)
    of_station(target.station).codes[target.slot] = SINGLE
  end

  -- Refuses a slot with a wafer that must not be taken, or next to a slot whose wafer the blade would hit.
  local function check_way(target, codes)
    for slot = target.slot - 1, target.slot + 1 do
      local word = WORDS[codes[slot]]
      if word and (slot == target.slot or BESIDE[codes[slot]]) then
        local beside = slot ~= target.slot and (", beside slot %d,"):format(target.slot) or ""
        native.fail("BAD_SLOT", ("%s slot %d%s is %s"):format(target.station, slot, beside, word))
      end
    end
  end

  local function check_mapped(target)
    if target.check_map and not of_station(target.station).mapped then
      native.fail("NOT_MAPPED", ("%s: MAP comes first, for check_map is true"):format(target.station))
    end
  end

  -- Refuses if the blade may not enter, or because of the slot's known content; `force` skips the map.
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

  -- Refuses only what no blade may enter.
  function slot_map.check_way(target)
    check_entry(target, function() end)
  end

  function slot_map.check_get(target)
    check_entry(target, is_there)
  end

  function slot_map.check_put(target)
    check_entry(target, is_room)
  end

  -- Returns a function that restores the present map.
  function slot_map.keep()
    local function copy(map)
      local copied = {}
      for station, entry in pairs(map) do
        copied[station] = { mapped = entry.mapped, codes = {}, changes = entry.changes }
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
