-- Commands as patterns: the order in which the arm moves and the valves switch.
--
-- A pattern is a coroutine body that only yields requests, so that it can be planned before it is played.
-- A request is a segment, a table with one of
--   to     = { x, y, z, heading, gripper }        point to point, until that gripper is there
--   axes   = { theta, R, Z, yaw, chucks... }      point to point, rad and mm
--   line   = { dx, dy, dz }                       straight, at constant heading, mm in base; speed = mm/s and
--                                                 acceleration = mm/s^2 limit it
--   valves = { [gripper] = 0 open or 1 closed }   lasts one slice
--   dwell  = seconds, vacuum = true               `vacuum`: the time counts as waiting for vacuum
--   sensor = gripper, timeout = seconds           answered with true or false
-- In a segment `lets_go = gripper` leaves that gripper's wafer behind, `enters = target` begins the way into a
-- station, and `leaves = true` ends the way out. `target` and `where`, such as "on the way into", tell the arm's
-- place in an error. Or a request is a question, answered with true or false; a plan only knows its `assume`:
--   is_on     = gripper                           its vacuum sensor
--   is_loaded = gripper                           a wafer lies on its pads
--   grip      = gripper                           answered with its plunger's state, a word: "open", "closing",
--                                                 "closed", "jammed", "missed", "opening", or "still" if it
--                                                 must close and has not moved; with `note` its target keeps more
--   centre    = target                            answered with { x, y }, mm in base: the offset of the wafer's
--                                                 centre on its blade from the right place, or with false
--                                                 if the beams on the way in give no result
-- Or it tells about passive pads, which have no valve:
--   carries = gripper, wafer = true or false      motion depends on it from here on
-- Or, if the target's `stop` asks for it:
--   hold = "extended" or "up"                     the command ends here, and CONTINUE goes on after it
-- A pattern returns the result for the wafer, a word, from the sensors.
--
-- The command fills in `target` (lua/mcs/targets.lua): place (of the slot), gripper, chuck (nil at
-- plain slots), asks (whether the vacuum sensor decides) and the station's parameters. Heights are above the
-- slot's plane.

local yield = coroutine.yield

local OPEN, CLOSED = 0, 1

-- Moves to the outer end of the line into the slot.
local function approach(target, height)
  local p = target.place
  local x, y, z = p.x - target.retract * p.dir_x, p.y - target.retract * p.dir_y, p.z + height
  if p.up then
    x, y = x + height * p.up[1], y + height * p.up[2]
    z = p.z - target.retract * p.dir_z + height * p.up[3]
  end
  local there = { x = x, y = y, z = z, heading = p.heading, gripper = target.gripper, place = p }
  if target.retracts then
    yield { before = there, target = target, where = "in front of" }
  end
  yield { to = there, target = target, where = "in front of" }
end

-- Vectors along the way in, and up through the slots. `up` and `dir_z` are for a robot that tilts.
local function along(place, way)
  return { way * place.dir_x, way * place.dir_y, place.up and way * place.dir_z or 0 }
end

local function upward(place, by)
  local up = place.up
  return up and { by * up[1], by * up[2], by * up[3] } or { 0, 0, by }
end

-- A point's height above the slot's plane, and its distance along the way in.
local function beside(place, at)
  local x, y, z, up = at[1] - place.x, at[2] - place.y, at[3] - place.z, place.up
  local inward = x * place.dir_x + y * place.dir_y
  if up then
    return x * up[1] + y * up[2] + z * up[3], inward + z * place.dir_z
  end
  return z, inward
end

-- Moves in, and waits there if the station has a wait.
local function enter(target)
  local line = along(target.place, target.retract)
  yield { line = line, enters = target, target = target, where = "on the way into" }
  if target.wait > 0 then
    yield { dwell = target.wait }
  end
end

local function leave(target)
  local line = along(target.place, -target.retract)
  yield { line = line, leaves = true, target = target, where = "on the way out of" }
end

local function stroke(target, by, lets_go)
  yield {
    line = upward(target.place, by), speed = target.pickup_speed, acceleration = target.pickup_acceleration,
    target = target, where = "in", lets_go = lets_go,
  }
end

-- Moves axes other than the robot's: `to` has the goal of each.
local function shift(to)
  yield { moves = to }
end

