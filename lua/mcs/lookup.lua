-- From what an operator writes to what the host knows: stations, slots, grippers, wafers, numbers. Each refuses
-- what it does not know with a numbered error that names it.

-- Kept, for a script may set globals of these names.
local ipairs, math, pairs, table, tonumber, tostring, type = ipairs, math, pairs, table, tonumber, tostring, type

return function(native, errors)
  local lookup = { errors = errors }

  -- Station parameters that a command may set for itself, what else it may say, and the fields of MOVE and LINE in
  -- order.
  lookup.parameters = {
    stroke = "number", offset = "number", retract = "number", pickup_speed = "number", pickup_acceleration = "number",
    release = "number", vacuum_delay = "number", vacuum_check = "string", timeout = "number", retries = "number",
    wait = "number", map_speed = "number", check_map = "boolean", handover = "string",
  }
  lookup.options = { gripper = "string", force = "boolean" }
  lookup.axes = { "theta", "r", "z", "yaw" }
  lookup.line_fields = { "dx", "dy", "dz", "speed" }

  function lookup.quote(value)
    return type(value) == "string" and ('"%s"'):format(value) or tostring(value)
  end

  local function listed(map)
    local all = {}
    for name in pairs(map) do
      all[#all + 1] = name
    end
    return table.concat(all, ", ")
  end

  function lookup.station(name)
    local stations = native.layout.stations
    if type(name) ~= "string" or not stations[name] then
      native.fail("NO_SUCH_STATION", ("%s (expected %s)"):format(lookup.quote(name), listed(stations)))
    end
    return stations[name]
  end

  function lookup.slot(station, slot)
    local whole = math.tointeger(slot)
    if type(slot) ~= "number" or not whole or whole < 1 or whole > station.slots then
      local expected = ("%s has slots 1 to %d"):format(station.name, station.slots)
      native.fail("NO_SUCH_SLOT", ("%s (%s)"):format(lookup.quote(slot), expected))
    end
    return whole
  end

  function lookup.gripper(name)
    local known = {}
    for index, gripper in ipairs(native.layout.grippers) do
      if gripper.name == name then
        return index
      end
      known[#known + 1] = gripper.name
    end
    native.fail("NO_SUCH_GRIPPER", ("%s (expected %s)"):format(lookup.quote(name), table.concat(known, ", ")))
  end

  -- A gripper on the robot: the named one, the one with the index `otherwise`, or the first.
  function lookup.effector(name, otherwise)
    local grippers = native.layout.grippers
    if name ~= nil then
      local index = lookup.gripper(name)
      if not grippers[index].on_robot then
        native.fail("NO_SUCH_GRIPPER", lookup.quote(name) .. " (expected one on the robot)")
      end
      return index
    end
    if otherwise then
      return otherwise
    end
    for index, gripper in ipairs(grippers) do
      if gripper.on_robot then
        return index
      end
    end
  end

  function lookup.wafer(name)
    local index = type(name) == "string" and native.wafer(name) or nil
    if not index then
      native.fail("NO_SUCH_WAFER", lookup.quote(name))
    end
    return index
  end

  ------------------------------------------------------------------------------------------------- frames

  -- "B/10", where B is a station: that, and what stands for the slot.
  local function split_slot(stations, name)
    local station, slot = name:match("^(.*)/(%d+)$")
    return stations[station], math.tointeger(tonumber(slot)) or slot
  end

  local function slot_frame(stations, name)
    local station, slot = split_slot(stations, name)
    local exists = station and math.type(slot) == "integer" and slot >= 1 and slot <= station.slots
    return exists and ("%s/%d"):format(station.name, slot) == name and native.slot_pose(station.index, slot)
  end

  local function station_frame(stations, name)
    return stations[name] and native.slot_pose(stations[name].index, 1)
  end

  local function gripper_frame(grippers, name)
    for index, gripper in ipairs(grippers) do
      if gripper.name == name then
        return native.real_gripper_pose(index)
      end
    end
  end

  local function wafer_frame(name)
    local wafer = native.wafer(name)
    return wafer and native.wafer_pose(wafer)
  end

  local function refuse_frame(what, stations, name)
    local station, slot = split_slot(stations, tostring(name))
    if station then
      lookup.slot(station, slot)
    end
    local expected = 'expected "base" or the name of a wafer, a gripper, a station or a slot, such as "A/1"'
    native.fail("BAD_ARGUMENT", ("%s: %s (%s)"):format(what, lookup.quote(name), expected))
  end

  -- The pose of a frame by its name. Of equal names a slot's comes first, as in a report's measuring tool.
  function lookup.frame(what, name)
    local layout = native.layout
    local text = type(name) == "string" and name or ""
    return slot_frame(layout.stations, text) or station_frame(layout.stations, text)
      or gripper_frame(layout.grippers, text) or wafer_frame(text) or text == "base" and { r = { 0, 0, 0 } }
      or refuse_frame(what, layout.stations, name)
  end

  -- Every frame's name.
  function lookup.frames()
    local list = native.wafer_names()
    for _, gripper in ipairs(native.layout.grippers) do
      list[#list + 1] = gripper.name
    end
    for name, station in pairs(native.layout.stations) do
      list[#list + 1] = name
      for slot = 1, station.slots do
        list[#list + 1] = ("%s/%d"):format(name, slot)
      end
    end
    list[#list + 1] = "base"
    return list
  end

  function lookup.number(what, value)
    if type(value) ~= "number" or value ~= value or value - value ~= 0 then
      native.fail("BAD_ARGUMENT", ("%s: %s (expected a finite number)"):format(what, lookup.quote(value)))
    end
    return value
  end

  function lookup.table(what, value)
    if type(value) ~= "table" then
      native.fail("BAD_ARGUMENT", ("%s: %s (expected a table)"):format(what, lookup.quote(value)))
    end
    return value
  end

  ---------------------------------------------------------------------------------------- a command's text

  function lookup.number_text(value)
    return math.type(value) == "float" and value == value and ("%.10g"):format(value) or tostring(value)
  end

  -- The command as the record has it: its word and its arguments.
  function lookup.command(word, ...)
    local text = { word }
    for _, value in ipairs({ ... }) do
      text[#text + 1] = value ~= "" and lookup.number_text(value) or nil
    end
    return table.concat(text, " ")
  end

  return lookup
end
