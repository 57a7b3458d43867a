-- Flippers: stations whose clamp turns a wafer over. FLIP there, and the checks of commands that go there.

-- Local copies: a script may set globals of these names.
local pairs = pairs

return function(native, patterns, lookup, arm, player, mechanisms, alarms)
  local flippers = {}

  -- The name of the flipper with this name, or whose clamp has it; or nil.
  function flippers.find(name)
    for station_name, station in pairs(native.layout.stations) do
      if station.flipper and (name == station_name or name == native.layout.grippers[station.chuck].name) then
        return station_name
      end
    end
  end

  -- Waits until the gripper's carrier has arrived.
  function flippers.await(gripper, name, timeout)
    if not player.play(patterns.arrive, { segment = { arrives = { gripper = gripper }, timeout = timeout } }) then
      native.fail("FLIP_TIMEOUT", ("%s has not turned over within %.10g s"):format(name, timeout))
    end
  end

  local function check_clamped(station, clamp)
    if not native.is_open(station.chuck) then
      local text = 'the valve of %s is closed: valve("%s", 0) clamps what lies there'
      native.fail("FLIP_NOT_CLAMPED", text:format(clamp.name, clamp.name))
    elseif station.vacuum_check ~= "none" and not native.sensor(station.chuck) then
      native.fail("FLIP_NOT_CLAMPED", ("the sensor of %s is off"):format(clamp.name))
    end
  end

  local function flip(name)
    local station = native.layout.stations[name]
    local clamp = native.layout.grippers[station.chuck]
    mechanisms.check_arm(station)
    check_clamped(station, clamp)
    alarms.break_flip(clamp.name)
    local to = native.axes()[clamp.axis] > clamp.high / 2 and 0 or clamp.high
    local segment = { moves = { [clamp.axis] = to } }
    player.play(patterns.single, { segment = segment, watched = station.vacuum_check ~= "none", lost_as = "WAFER_LOST" })
    flippers.await(station.chuck, name, station.timeout)
  end

  -- flip("F"): the wafer in its clamp is turned over; again: back.
  function flippers.flip(name)
    arm.move(arm.needs(false, name), lookup.command("FLIP", name), flip, name)
  end

  return flippers
end
