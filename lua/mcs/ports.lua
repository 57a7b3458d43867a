-- Load ports: carriers that come and go, the port's states, and what commands that enter one ask of it.

-- Local copies: a script may set globals of these names.
local ipairs, math, pairs, select = ipairs, math, pairs, select
local table, tostring, type = table, tostring, type

return function(native, patterns, lookup, arm, player, slot_map)
  local ports = {}

  -- How much longer than described a command waits, s.
  local GRACE = 60

  -- By state, from the one without a carrier on; `take_away` leads to the first.
  lookup.port_states = { "placed", "clamped", "docked", "open", "mapped" }

  local function seconds(value)
    return ("%.3f"):format(value):gsub("%.?0+$", "")
  end

  -- A load port as an error tells it: what it is, and what runs there.
  local function how_is(name, index)
    local state, step, left = native.port(index)
    return step and ("%s is %s, and %s runs for %s s yet"):format(name, state, step, seconds(left))
      or ("%s is %s"):format(name, state)
  end

  local function need_port(name)
    local station = lookup.station(name)
    if not station.is_port then
      local names = {}
      for other, of in pairs(native.layout.stations) do
        names[#names + 1] = of.is_port and other or nil
      end
      local expected = #names > 0 and "a load port: " .. lookup.listed(names)
        or 'none: no station of the layout has kind = "load_port"'
      native.fail("BAD_ARGUMENT", ("station: %s (expected %s)"):format(lookup.quote(name), expected))
    end
    return station
  end

  -------------------------------------------------------------------------------------------- commands that enter

  -- The slot book goes by the port's own mapper, and is forgotten when the carrier goes.
  local function take_map(name, index)
    local changes, codes = native.port_map(index)
    slot_map.take(name, changes, codes)
  end

  -- Call it before a command goes into a station: into a load port only while that is open and stands.
  function ports.check(name)
    local station = native.layout.stations[name]
    if not station or not station.is_port or not native.port(station.index) then
      return
    end
    if not native.is_port_open(station.index) then
      local state, step = native.port(station.index)
      local waits = step or state == "absent" and native.rest(station.index)
      local hint = state == "absent" and not waits and ('carrier("%s") brings one'):format(name)
        or waits and ('wait_for("%s") comes first'):format(name) or ('port("%s", "open") comes first'):format(name)
      native.fail("PORT_NOT_OPEN", ("%s (expected open or mapped: %s)"):format(how_is(name, station.index), hint))
    end
    take_map(name, station.index)
  end

  --------------------------------------------------------------------------------------------- carriers that come

  local FIELD_NAMES = { "name", "wafers", "slots", "at" }
  local FIELDS = { name = true, wafers = true, slots = true, at = true }
  local CHANGES = { "empty", "protruded", "crossed", "double" }

  local function check_name(name)
    local names, is_known = native.layout.carriers, name == nil
    for _, known in ipairs(names) do
      is_known = is_known or known == name
    end
    if not is_known then
      native.fail("BAD_ARGUMENT", ("name: %s (expected a carrier of the layout: %s%s)"):format(lookup.quote(name),
        #names > 0 and lookup.listed(names) or "there is none", lookup.nearest(name, names)))
    end
  end

  -- The carrier that is meant: of this name, or the first one that is away.
  local function find_carrier(name)
    local names = native.layout.carriers
    for index, known in ipairs(names) do
      local at = native.carrier(index)
      if name == nil and not at then
        return index, known
      elseif known == name and at then
        native.fail("CARRIER_THERE", ("%s is at %s, or is to come there (expected one that is away)"):format(known, at))
      elseif known == name then
        return index, known
      end
    end
    native.fail("NO_CARRIER", #names > 0 and "all carriers of the layout are at load ports, or are to come there"
      or "the layout has no `carriers`")
  end

  local function fail_slot(slot, carrier)
    native.fail("BAD_ARGUMENT", ("slot: %s (expected one with a wafer that is in %s)"):format(lookup.quote(slot), carrier))
  end

  -- The slots, in order, whose wafer is in the carrier, or was left out before and may come again.
  local function slots_of(has, out)
    local slots = lookup.names(has)
    for slot in pairs(out) do
      slots[#slots + 1] = not has[slot] and slot or nil
    end
    table.sort(slots)
    return slots
  end

  -- The wafers that come by `wafers`: how many of them, or those of which slots. The others stay away.
  local function find_coming(wafers, has, out, carrier)
    local slots, comes = slots_of(has, out), {}
    if type(wafers) == "table" then
      for _, slot in ipairs(wafers) do
        if math.type(slot) ~= "integer" or not has[slot] and not out[slot] then
          fail_slot(slot, carrier)
        end
        comes[slot] = true
      end
    elseif math.type(wafers) ~= "integer" or wafers < 0 or wafers > #slots then
      native.fail("BAD_ARGUMENT", ("wafers: %s (expected 0 to %d, or a list of slots: so many are in %s)"):format(
        lookup.quote(wafers), #slots, carrier))
    else
      for place = 1, wafers do
        comes[slots[place]] = true
      end
    end
    return comes
  end

  local function leave_out(comes, has, changes)
    for slot in pairs(has) do
      changes[slot] = not comes[slot] and "empty" or nil
    end
    for slot in pairs(comes) do
      changes[slot] = not has[slot] and "in" or nil
    end
  end

  -- `slots`: how the wafers of some slots come.
  local function change(slots, has, carrier, changes)
    for slot, how in pairs(slots or {}) do
      if math.type(slot) ~= "integer" or not has[slot] or changes[slot] then
        fail_slot(slot, carrier)
      end
      lookup.value("slots", how, { values = CHANGES })
      if how == "double" and (not has[slot + 1] or changes[slot + 1]) then
        native.fail("BAD_ARGUMENT", ("slots: %d is double (expected a wafer in slot %d, which then lies on it)"):format(slot,
          slot + 1))
      end
      changes[how == "double" and slot + 1 or slot] = how
    end
  end

  local function check_room(station, has, carrier, changes)
    for slot in pairs(has) do
      if slot > station.slots and changes[slot] ~= "empty" then
        native.fail("BAD_ARGUMENT", ("%s has a wafer in slot %d (expected at most %d, the slots of %s)"):format(carrier, slot,
          station.slots, station.name))
      end
    end
  end

  local function carrier(name, options)
    lookup.station(name)
    options = options == nil and {} or options
    for field, value in pairs(lookup.table("options", options)) do
      if not FIELDS[field] then
        lookup.refuse_field(field, value, FIELD_NAMES)
      end
    end
    local now, changes = native.utime() / 1e6, {}
    local at = options.at == nil and now or lookup.number("at", options.at, { nil, nil, "s" })
    if at < now then
      native.fail("BAD_ARGUMENT", ("at: %s s (expected %s s, which is now, or later)"):format(seconds(at), seconds(now)))
    end
    if options.slots ~= nil and type(options.slots) ~= "table" then
      native.fail("BAD_ARGUMENT", ("slots: %s (expected a table, such as { [3] = \"crossed\" })"):format(
        lookup.quote(options.slots)))
    end
    check_name(options.name)
    local station = need_port(name)
    local index, known = find_carrier(options.name)
    local _, has, out = native.carrier(index)
    if options.wafers ~= nil then
      leave_out(find_coming(options.wafers, has, out, known), has, changes)
    end
    change(options.slots, has, known, changes)
    check_room(station, has, known, changes)
    native.bring(index, station.index, at, changes)
    return known
  end

  -- "wafers=1,3" and the like, for the record.
  local function text_of(station, options)
    options = type(options) == "table" and options or {}
    local wafers = options.wafers
    if type(wafers) == "table" then
      local list = {}
      for i, slot in ipairs(wafers) do
        list[i] = tostring(slot)
      end
      wafers = table.concat(list, ",")
    end
    local list = {}
    for slot, how in pairs(type(options.slots) == "table" and options.slots or {}) do
      list[#list + 1] = ("%s:%s"):format(slot, how)
    end
    table.sort(list)
    return lookup.command("CARRIER", station, lookup.fields_text({ name = options.name, wafers = wafers, at = options.at,
      slots = list[1] and table.concat(list, ",") or nil }, { "name", "wafers", "slots", "at" }))
  end

  -- carrier("LP1", { name = "C1", wafers = { 1, 3 }, slots = { [3] = "crossed" }, at = 30 }): a carrier comes, at once or at
  -- that time; wait_for waits for it. Returns its name.
  function ports.carrier(station, options)
    return arm.run(arm.needs_lock(station), text_of(station, options), carrier, station, options)
  end

  ------------------------------------------------------------------------------------------------- where it goes

  local function fail_if_timed_out(name, index)
    local _, _, _, _, failed = native.port(index)
    if failed then
      native.tell_port(index)
      local state = native.port(index)
      native.fail("HANDSHAKE_TIMEOUT", ("%s: %s ran out; %s"):format(name, failed, state == "absent" and "no carrier is there"
        or "the carrier is placed"))
    end
  end

  -- Waits until no step runs at the port.
  local function await(station)
    local _, step, left = native.port(station.index)
    if step then
      local timeout = math.min(left + GRACE, lookup.ranges.seconds[2])
      local stands = player.play(patterns.arrive, { segment = { arrives = { port = station.index }, timeout = timeout } })
      if not stands then
        native.fail("STATION_TIMEOUT", ("%s within %s s: %s"):format(station.name, seconds(timeout),
          how_is(station.name, station.index)))
      end
    end
  end

  local function check_empty(station)
    local inside = arm.find_inside(station.name)
    if inside then
      local text = "the arm stands in %s slot %d since %s: CONTINUE, RECOVER or HOME comes first"
      native.fail("PORT_ENTERED", text:format(station.name, inside.inside.slot, inside.since))
    end
  end

  -- A carrier whose time is still to come is waited for by WAIT_FOR alone.
  local function fail_absent(station)
    local first = native.rest(station.index) and "a carrier is to come: wait_for" or "carrier"
    native.fail("NO_CARRIER", ('%s is absent: %s("%s") comes first'):format(station.name, first, station.name))
  end

  local function send(station, state)
    check_empty(station)
    local is, step = native.port(station.index)
    if is == "absent" and not step then
      fail_absent(station)
    end
    if step then
      await(station)
      fail_if_timed_out(station.name, station.index)
    end
    if not native.send_port(station.index, state) then
      fail_absent(station)
    end
    await(station)
    fail_if_timed_out(station.name, station.index)
  end

  local function port(name, state)
    lookup.station(name)
    lookup.value("state", state, { values = lookup.port_states })
    send(need_port(name), state)
  end

  -- port("LP1", "docked"): the load port has this state when the command has ended.
  function ports.port(station, state)
    arm.move(arm.needs_lock(station), lookup.command("PORT", station, state), port, station, state)
  end

  local function take_away(name)
    send(need_port(name), "absent")
  end

  -- take_away("LP1"): the carrier, with what lies in it, is gone when the command has ended.
  function ports.take_away(station)
    arm.move(arm.needs_lock(station), lookup.command("TAKE_AWAY", station), take_away, station)
  end

  ------------------------------------------------------------------------------------------------------- WAIT_FOR

  -- For messages, the thing that has not ended at a load port; and the error of a handshake that has failed.
  ports.how_is, ports.fail_if_timed_out = how_is, fail_if_timed_out

  -- The codes by slot that the load port has mapped of its carrier, or nil.
  function ports.port_map(name)
    local _, codes = native.port_map(need_port(name).index)
    return codes
  end

  return ports
end