local function switch(gripper, valve)
  yield { valves = { [gripper] = valve } }
end

local function hand_over(target, from, to)
  if target.handover == "new_first" then
    switch(to, OPEN)
    switch(from, CLOSED)
  else
    yield { valves = { [from] = CLOSED, [to] = OPEN } }
  end
end

-- A phase ends: the blade stands in the station, before or after the stroke.
local function pause(target, phase)
  if target.stop == phase then
    yield { hold = phase }
  end
end

local function is_on(gripper, assume)
  return yield { is_on = gripper, assume = assume }
end

local function is_loaded(gripper, assume)
  return yield { is_loaded = gripper, assume = assume or false }
end

local function holds(target, gripper)
  if target.vacuum_delay > 0 then
    yield { dwell = target.vacuum_delay, vacuum = true }
  end
  return not target.asks or yield { sensor = gripper, timeout = target.timeout }
end

---------------------------------------------------------------------------------------------------- edge grips

-- For a target whose gripper has an edge grip: `edge` = { travel, the longest time of a sound plunger, slice }.

-- The waiting time for a sound plunger, s: its own time plus two slices, since one slice gives the order.
local function patience(target)
  return target.edge.travel + 2 * target.edge.slice
end

-- Waits until the plunger has the state `wanted`; at least as long as a sound plunger needs.
local function settle(target, wanted)
  local is_patient = target.timeout > patience(target)
  yield { dwell = patience(target), vacuum = true }
  local does = yield { grip = target.gripper, assume = wanted, note = not is_patient and target or nil }
  if does ~= wanted and is_patient then
    yield { dwell = target.timeout - patience(target), vacuum = true }
    does = yield { grip = target.gripper, assume = wanted, note = target }
  end
  return does
end

-- Sends the plunger back. Returns nil, or why it is not open: "unopened" on its way, "unmoved".
local function open_plunger(target)
  switch(target.gripper, CLOSED)
  local does = settle(target, "open")
  return does ~= "open" and (does == "opening" and "unopened" or "unmoved") or nil
end

-- Before a GET: like open_plunger, if the plunger is not open.
local function check_open(target)
  if (yield { grip = target.gripper, assume = "open" }) ~= "open" then
    return open_plunger(target)
  end
end

-- By the plunger's state: the result when it does not hold the wafer.
local WHY = { jammed = "jammed", missed = "missing", still = "unmoved", open = "unmoved", opening = "unmoved",
              closing = "unclosed", closed = "disagree" }

-- Closes the plunger. Returns "taken", or why it does not hold the wafer.
local function close_plunger(target)
  local gripper = target.gripper
  switch(gripper, OPEN)
  local on = yield { sensor = gripper, timeout = patience(target) }
  if not on and target.timeout > patience(target) and (yield { grip = gripper, assume = "closed" }) == "closing" then
    on = yield { sensor = gripper, timeout = target.timeout - patience(target) }
  end
  -- A sensor that is on before the plunger has arrived does not show a wafer.
  if on and (yield { grip = gripper, assume = "closed" }) == "closed" and is_loaded(gripper, true) then
    return "taken"
  end
  local does = yield { grip = gripper, assume = "closed", note = target }
  return on and does ~= "jammed" and "disagree" or WHY[does]
end

-- The chuck lets go before the plunger closes.
local function close_over_chuck(target)
  if target.chuck then
    switch(target.chuck, CLOSED)
    if target.edge.vent > 0 then
      yield { dwell = target.edge.vent, vacuum = true }
    end
  end
  return close_plunger(target)
end

-- On the way in the blade has passed beams that give the wafer's place on it: the blade goes aside by the
-- offset. False if they give no result.
local STRAIGHT = { 0, 0 }

local function centre(target)
  if not target.centre then
    return true
  end
  local off = yield { centre = target, assume = STRAIGHT }
  if off and (off[1] ~= 0 or off[2] ~= 0) then
    yield { line = { -off[1], -off[2], 0 }, target = target, where = "in" }
  end
  return off and true
end

-- Moves down to where a PUT lets go, closes the valve, moves down below the wafer: a wafer on the blade
-- stays in the slot.
local function set_back(target, height)
  if height > target.release and not target.is_passive then
    stroke(target, target.release - height)
    height = target.release
  end
  if target.edge then
    open_plunger(target)
  elseif not target.is_passive then
    switch(target.gripper, CLOSED)
  end
  stroke(target, target.offset - target.stroke - height)
