-- The slot book: what the controller knows of each slot, from the last MAP and from its own GETs and PUTs since. It
-- never looks into the cell: what it has not seen is unknown, and unknown slots may be entered.

-- Kept, for a script may set globals of these names.
local ipairs = ipairs

return function(native)
  local book = {}

  local EMPTY, SINGLE, DOUBLE, CROSSED = 0, 1, 2, 4
  local words = { [EMPTY] = "empty", [SINGLE] = "single", [DOUBLE] = "doubled", [CROSSED] = "crossed" }

  -- By station: codes by slot, and whether the station has been mapped.
  local known = {}

  local function page(station)
    known[station] = known[station] or { mapped = false, codes = {} }
    return known[station]
  end

  function book.map(station, codes)
    local copy = {}
    for slot, code in ipairs(codes) do
      copy[slot] = code
    end
    known[station] = { mapped = true, codes = copy }
  end

  -- What is in the slot is unknown from here on.
  function book.forget(job)
    page(job.station).codes[job.slot] = nil
  end

  function book.note_taken(job)
    page(job.station).codes[job.slot] = EMPTY
  end

  function book.note_put(job)
    page(job.station).codes[job.slot] = SINGLE
  end

  -- A doubled or crossed slot, or one beside it: the blade would run into a wafer.
  local function check_way(job, codes)
    for slot = job.slot - 1, job.slot + 1 do
      if codes[slot] == DOUBLE or codes[slot] == CROSSED then
        native.fail("BAD_SLOT", ("%s slot %d is %s"):format(job.station, slot, words[codes[slot]]))
      end
    end
  end

  local function check_mapped(job)
    if job.check_map and not page(job.station).mapped then
      native.fail("NOT_MAPPED", ("%s: MAP comes first, for check_map is true"):format(job.station))
    end
  end

  -- Whether the blade may go in, and what is known of the slot; `force` asks nothing of the book.
  local function check_entry(job, judge)
    if not job.force then
      check_mapped(job)
      local entry = page(job.station)
      check_way(job, entry.codes)
      judge(job, entry)
    end
  end

  local function is_there(job, entry)
    if entry.mapped and entry.codes[job.slot] == EMPTY then
      native.fail("WAFER_MISSING", ("%s slot %d is empty in the map"):format(job.station, job.slot))
    end
  end

  local function is_room(job, entry)
    if entry.codes[job.slot] == SINGLE or job.chuck and native.sensor(job.chuck) then
      native.fail("WAFER_ALREADY_THERE", ("%s slot %d"):format(job.station, job.slot))
    end
  end

  function book.check_get(job)
    check_entry(job, is_there)
  end

  function book.check_put(job)
    check_entry(job, is_room)
  end

  return book
end
