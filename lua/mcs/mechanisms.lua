-- Other mechanisms of a prealigner: the stage below its chuck, and pins that lift a wafer off it. LIFT, and
-- their use by ALIGN.

-- Local copies: a script may set globals of these names.
local math, pairs = math, pairs

return function(native, patterns, lookup, arm, player, grips, truth)
  local mechanisms = {}

  local function gripper_of(index)
    return native.layout.grippers[index]
  end

  -- The chuck of a station if it is on a stage, else nil.
  function mechanisms.stage(station)
    local chuck = station.chuck and gripper_of(station.chuck)
    return chuck and chuck.kind == "stage" and chuck or nil
  end

  -- The commanded place of the stage below the station's chuck, mm in the station's frame; 0, 0 without one.
  function mechanisms.aside(station)
    local chuck = mechanisms.stage(station)
    if not chuck then
      return 0, 0
    end
    local axes = native.axes()
    return axes[chuck.axis + 1], axes[chuck.axis + 2]
  end

  local function to(station, x, y)
    local axis = mechanisms.stage(station).axis
    return { [axis + 1] = x, [axis + 2] = y }
  end

  -- The axes that bring the stage home, for patterns; nil if it is there, or if there is none.
  function mechanisms.way_home(station)
    local x, y = mechanisms.aside(station)
    return (x ~= 0 or y ~= 0) and to(station, 0, 0) or nil
  end

  -- Moves the stage there with the wafer on the chuck; `lost_as`: the error if that is lost.
  function mechanisms.shift(station, x, y, lost_as)
    local segment = { moves = to(station, x, y) }
    player.play(patterns.single, { segment = segment, watched = true, lost_as = lost_as })
  end

  function mechanisms.send_home(station, lost_as)
    if mechanisms.way_home(station) then
      mechanisms.shift(station, 0, 0, lost_as)
    end
  end

  ------------------------------------------------------------------------------------------------------- pins

  local function are_up(station)
    local pins = gripper_of(station.pins)
    return native.axes()[pins.axis] > pins.low
  end

  -- Call it before a command that goes to the station, or turns its chuck.
  function mechanisms.check_pins(station)
    if station.pins and are_up(station) then
      native.fail("PINS_UP", ('%s of %s are not down: lift("%s", "down") comes first'):format(
        gripper_of(station.pins).name, station.name, station.name))
    end
  end

  -- The largest distance of a flipper from an end of its travel, rad.
  local AT_END = 1e-9

  -- Call it before a command that goes to the station: the flipper must be at an end of its travel,
  -- also by its switch.
  function mechanisms.check_flipper(station)
    if not station.flipper then
      return
    end
    local clamp = native.layout.grippers[station.chuck]
    local at = native.axes()[clamp.axis]
    if math.abs(at) > AT_END and math.abs(at - clamp.high) > AT_END then
      local text = '%s is turned over by %.6g degrees: flip("%s") comes first'
      native.fail("NOT_LEVEL", text:format(station.name, math.deg(at), station.name))
    elseif not native.arrived(station.chuck) then
      native.fail("FLIP_TIMEOUT", ("%s is not where it should be"):format(station.name))
    end
  end

  local function stations_with_pins()
    local names = {}
    for name, station in pairs(native.layout.stations) do
      names[#names + 1] = station.pins and name
    end
    return #names > 0 and lookup.listed(names) or "this cell has none"
  end

  local function check_has_pins(station)
    if not station.pins then
      local text = "station: %s (expected a prealigner with pins: %s)"
      native.fail("BAD_ARGUMENT", text:format(lookup.quote(station.name), stations_with_pins()))
    end
  end

  local function target_of(station)
    local pins, asks = gripper_of(station.pins), station.vacuum_check ~= "none"
    local pins_hold = native.is_open(station.pins)
    if pins.grip == "passive" then
      pins_hold = native.sensor(station.pins)
    end
    return {
      pins = station.pins, chuck = station.chuck, axis = pins.axis, low = pins.low, high = pins.high,
      handover = station.handover, vacuum_delay = station.vacuum_delay, timeout = station.timeout, asks = asks,
      chuck_holds = native.is_open(station.chuck), pins_hold = pins_hold, grip = grips[pins.grip],
      vent = native.layout.vent,
      watched = asks, lost_as = "WAFER_LOST", station = station,
    }
  end

  -- By result: the gripper that did not take the wafer over, and the one that gave it.
  local REFUSED = { missed = { "pins", "chuck" }, late = { "pins", "chuck" }, lost = { "chuck", "pins" },
                    loose = { "chuck", "pins" } }

  local function conclude(target, became)
    local names = REFUSED[became]
    if names then
      local taker, giver = gripper_of(target[names[1]]).name, gripper_of(target[names[2]]).name
      local is_there = became == "late" or became == "loose"
      local text = is_there and "a wafer is on %s, but its sensor did not come on within %.10g s"
        or "%s did not take the wafer over from %s"
      native.fail(is_there and "VACUUM_TIMEOUT" or "WAFER_LOST",
        text:format(taker, is_there and target.timeout or giver))
    end
  end

  local function check_arm(station)
    local state = arm.find_inside(station.name)
    if state then
      local text = "the arm stands in %s slot %d since %s: RECOVER or HOME comes first"
      native.fail("STOPPED", text:format(station.name, state.inside.slot, state.since))
    end
  end
  mechanisms.check_arm = check_arm

  local function lift(name, where)
    local station = lookup.station(name)
    local up = lookup.value("where", where, lookup.up_or_down) == "up"
    check_has_pins(station)
    check_arm(station)
    if up ~= are_up(station) then
      local target = target_of(station)
      local wafer, taker = native.held(up and target.chuck or target.pins), up and target.pins or target.chuck
      conclude(target, player.play(up and patterns.raise or patterns.lower, target))
      truth.expect_passed(lookup.command("LIFT", name, where), wafer, taker)
    end
  end

  -- lift("P", "up"): the pins take the wafer from the chuck and lift it; "down": they set it down there
  -- again.
  function mechanisms.lift(station, where)
    arm.move(arm.needs(false, station), lookup.command("LIFT", station, where), lift, station, where)
  end

  -- Centres a wafer on the chuck's axis; x, y is its middle's offset, mm in the station's frame. Pins lift the wafer,
  -- the stage brings the chuck below its middle, and then goes back with it.
  function mechanisms.grip_again(station, x, y)
    local target = target_of(station)
    target.aside, target.home = to(station, x, y), to(station, 0, 0)
    local wafer = native.held(target.chuck)
    conclude(target, player.play(patterns.grip_again, target))
    truth.expect_passed(("ALIGN %s by pins"):format(station.name), wafer, target.chuck)
  end

  ------------------------------------------------------------------------------------------------- what is asked

  -- Refuses a mode of ALIGN whose mechanisms the station does not have.
  function mechanisms.check_mode(station, mode)
    local chuck, text = gripper_of(station.chuck).name
    if mode == "stage" and not mechanisms.stage(station) then
      text = 'mode: "stage" (expected "robot": %s of %s is on no stage, its gripper says none)'
    elseif mode == "pins" and not (station.pins and mechanisms.stage(station)) then
      text = 'mode: "pins" (expected "robot"%s: pins hold the wafer while a stage brings %s of %s below its middle)'
      text = text:format(mechanisms.stage(station) and ' or "stage"' or "", "%s", "%s")
    end
    if text then
      native.fail("BAD_ARGUMENT", text:format(chuck, station.name))
    end
  end

  -- Without a minus before zeros.
  local function to_micrometre(length)
    return (("%.3f"):format(length):gsub("^%-(0%.000)$", "%1"))
  end

  -- Refuses a way that the stage cannot go.
  function mechanisms.check_way(station, x, y)
    local chuck = mechanisms.stage(station)
    if math.abs(x) > chuck.high or math.abs(y) > chuck.high then
      local text = "the stage of %s would go by %s and %s mm (expected up to %.10g mm each: its stage.travel)"
      native.fail("CORRECTION_TOO_LARGE", text:format(chuck.name, to_micrometre(x), to_micrometre(y), chuck.high))
    end
  end

  return mechanisms
end
