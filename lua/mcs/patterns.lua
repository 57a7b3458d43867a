-- Commands as patterns: in which order the arm moves and the valves switch.
--
-- A pattern is a coroutine body and does nothing but yield requests, so that it can be planned before it is
-- played. A request is a segment, a table with one of
--   to     = { x, y, z, heading, gripper }        point to point, to where that gripper is there
--   axes   = { theta, R, Z, yaw, chucks... }      point to point, rad and mm
--   line   = { dx, dy, dz }                       straight, at constant heading, mm in base; speed = mm/s and
--                                                 acceleration = mm/s^2 limit it
--   valves = { [gripper] = 0 open or 1 closed }   lasts one slice
--   dwell  = seconds, vacuum = true               `vacuum`: the time counts as waiting for vacuum
--   sensor = gripper, timeout = seconds           answered with true or false
-- of which `enters = target` begins the way into a station and `leaves = true` ends the way out, and whose
-- `target` and `where`, such as "on the way into", say in an error where the arm would be; or a question,
-- answered with true or false, of which a plan knows no more than what to `assume`:
--   is_on     = gripper                           its vacuum sensor
--   is_loaded = gripper                           a wafer lies on its pads
--   centre    = target                            answered with { x, y }, mm in base: how far the wafer's
--                                                 centre on its blade is from where it should be, or with false
--                                                 if the beams that the way in has passed do not tell
-- or, if the target's `stop` asks for it,
--   hold = "extended" or "up"                     the command ends here, and CONTINUE goes on behind it
-- It returns what became of the wafer, a word, as the sensors tell.
--
-- `target` is what the command fills in (lua/mcs/targets.lua): place (of the slot), gripper, chuck (nil at
-- plain slots), asks (if the vacuum sensor decides) and the station's parameters. Heights are above the
-- slot's plane.

local yield = coroutine.yield

local OPEN, CLOSED = 0, 1

-- To the outer end of the line into the slot.
local function approach(target, height)
  local p = target.place
  local x, y = p.x - target.retract * p.dir_x, p.y - target.retract * p.dir_y
  yield {
    to = { x = x, y = y, z = p.z + height, heading = p.heading, gripper = target.gripper },
    target = target, where = "in front of",
  }
end

-- In, and a wait there if the station has one.
local function enter(target)
  local place, way = target.place, target.retract
  local line = { way * place.dir_x, way * place.dir_y, 0 }
  yield { line = line, enters = target, target = target, where = "on the way into" }
  if target.wait > 0 then
    yield { dwell = target.wait }
  end
end

local function leave(target)
  local place, way = target.place, -target.retract
  local line = { way * place.dir_x, way * place.dir_y, 0 }
  yield { line = line, leaves = true, target = target, where = "on the way out of" }
end

local function stroke(target, by)
  yield {
    line = { 0, 0, by }, speed = target.pickup_speed, acceleration = target.pickup_acceleration,
    target = target, where = "in",
  }
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

-- A phase ends: the blade stands in the station, before the stroke or behind it.
local function pause(target, phase)
  if target.stop == phase then
    yield { hold = phase }
  end
end

local function is_on(gripper, assume)
  return yield { is_on = gripper, assume = assume }
end

local function is_loaded(gripper)
  return yield { is_loaded = gripper, assume = false }
end

local function holds(target, gripper)
  if target.vacuum_delay > 0 then
    yield { dwell = target.vacuum_delay, vacuum = true }
  end
  return not target.asks or yield { sensor = gripper, timeout = target.timeout }
end

-- On the way in the blade passed beams that tell where the wafer lies on it: the blade goes aside by that.
-- False if they do not.
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

-- Down to where a PUT lets go, valve closed, down below the wafer: whatever lies on the blade stays in the
-- slot.
local function set_back(target, height)
  if height > target.release then
    stroke(target, target.release - height)
    height = target.release
  end
  switch(target.gripper, CLOSED)
  stroke(target, target.offset - target.stroke - height)
end

local patterns = {}

---------------------------------------------------------------------------------------------------------- GET

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

-- In below the wafer, valve open, up through the slot, out. From a chuck: up to its plane, hand over, out
-- above. Without a wafer down again, `retries` times up once more, and out below: "missing", or "late" when
-- the vacuum did not come though a wafer is there; "early" when the sensor was on before the stroke. Without
-- a wafer nothing is held up there.
function patterns.get(target)
  local take = target.chuck and take_from_chuck or take_from_slot
  local found
  approach(target, target.offset - target.stroke)
  enter(target)
  pause(target, "extended")
  for _ = 0, target.retries do
    found = take(target)
    if found == "taken" or found == "early" then
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

-- In above the slot, down to `release`, switch, down below the wafer, out. "kept", or "lost" when the chuck
-- has not taken it over, "loose" when its vacuum did not come though the wafer lies on it, "stuck" when the
-- gripper's sensor is still on after it has left a plain slot. With `centre` aside before that, by what beams
-- say of the wafer; when they do not, out again with the wafer: "uncentred".
function patterns.put(target)
  local became = "kept"
  approach(target, target.offset)
  enter(target)
  if not centre(target) then
    leave(target)
    return "uncentred"
  end
  pause(target, "extended")
  stroke(target, target.release - target.offset)
  if target.chuck then
    hand_over(target, target.gripper, target.chuck)
    if not holds(target, target.chuck) then
      became = is_loaded(target.chuck) and "loose" or "lost"
    end
  else
    switch(target.gripper, CLOSED)
  end
  stroke(target, target.offset - target.stroke - target.release)
  if became == "kept" then
    pause(target, "up")
  end
  leave(target)
  if not target.chuck and target.asks and is_on(target.gripper, false) then
    return "stuck"
  end
  return became
end

------------------------------------------------------------------------------------------------------- others

-- A GET with one gripper, and if it took the wafer a PUT with the other.
function patterns.swap(target)
  local found = patterns.get(target.get)
  return found == "taken" and patterns.put(target.put) or found
end

-- To where a GET enters, or a PUT when the gripper is loaded.
function patterns.ready(target)
  approach(target, target.loaded and target.offset or target.offset - target.stroke)
end

-- From below the stack to above it, in front of the station.
function patterns.map(target)
  approach(target, -target.margin)
  local line = { 0, 0, target.height + 2 * target.margin }
  yield { line = line, speed = target.map_speed, target = target, where = "in front of" }
end

-- Out of the station that the arm stands in, from where it came to stand: with a wafer up to where a GET
-- leaves, else down to where a PUT does, then straight out. `stands` is the gripper's place.
function patterns.recover(target)
  local p, at = target.place, target.stands
  local height = at[3] - p.z
  if target.loaded then
    stroke(target, target.offset - height)
  else
    set_back(target, height)
  end
  local inside = (at[1] - p.x) * p.dir_x + (at[2] - p.y) * p.dir_y + target.retract
  local way = inside > 0 and inside or 0
  local line = { -way * p.dir_x, -way * p.dir_y, 0 }
  yield { line = line, leaves = true, target = target, where = "on the way out of" }
end

-- One segment by itself.
function patterns.single(target)
  yield(target.segment)
end

return patterns
