-- GET and PUT as patterns: in which order the arm moves and the valves switch.
--
-- A pattern is a coroutine body. It yields one segment at a time, a table with one of
--   axes   = { theta, R, Z, yaw, chucks... }     point to point, rad and mm
--   line   = { dx, dy, dz }, speed = mm/s         straight, at constant heading, mm in base
--   valves = { [gripper] = 0 open or 1 closed }   lasts one slice
--   dwell  = seconds
--   sensor = gripper, timeout = seconds           answered with true or false
-- and returns whether the wafer went where it should, as the sensors tell.
--
-- `job` is what the command fills in: place (of the slot), inverse (a function), gripper, chuck (nil at plain
-- slots) and the station's parameters. Heights are above the slot's plane.

local yield = coroutine.yield

local OPEN, CLOSED = 0, 1

-- To the outer end of the line into the slot.
local function approach(job, height)
  local p = job.place
  local x, y = p.x - job.retract * p.dir_x, p.y - job.retract * p.dir_y
  yield { axes = job.inverse(x, y, p.z + height, p.heading) }
end

local function enter(job)
  yield { line = { job.retract * job.place.dir_x, job.retract * job.place.dir_y, 0 } }
end

local function leave(job)
  yield { line = { -job.retract * job.place.dir_x, -job.retract * job.place.dir_y, 0 } }
end

local function stroke(job, by)
  yield { line = { 0, 0, by }, speed = job.pickup_speed }
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
    yield { dwell = job.vacuum_delay }
  end
  return yield { sensor = gripper, timeout = job.timeout }
end

local patterns = {}

-- In below the wafer, valve open, up through the slot, out. From a chuck: up to its plane, hand over, out above.
function patterns.get(job)
  local bottom = job.offset - job.stroke
  local taken
  approach(job, bottom)
  enter(job)
  if job.chuck then
    stroke(job, -bottom)
    hand_over(job, job.chuck, job.gripper)
    taken = holds(job, job.gripper)
    stroke(job, job.offset)
  else
    switch(job.gripper, OPEN)
    stroke(job, job.stroke)
    taken = holds(job, job.gripper)
  end
  if not taken then
    switch(job.gripper, CLOSED)
  end
  leave(job)
  return taken
end

-- In above the slot, down to `release`, switch, down below the wafer, out.
function patterns.put(job)
  local kept = true
  approach(job, job.offset)
  enter(job)
  stroke(job, job.release - job.offset)
  if job.chuck then
    hand_over(job, job.gripper, job.chuck)
    kept = holds(job, job.chuck)
  else
    switch(job.gripper, CLOSED)
  end
  stroke(job, job.offset - job.stroke - job.release)
  leave(job)
  return kept
end

return patterns