end

---------------------------------------------------------------------------------------------------- passive pads

-- They have no valve: a wafer is on them after they have lifted it off its support, and off them when a support
-- has it.

local function reckon(gripper, wafer)
  yield { carries = gripper, wafer = wafer }
end

-- The chuck lets go of its wafer; true if it held one.
local function free_chuck(target)
  local held = is_on(target.chuck, true)
  switch(target.chuck, CLOSED)
  if target.vent > 0 then
    yield { dwell = target.vent, vacuum = true }
  end
  return held
end

-- The chuck takes hold of the wafer set down on it.
local function give_to_chuck(target)
  switch(target.chuck, OPEN)
  return holds(target, target.chuck) and "kept" or is_loaded(target.chuck) and "loose" or "lost"
end

local function lift_off(target)
  local chuck_held = target.chuck and free_chuck(target)
  reckon(target.gripper, true)
  stroke(target, target.stroke)
  if holds(target, target.gripper) then
    return "taken"
  end
  local found = is_loaded(target.gripper) and "late" or "missing"
  stroke(target, -target.stroke)
  reckon(target.gripper, false)
  if chuck_held then
    switch(target.chuck, OPEN)
  end
  return found
end

-- Sets the wafer down. If no support takes it over, it comes out again as it went in.
local function set_down(target)
  stroke(target, -target.stroke, target.gripper)
  if target.asks and is_on(target.gripper, false) then
    stroke(target, target.stroke)
    return "stuck"
  end
  reckon(target.gripper, false)
  return target.chuck and give_to_chuck(target) or "kept"
end

-- Moves up with the wafer on the chuck, or down to the chuck.
local function raise_pads(target)
  shift { [target.axis] = 0 }
  if target.chuck_holds then
    free_chuck(target)
  end
  reckon(target.pins, true)
  shift { [target.axis] = target.high }
  if holds(target, target.pins) then
    return "taken"
  end
  local found = is_loaded(target.pins) and "late" or "missed"
  reckon(target.pins, false)
  if not target.chuck_holds then
    return "empty"
  end
  shift { [target.axis] = target.low }
  switch(target.chuck, OPEN)
  return found
end

local function lower_pads(target)
  yield { moves = { [target.axis] = target.low }, lets_go = target.pins }
  reckon(target.pins, false)
  return target.pins_hold and give_to_chuck(target) or "empty"
end

local patterns = {}

-------------------------------------------------------------------------------------------------- turned over

-- A blade that is turned over comes from above. It moves in and out with its pads `offset` above `target.touch`,
-- the height over the slot's plane at which they take a wafer and let go of one.
local function above(target)
  return target.touch + target.offset
end

local function take_from_above(target)
  stroke(target, -target.offset)
  if target.edge then
    local found = close_over_chuck(target)
    if found ~= "taken" then
      open_plunger(target)
    end
    return found
  end
  if target.chuck then
    hand_over(target, target.chuck, target.gripper)
  else
    switch(target.gripper, OPEN)
  end
  if holds(target, target.gripper) then
    return "taken"
  end
  local found = is_loaded(target.gripper) and "late" or "missing"
  switch(target.gripper, CLOSED)
  return found
end

local function get_from_above(target)
  local found = target.edge and check_open(target)
  if found then
    return found
  end
  approach(target, above(target))
  enter(target)
  pause(target, "extended")
  for _ = 0, target.retries do
    found = take_from_above(target)
    stroke(target, target.offset)
    if found ~= "missing" and found ~= "late" then
      break
    end
  end
  if found == "taken" then
    pause(target, "up")
  end
  leave(target)
  return found
end

local function let_go(target)
  if target.edge then
    if target.chuck then
      switch(target.chuck, OPEN)
    end
    local shut = open_plunger(target)
    if shut and is_loaded(target.gripper) then -- it has not let go, and must not do so on the way
      switch(target.gripper, OPEN)
    end
    if shut or not target.chuck then
      return shut or "kept"
    end
    return holds(target, target.chuck) and "kept" or is_loaded(target.chuck) and "loose" or "lost"
  end
  if not target.chuck then
    switch(target.gripper, CLOSED)
    return "kept"
  end
  hand_over(target, target.gripper, target.chuck)
  return holds(target, target.chuck) and "kept" or is_loaded(target.chuck) and "loose" or "lost"
