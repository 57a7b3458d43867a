-- Load ports in a flow with axes: carriers that come with lots, are looked at, and go. See lib/mcs/flow_calls.c.

-- Local copies: a script may set globals of these names.
local error, ipairs, math, pcall, type = error, ipairs, math, pcall, type

return function(native, tasks, commands, ports, slot_map)
  local calls = {}

  -- The longest wait for a carrier that somebody else brings, s.
  local LONGEST = 3600

  local function index_of(name)
    return native.layout.stations[name].index
  end

  -- The carrier that stands or moves there, by name, or nil.
  local function there(name)
    local _, _, _, carrier = native.port(index_of(name))
    return carrier
  end

  local function is_away(name)
    local state, step = native.port(index_of(name))
    return state == "absent" and not step and not native.rest(index_of(name))
  end

  local function is_over()
    local _, over = native.is_flow_due()
    return over
  end

  -- While the port is empty and no carrier is to come, tasks of the script may bring one. Returns when one comes, or
  -- raises NO_CARRIER. A flow that is over waits no longer.
  local function await_others(name)
    local latest = native.utime() / 1e6 + LONGEST
    tasks.wait(function()
      return is_over() or not is_away(name) or not tasks.may_others_act() or native.utime() / 1e6 > latest
    end, function()
      return ("a carrier at %s"):format(name)
    end)
    if is_away(name) and not is_over() then
      native.fail("NO_CARRIER", ('%s is absent, and no carrier is to come: `carrier` of its lot brings one, or carrier("%s")')
        :format(name, name))
    end
  end

  -- A robot waits in front of a load port that is shut: the port's own task tells if that cannot be. False: the flow is
  -- over before it is open.
  function calls.await_open(name)
    local station = native.layout.stations[name]
    if station.is_port and not native.is_port_open(station.index) then
      tasks.wait(function()
        return native.is_port_open(station.index) or is_over()
      end, function()
        return ("%s to be open"):format(name)
      end)
    end
    return not station.is_port or native.is_port_open(station.index)
  end

  local function open(name)
    if not native.is_port_open(index_of(name)) then
      commands.port(name, "mapped")
    end
  end

  -- The lot's carrier comes to the port, and is opened and mapped. Another one that stands there goes before: no wafer is
  -- to end in it.
  function calls.comes(action)
    local name, carrier = action.station, action.carrier
    while true do
      if native.rest(index_of(name)) then
        commands.wait_for(name)
      elseif is_away(name) and carrier then
        commands.carrier(name, { name = carrier })
      elseif is_away(name) then
        await_others(name)
        if is_over() then
          return
        end
      elseif carrier and there(name) ~= carrier then
        commands.take_away(name)
      else
        return open(name)
      end
    end
  end

  function calls.goes(action)
    commands.take_away(action.station)
  end

  -- The port should be open, for wafers are to leave it or to come into it. It is waited for as long as something runs
  -- there, or somebody may bring a carrier.
  function calls.shut(action)
    local name = action.station
    while native.rest(index_of(name)) do
      commands.wait_for(name)
    end
    if is_away(name) and tasks.may_others_act() then
      await_others(name)
      return is_over() or calls.shut(action)
    end
    ports.check(name)
    if action.carrier and there(name) ~= action.carrier then
      native.fail("CARRIER_THERE", ("%s is at %s (expected %s, whose lot is not over)"):format(there(name), name,
        action.carrier))
    end
  end

  -- True if what failed has been done after all.
  function calls.is_done(action)
    return action.what == "goes" and is_away(action.station)
  end

  -- Why no robot may take the wafer in this slot of a carrier, as an error; nil: one may.
  local function find_fault(name, entry)
    local good, problem = pcall(function()
      ports.check(name)
      slot_map.check_get { station = name, slot = entry.slot }
      if entry.text then
        native.fail("BAD_ARGUMENT", entry.text)
      elseif not entry.is_there then
        native.fail("WAFER_MISSING", ("%s slot %d has no wafer (expected one: a lot has it)"):format(name, entry.slot))
      end
    end)
    if not good and (type(problem) ~= "table" or math.type(problem.number) ~= "integer") then
      error(problem, 0)
    end
    return not good and problem or nil
  end

  -- The carrier is open: its wafers get their names, and each that nobody may take is a problem, of which
  -- ask(problem) hears. Returns why the flow ends, or nil.
  function calls.look(name, ask)
    for _, entry in ipairs(native.bind_call(index_of(name))) do
      local fault = find_fault(name, entry)
      if fault then
        local answer = ask { kind = "map", station = name, slot = entry.slot, action = "comes", number = fault.number,
                             name = fault.name, text = fault.text }
        if answer ~= "skip" then
          return type(answer) == "string" and answer ~= "retry" and answer
            or ("comes at %s %d: %s"):format(name, entry.slot, fault.text)
        end
        native.skip_wafer(index_of(name), entry.slot)
      end
    end
  end

  return calls
end
