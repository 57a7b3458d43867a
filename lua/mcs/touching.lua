-- Teaching by touch: the ball of a gripper's probe touches faces of the station's block. Eight places on the face
-- towards the robot give x and yaw; three on the right face give y; three on the upper face give z. The arm goes
-- in a straight line, in small steps, until the switch has closed.

-- Local copies: a script may set globals of these names.
local error, ipairs, math, pcall = error, ipairs, math, pcall

return function(native, patterns, lookup, arm, player, targets)
  -- The ball's start before a face, its longest way, its step, and its speed, mm and mm/s.
  local BEFORE, REACH, STEP, SPEED = 2, 4, 0.1, 5
  -- The ball touches an upright face this far below the upper edge, and crosses this far above the block,
  -- plus its radius, mm.
  local BELOW, ABOVE = 2.5, 10
  -- The ball's distance from the edges of a face, mm.
  local EDGE = 4

  local FACES = { "towards the robot", "to the right", "upwards" }

  local function play(segment)
    player.play(patterns.single, { segment = segment, watched = false, gripper = arm.leader() })
  end

  -- A point of the station's frame in base, as motion control believes.
  local function in_base(block, point)
    local R, r = block.station.R, block.station.r
    local at = {}
    for i = 1, 3 do
      at[i] = r[i] + R[i][1] * point[1] + R[i][2] * point[2] + R[i][3] * point[3]
    end
    return at
  end

  -- The way from the ball's place to a point of the station's frame.
  local function way_to(block, point)
    local pose, to, way = native.gripper_pose(block.gripper), in_base(block, point), {}
    for i = 1, 3 do
      local R = pose.R[i]
      way[i] = to[i] - pose.r[i] - R[1] * block.ball[1] - R[2] * block.ball[2] - R[3] * block.ball[3]
    end
    return way
  end

  local function go(block, point, speed)
    play { line = way_to(block, point), speed = speed }
  end

  local function fail(block, face, text)
    native.fail("NOT_TOUCHED", ("the probe of %s at the face %s: %s"):format(native.layout.grippers[block.gripper].name,
      FACES[face], text))
  end

  -- A point of the station's frame, `far` mm outside of a face, beside the place to be touched.
  local function outside(point, axis, sign, far)
    local at = { point[1], point[2], point[3] }
    at[axis] = at[axis] + sign * far
    return at
  end

  -- Moves until the switch has closed.
  local function creep(block, place)
    for step = 1, math.ceil(REACH / STEP) do
      go(block, outside(place.point, place.face, place.sign, block.radius + BEFORE - step * STEP), SPEED)
      if native.touched().latched then
        return true
      end
    end
    return false
  end

  local function touch(station, block, place)
    local slice = native.layout.slice
    local from = outside(place.point, place.face, place.sign, block.radius + BEFORE)
    local over = { from[1], from[2], block.at[3] + block.radius + ABOVE }
    go(block, over)
    go(block, from, 10 * SPEED)
    native.arm_touch(station.index, place.face)
    play { dwell = 2 * slice }
    if native.touched().closed then
      fail(block, place.face, "its switch is closed before it touches anything")
    elseif not creep(block, place) then
      fail(block, place.face, ("nothing was felt within %.10g mm of it"):format(REACH - BEFORE))
    elseif native.touched().missed > 0 or not native.add_touch(station.index, place.face) then
      native.fail("TOO_FEW_SAMPLES", "the latch of a touch was lost on its way")
    elseif native.touched().skipped then
      native.fail("TOO_FEW_SAMPLES", "slices were lost while the probe felt for a face")
    end
    go(block, from, SPEED)
    if native.touched().closed then
      fail(block, place.face, "its switch does not open again")
    end
    native.disarm_beams()
    play { dwell = slice }
    go(block, over)
  end

  -- The places to touch: points of the station's frame on its faces.
  local function places_of(block)
    local at, size, list = block.at, block.size, {}
    local low = at[3] - math.min(size[3] / 2, block.radius + BELOW)
    local function add(face, sign, x, y, z)
      list[#list + 1] = { face = face, sign = sign, point = { x, y, z } }
    end
    for _, part in ipairs { -1, -0.94, -0.88, -0.82, 0.82, 0.88, 0.94, 1 } do
      add(1, -1, at[1] - size[1] / 2, at[2] + part * (size[2] / 2 - EDGE), low)
    end
    for _, part in ipairs { -1, 0, 1 } do
      add(2, -1, at[1] + part * (size[1] / 2 - EDGE), at[2] - size[2] / 2, low)
    end
    for _, part in ipairs { -1, 0, 1 } do
      add(3, 1, at[1], at[2] + part * (size[2] / 2 - EDGE), at[3])
    end
    return list
  end

  -- Moves straight in from where a GET begins its way in, above the block.
  local function enter(block, target)
    local place, ball = target.place, block.ball
    local c, s = math.cos(place.heading), math.sin(place.heading)
    local over = in_base(block, { 0, 0, block.at[3] + block.radius + ABOVE })
    play { to = { x = place.x - target.retract * place.dir_x, y = place.y - target.retract * place.dir_y,
                  z = over[3] - ball[3], heading = place.heading, gripper = block.gripper },
           target = target, where = "in front of" }
    local first = in_base(block, { block.at[1] - block.size[1] / 2, 0, 0 })
    local x, y = place.x - target.retract * place.dir_x, place.y - target.retract * place.dir_y
    local ahead = (first[1] - x - c * ball[1] + s * ball[2]) * place.dir_x
      + (first[2] - y - s * ball[1] - c * ball[2]) * place.dir_y
    play { line = { ahead * place.dir_x, ahead * place.dir_y, 0 }, enters = target, target = target,
           where = "on the way to the block of" }
  end

  local function leave(block, target)
    local place = target.place
    native.disarm_beams()
    local pose = native.gripper_pose(block.gripper)
    local over = in_base(block, { 0, 0, block.at[3] + block.radius + ABOVE })
    play { line = { 0, 0, math.max(over[3] - block.ball[3] - pose.r[3], 0) } }
    play { line = { place.x - target.retract * place.dir_x - pose.r[1], place.y - target.retract * place.dir_y - pose.r[2], 0 },
           leaves = true, target = target, where = "on the way out of" }
  end

  -- Returns the station's believed pose, and the result of all touches: see native.solve_teaching.
  return function(name, station, shift)
    local block = native.block(station.index)
    local told, believed = native.begin_teaching(station.index, shift, block.gripper)
    block.station = believed
    -- Slot 1 for the blade with the probe.
    local target = targets.at("get", name, 1, nil, block.gripper)
    arm.check_free()
    if native.sensor(block.gripper) then
      native.fail("WAFER_ON_GRIPPER", "TEACH by touch goes without a wafer")
    end
    enter(block, target)
    local good, why = pcall(function()
      for _, place in ipairs(places_of(block)) do
        touch(station, block, place)
      end
    end)
    leave(block, target)
    if not good then
      error(why, 0)
    end
    local solved = native.solve_teaching()
    if solved.error ~= 0 then
      native.fail("CENTRE_NOT_SURE", "the touches contradict each other")
    end
    return told, solved
  end
end
