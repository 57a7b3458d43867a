-- Commands as patterns: in which order the arm moves and the valves switch.
--
-- A pattern is a coroutine body. It yields one segment at a time, a table with one of
--   axes   = { theta, R, Z, yaw, chucks... }     point to point, rad and mm
--   line   = { dx, dy, dz }                       straight, at constant heading, mm in base; speed = mm/s and
--                                                 acceleration = mm/s^2 limit it
--   valves = { [gripper] = 0 open or 1 closed }   lasts one slice
--   dwell  = seconds, vacuum = true               `vacuum`: the time counts as waiting for vacuum
--   sensor = gripper, timeout = seconds           answered with true or false
-- of which `enters = job` begins the way into a station and `leaves = true` ends the way out. It returns what became of
-- the wafer, a word, as the sensors tell.
--
-- `job` is what the command fills in (lua/mcs/jobs.lua): place (of the slot), inverse (a function), gripper, chuck (nil at
-- plain slots), asks (whether the vacuum sensor decides) and the station's parameters. Heights are above the slot's plane.

local yield = coroutine.yield

local OPEN, CLOSED = 0, 1

-- To the outer end of the line into the slot.
local function approach(job, height)
  local p = job.place
  local x, y = p.x - job.retract * p.dir_x, p.y - job.retract * p.dir_y
  yield { axes = job.inverse(x, y, p.z + height, p.heading) }
end

-- In, and a wait there if the station has one.
local function enter(job)
  yield { line = { job.retract * job.place.dir_x, job.retract * job.place.dir_y, 0 }, enters = job }
  if job.wait > 0 then
    yield { dwell = job.wait }
  end
end

local function leave(job)
  yield { line = { -job.retract * job.place.dir_x, -job.retract * job.place.dir_y, 0 }, leaves = true }
end

local function stroke(job, by)
  yield { line = { 0, 0, by }, speed = job.pickup_speed, acceleration = job.pickup_acceleration }
end

local function switch(gripper, valve)
  yield { valves = { [gripper] = valve } }
end

local function hand_over(job, from, to)
  if job.handover == "new_first" then
    switch(to, OPEN)
    switch(from, CLOSED)
  else
    yield { valves = { [from] = CLOSED, [to] = OPEN } }
  end
end

local function holds(job, gripper)
  if job.vacuum_delay > 0 then
    yield { dwell = job.vacuum_delay, vacuum = true }
  end
  return not job.asks or yield { sensor = gripper, timeout = job.timeout }
end

-- Down to where a PUT lets go, valve closed, down below the wafer: whatever lies on the blade stays in the slot.
local function set_back(job, height)
  if height > job.release then
    stroke(job, job.release - height)
    height = job.release
  end
  switch(job.gripper, CLOSED)
  stroke(job, job.offset - job.stroke - height)
end

local patterns = {}

-------------------------------------------------------------------------------------------------------- GET

local function take_from_slot(job)
  switch(job.gripper, OPEN)
  if job.asks and job.is_on(job.gripper) then
    switch(job.gripper, CLOSED)
    return "early"
  end
  stroke(job, job.stroke)
  if holds(job, job.gripper) then
    return "taken"
  end
  local found = job.is_loaded(job.gripper) and "late" or "missing"
  set_back(job, job.offset)
  return found
end

local function take_from_chuck(job)
  local bottom = job.offset - job.stroke
  local chuck_held = job.is_on(job.chuck)
  stroke(job, -bottom)
  hand_over(job, job.chuck, job.gripper)
  if holds(job, job.gripper) then
    stroke(job, job.offset)
    return "taken"
  end
  local found = job.is_loaded(job.gripper) and "late" or "missing"
  yield { valves = { [job.gripper] = CLOSED, [job.chuck] = chuck_held and OPEN or CLOSED } }
  stroke(job, bottom)
  return found
end

-- In below the wafer, valve open, up through the slot, out. From a chuck: up to its plane, hand over, out above. Without
-- a wafer down again, `retries` times up once more, and out below: "missing", or "late" when the vacuum did not come
-- though a wafer is there; "early" when the sensor was on before the stroke.
function patterns.get(job)
  local take = job.chuck and take_from_chuck or take_from_slot
  local found
  approach(job, job.offset - job.stroke)
  enter(job)
  for _ = 0, job.retries do
    found = take(job)
    if found == "taken" or found == "early" then
      break
    end
  end
  leave(job)
  return found
end

-------------------------------------------------------------------------------------------------------- PUT

-- In above the slot, down to `release`, switch, down below the wafer, out. "kept", or "lost" when the chuck has not
-- taken it over, "loose" when its vacuum did not come though the wafer lies on it.
function patterns.put(job)
  local became = "kept"
  approach(job, job.offset)
  enter(job)
  stroke(job, job.release - job.offset)
  if job.chuck then
    hand_over(job, job.gripper, job.chuck)
    if not holds(job, job.chuck) then
      became = job.is_loaded(job.chuck) and "loose" or "lost"
    end
  else
    switch(job.gripper, CLOSED)
  end
  stroke(job, job.offset - job.stroke - job.release)
  leave(job)
  return became
end

----------------------------------------------------------------------------------------------------- others

-- A GET with one gripper, and if it took the wafer a PUT with the other.
function patterns.swap(job)
  local found = patterns.get(job.get)
  return found == "taken" and patterns.put(job.put) or found
end

-- To where a GET enters, or a PUT when the gripper is loaded.
function patterns.ready(job)
  approach(job, job.loaded and job.offset or job.offset - job.stroke)
end

-- From below the stack to above it, in front of the station.
function patterns.map(job)
  approach(job, -job.margin)
  yield { line = { 0, 0, job.height + 2 * job.margin }, speed = job.map_speed }
end

-- Out of the station that the arm stands in, from where it came to stand: with a wafer up to where a GET leaves, else down
-- to where a PUT does, then straight out. `stands` is the gripper's place.
function patterns.recover(job)
  local p, at = job.place, job.stands
  local height = at[3] - p.z
  if job.loaded then
    stroke(job, job.offset - height)
  else
    set_back(job, height)
  end
  local inside = (at[1] - p.x) * p.dir_x + (at[2] - p.y) * p.dir_y + job.retract
  local way = inside > 0 and inside or 0
  yield { line = { -way * p.dir_x, -way * p.dir_y, 0 }, leaves = true }
end

-- One segment by itself.
function patterns.single(job)
  yield(job.segment)
end

return patterns