end

-- The pads let go of a hanging wafer before they go up again.
local function let_go_below(target)
  local became = let_go(target)
  if became == "kept" and not target.edge and target.vent > 0 then
    yield { dwell = target.vent, vacuum = true }
  end
  return became
end

-- Moves out after a PUT with the result `became`.
local function leave_empty(target, became)
  if became == "kept" then
    pause(target, "up")
  end
  leave(target)
  if became == "kept" and not target.chuck and target.asks and is_on(target.gripper, false) then
    return "stuck"
  end
  return became
end

local function put_from_above(target)
  approach(target, above(target))
  enter(target)
  if not centre(target) then
    leave(target)
    return "uncentred"
  end
  pause(target, "extended")
  stroke(target, -target.offset)
  local became = let_go_below(target)
  stroke(target, target.offset)
  return leave_empty(target, became)
end

---------------------------------------------------------------------------------------------------------- GET

-- Moves up to the wafer's plane, where rests and plunger are beside its rim; a wafer that is not gripped stays
-- there.
local function take_by_edge(target)
  local bottom = target.offset - target.stroke
  stroke(target, -bottom)
  local found = close_over_chuck(target)
  if found == "taken" then
    stroke(target, target.offset)
  else
    open_plunger(target)
    stroke(target, bottom)
  end
  return found
end

local function take_from_slot(target)
  switch(target.gripper, OPEN)
  if target.asks and is_on(target.gripper, false) then
    switch(target.gripper, CLOSED)
    return "early"
  end
  stroke(target, target.stroke)
  if holds(target, target.gripper) then
    return "taken"
  end
  local found = is_loaded(target.gripper) and "late" or "missing"
  set_back(target, target.offset)
  return found
end

local function take_from_chuck(target)
  local bottom = target.offset - target.stroke
  local chuck_held = is_on(target.chuck, true)
  stroke(target, -bottom)
  hand_over(target, target.chuck, target.gripper)
  if holds(target, target.gripper) then
    stroke(target, target.offset)
    return "taken"
  end
  local found = is_loaded(target.gripper) and "late" or "missing"
  yield { valves = { [target.gripper] = CLOSED, [target.chuck] = chuck_held and OPEN or CLOSED } }
  stroke(target, bottom)
  return found
end

-- GET moves in below the wafer, opens the valve, moves up through the slot, and out. From a chuck it moves up to the
-- chuck's plane, hands over, and moves out above. Without a wafer it moves down again, repeats the stroke `retries` times,
-- and moves out below: "missing", or "late" if the vacuum did not come though a wafer is there; "early" if the sensor was
-- on before the stroke. Without a wafer the phase "up" is not held. With an edge grip it moves in with its plunger open,
-- up to the wafer's plane, closes, moves up to `offset`, and out; else "missing", "jammed", "unmoved", "unclosed",
-- "unopened" or "disagree". Passive pads move like pads with vacuum, without valves.
function patterns.get(target)
  if target.touch then
    return get_from_above(target)
  end
  local take = target.is_passive and lift_off or target.edge and take_by_edge
    or target.chuck and take_from_chuck or take_from_slot
  local found = target.edge and check_open(target)
  if found then
    return found
  end
  approach(target, target.offset - target.stroke)
  enter(target)
  pause(target, "extended")
  for _ = 0, target.retries do
    found = take(target)
    if found ~= "missing" and found ~= "late" then
      break
    end
  end
  if found == "taken" then
    pause(target, "up")
  end
  leave(target)
  return found
end

---------------------------------------------------------------------------------------------------------- PUT

