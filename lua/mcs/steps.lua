-- The steps that patterns are made of: moves, valves and questions.
--
-- A pattern is a coroutine body that only yields requests, so that it can be planned before it is played.
-- A request is a segment, a table with one of
--   to     = { x, y, z, heading, gripper }        point to point, until that gripper is there
--   axes   = { theta, R, Z, yaw, chucks... }      point to point, rad and mm
--   line   = { dx, dy, dz }                       straight, at constant heading, mm in base; speed = mm/s and
--                                                 acceleration = mm/s^2 limit it
--   moves  = { [axis] = place, ... }              these axes, rad and mm; others stay
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
--
-- The command fills in `target` (lua/mcs/targets.lua): place (of the slot), gripper, its grip and its plane, chuck
-- (nil at plain slots), asks (whether the vacuum sensor decides) and the station's parameters. Heights are above
-- the slot's plane.

local yield = coroutine.yield

local steps = { OPEN = 0, CLOSED = 1 }

local OPEN, CLOSED = steps.OPEN, steps.CLOSED

------------------------------------------------------------------------------------------------------- moves

-- Moves to the outer end of the line into the slot.
function steps.approach(target, height)
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
function steps.along(place, way)
  return { way * place.dir_x, way * place.dir_y, place.up and way * place.dir_z or 0 }
end

function steps.upward(place, by)
  local up = place.up
  return up and { by * up[1], by * up[2], by * up[3] } or { 0, 0, by }
end

-- A point's height above the slot's plane, and its distance along the way in.
function steps.beside(place, at)
  local x, y, z, up = at[1] - place.x, at[2] - place.y, at[3] - place.z, place.up
  local inward = x * place.dir_x + y * place.dir_y
  if up then
    return x * up[1] + y * up[2] + z * up[3], inward + z * place.dir_z
  end
  return z, inward
end

-- Moves in, and waits there if the station has a wait.
function steps.enter(target)
  local line = steps.along(target.place, target.retract)
  yield { line = line, enters = target, target = target, where = "on the way into" }
  if target.wait > 0 then
    yield { dwell = target.wait }
  end
end

-- Moves straight out; `way`: how far, the whole way without it.
function steps.leave(target, way)
  local line = steps.along(target.place, -(way or target.retract))
  yield { line = line, leaves = true, target = target, where = "on the way out of" }
end

function steps.stroke(target, by, lets_go)
  yield {
    line = steps.upward(target.place, by), speed = target.pickup_speed, acceleration = target.pickup_acceleration,
    target = target, where = "in", lets_go = lets_go,
  }
end

-- Moves axes other than the robot's: `to` has the goal of each.
function steps.shift(to, lets_go)
  yield { moves = to, lets_go = lets_go }
end

-- A phase ends: the blade stands in the station, before or after the stroke.
function steps.pause(target, phase)
  if target.stop == phase then
    yield { hold = phase }
  end
end

-- On the way in the blade has passed beams that give the wafer's place on it: the blade goes aside by the
-- offset. False if they give no result.
local STRAIGHT = { 0, 0 }

function steps.centre(target)
  if not target.centre then
    return true
  end
  local off = yield { centre = target, assume = STRAIGHT }
  if off and (off[1] ~= 0 or off[2] ~= 0) then
    yield { line = { -off[1], -off[2], 0 }, target = target, where = "in" }
  end
  return off and true
end

-------------------------------------------------------------------------------------------- valves and sensors

function steps.switch(gripper, valve)
  yield { valves = { [gripper] = valve } }
end

-- Switches two valves in one slice.
function steps.switch_both(one, level, other, other_level)
  yield { valves = { [one] = level, [other] = other_level } }
end

function steps.hand_over(target, from, to)
  if target.handover == "new_first" then
    steps.switch(to, OPEN)
    steps.switch(from, CLOSED)
  else
    steps.switch_both(from, CLOSED, to, OPEN)
  end
end

function steps.dwell(seconds)
  yield { dwell = seconds, vacuum = true }
end

function steps.is_on(gripper, assume)
  return yield { is_on = gripper, assume = assume }
end

function steps.is_loaded(gripper, assume)
  return yield { is_loaded = gripper, assume = assume or false }
end

-- True if the sensor came on in time.
function steps.await(gripper, timeout)
  return yield { sensor = gripper, timeout = timeout }
end

function steps.holds(target, gripper)
  if target.vacuum_delay > 0 then
    steps.dwell(target.vacuum_delay)
  end
  return not target.asks or steps.await(gripper, target.timeout)
end

-- The result of a chuck that was to take a wafer over.
function steps.judge_chuck(target)
  return steps.holds(target, target.chuck) and "kept" or steps.is_loaded(target.chuck) and "loose" or "lost"
end

return steps