-- PUT moves in above the slot, down to `release`, switches the valve, moves down below the wafer, and out. Results: "kept";
-- "lost" if the chuck has not taken it over; "loose" if the chuck's vacuum did not come though the wafer lies on it; "stuck" if
-- the gripper's sensor is still on after it has left a plain slot. With an edge grip "unmoved" or "unopened" if its plunger did
-- not go back before the blade went on down; with a wafer in it the blade moves up and out again. With `centre` the blade first
-- goes aside by the beams' result. Without a result it moves out again with the wafer: "uncentred".
function patterns.put(target)
  if target.touch then
    return put_from_above(target)
  end
  if target.is_passive then
    reckon(target.gripper, true)
  end
  if target.stage_home then
    yield { moves = target.stage_home }
  end
  approach(target, target.offset)
  enter(target)
  if not centre(target) then
    leave(target)
    return "uncentred"
  end
  pause(target, "extended")
  if target.is_passive then
    return leave_empty(target, set_down(target))
  end
  stroke(target, target.release - target.offset)
  local became = let_go(target)
  if target.edge and is_loaded(target.gripper) then
    stroke(target, target.offset - target.release)
  else
    stroke(target, target.offset - target.stroke - target.release)
  end
  return leave_empty(target, became)
end

------------------------------------------------------------------------------------------- SWAP, READY and MAP

-- SWAP is a GET with one gripper and, if that took the wafer, a PUT with the other.
function patterns.swap(target)
  local found = patterns.get(target.get)
  return found == "taken" and patterns.put(target.put) or found
end

-- Moves to where a GET enters, or a PUT if the gripper is loaded.
function patterns.ready(target)
  if target.touch then
    return approach(target, above(target))
  end
  approach(target, target.loaded and target.offset or target.offset - target.stroke)
end

------------------------------------------------------------------------------------------------ stages and pins

-- `pins` come up to the wafer, whose back is in the chuck's plane, take it, and lift it: "taken"; "empty" if there
-- is none. From a chuck that held one: "missed", or "late" if the vacuum did not come though it lies there. The
-- chuck then holds it again, and the pins are down.
function patterns.raise(target)
  if target.is_passive then
    return raise_pads(target)
  end
  shift { [target.axis] = 0 }
  if target.chuck_holds then
    hand_over(target, target.chuck, target.pins)
  else
    switch(target.pins, OPEN)
  end
  if holds(target, target.pins) then
    shift { [target.axis] = target.high }
    return "taken"
  end
  local found = is_loaded(target.pins) and "late" or "missed"
  if target.chuck_holds then
    yield { valves = { [target.chuck] = OPEN, [target.pins] = CLOSED } }
    shift { [target.axis] = target.low }
    return found
  end
  switch(target.pins, CLOSED)
  shift { [target.axis] = target.high }
  return "empty"
end

-- The pins bring their wafer down: "kept"; "empty" if their valve is closed; "lost" if the chuck has not
-- taken it over; "loose" if the chuck's vacuum did not come though it lies there.
function patterns.lower(target)
  if target.is_passive then
    return lower_pads(target)
  end
  local became = "empty"
  if target.pins_hold then
    shift { [target.axis] = 0 }
    hand_over(target, target.pins, target.chuck)
    became = holds(target, target.chuck) and "kept" or is_loaded(target.chuck) and "loose" or "lost"
  end
  shift { [target.axis] = target.low }
  return became
end

-- Pins hold the wafer while the stage brings the chuck to `aside`. With the wafer on the chuck it goes `home`.
function patterns.grip_again(target)
  local found = patterns.raise(target)
  if found ~= "taken" then
    return found
  end
  shift(target.aside)
  target.pins_hold = true
  local became = patterns.lower(target)
  shift(target.home)
  return became
end

------------------------------------------------------------------------------------------------------- others

-- Moves from below the stack to above it, in front of the station.
function patterns.map(target)
  approach(target, -target.margin)
  local line = upward(target.place, target.height + 2 * target.margin)
  yield { line = line, speed = target.map_speed, target = target, where = "in front of" }
end

-- Moves out of the station from the place where the arm stopped: with a wafer up to where a GET leaves,
-- else down to where a PUT leaves, then straight out. `stands` is the gripper's place.
function patterns.recover(target)
  local p = target.place
  local height, inward = beside(p, target.stands)
  if target.touch then
    stroke(target, above(target) - height)
  elseif target.loaded then
    stroke(target, target.offset - height)
  else
    set_back(target, height)
  end
  local inside = inward + target.retract
  local line = along(p, inside > 0 and -inside or 0)
  yield { line = line, leaves = true, target = target, where = "on the way out of" }
end

-- Plays a single segment.
function patterns.single(target)
  yield(target.segment)
end

-- Waits for a switch: true if it came in time.
function patterns.arrive(target)
  return yield(target.segment)
end

return patterns
