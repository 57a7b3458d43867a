-- How a request becomes a segment: the axes' goals, the points that a robot passes on its way, and detours.

-- Local copies: a script may set globals of these names.
local ipairs, math = ipairs, math

return function(native, arm, tasks)
  local ways = {}

  -- With two arms or wrists, moves the one that does not go to the point home.
  local function fold_other(request)
    local gripper = native.layout.grippers[request.to.gripper]
    local robot = native.layout.robots[gripper.robot]
    if robot.arms then
      local other = robot.arms[3 - gripper.arm]
      request.axes[other] = robot.home[other - robot.first + 1]
    end
  end

  -- The turn nearest to `near` of an angle.
  local function nearest_turn(angle, near)
    return angle + 2 * math.pi * math.floor((near - angle) / (2 * math.pi) + 0.5)
  end

  -- A station's point in the form for native.plan, for a robot that goes there with `gripper`. Axes that the point does
  -- not give are as in `axes`. With two arms or wrists it gives the axis of this gripper.
  local function via_point(via, robot, gripper, axes)
    local point, arm_number = { blend = via.blend }, native.layout.grippers[gripper].arm
    for index in ipairs(robot.home) do
      point[index] = via[index] or axes[robot.first + index - 1]
    end
    if robot.arms and arm_number == 2 then
      local first, second = robot.arms[1] - robot.first + 1, robot.arms[2] - robot.first + 1
      point[first], point[second] = axes[robot.arms[1]], via[first] or axes[robot.arms[2]]
    end
    if robot.headings and via[1] then
      point[1] = nearest_turn(via[1] - robot.headings[arm_number], axes[robot.first])
    end
    return point
  end

  -- The list of a robot's points at a station; empty for no station, nil.
  local function vias_of(robot, station)
    return station and native.layout.stations[station].vias[robot] or {}
  end

  -- True if the robot has points at the station that it stands in front of or goes to: it then
  -- moves by them.
  local function has_points(robot, front, station)
    return (not front or front.station ~= station) and #vias_of(robot, front and front.station) + #vias_of(robot, station) > 0
  end

  -- A robot's points on the way from the station that it stands in front of (`front`) to the next one (`goal`), or
  -- nil: back along the points of the first, then along those of the second. Both are { station, gripper }, or nil for
  -- elsewhere; `there` are the axes at the end.
  local function vias_between(robot, front, goal, there)
    local here, points, own = native.axes(), { robot = robot }, native.layout.robots[robot]
    if not has_points(robot, front, goal and goal.station) then
      return nil
    end
    local back = vias_of(robot, front and front.station)
    for index = #back, 1, -1 do
      points[#points + 1] = via_point(back[index], own, front.gripper, here)
    end
    for _, via in ipairs(vias_of(robot, goal and goal.station)) do
      points[#points + 1] = via_point(via, own, goal.gripper, there)
    end
    return points
  end

  -- True if the running command's robot moves home by points.
  function ways.goes_home_by_points()
    return has_points(tasks.current().robot or 1, arm.state().front, nil)
  end

  -- The axes with both arms retracted, if the robot turns on its way to the point and has no points
  -- for that.
  local function retracted(request, front)
    local number = native.layout.grippers[request.before.gripper].robot
    local robot, axes = native.layout.robots[number], native.axes()
    if has_points(number, front, request.target.station) then
      return axes
    end
    local there = native.inverse { to = request.before, target = request.target, where = request.where }
    for _, axis in ipairs(math.abs(there[robot.first] - axes[robot.first]) > 1e-9 and robot.arms or {}) do
      axes[axis] = robot.home[axis - robot.first + 1]
    end
    return axes
  end

  -- The station in front of which the arm stands after a request; nil: elsewhere.
  function ways.in_front(request)
    local target = request.target
    return target and { station = target.station, gripper = target.gripper }
  end

  -- The parts of the limits that a robot's segment may use: those of its command, and its controller's override.
  -- The speed and the acceleration of a line are such limits, too.
  local function slow_down(request, target)
    local robot = target.robot or tasks.current().robot
    local moves = request.axes and not request.moves or request.line
    if request.is_slowed or not robot or not moves then
      return
    end
    local share, override = request.share or target.share or tasks.current().share, native.override(robot)
    local speed, acceleration = (share and share[1] or 1) * override, share and share[2] or 1
    request.is_slowed = true
    request.share = (speed ~= 1 or acceleration ~= 1) and { speed, acceleration } or nil
    request.speed = request.speed and request.speed * speed
    request.acceleration = request.acceleration and request.acceleration * acceleration
  end

  -- The segment of a request, with the axes for the gripper's goal. Detour 1 turns theta the longer way
  -- round, detour 2 the shorter way plus a whole turn. `front` is the station in front of which the arm
  -- stands.
  function ways.segment(request, target, front)
    if request.before then
      request.axes = retracted(request, front)
    elseif request.to then
      request.axes = native.inverse(request)
      fold_other(request)
      if request.detour then
        local first = arm.first_axis(request.to.gripper)
        local theta = request.axes[first]
        local is_left = theta > native.axes()[first]
        request.axes[first] = theta + ((request.detour == 2) == is_left and 2 or -2) * math.pi
      end
      request.via = request.target
        and vias_between(native.layout.grippers[request.to.gripper].robot, front, ways.in_front(request), request.axes) or nil
    elseif request.homeward then
      request.via = vias_between(tasks.current().robot or 1, front, nil, request.axes)
    elseif request.line then
      request.gripper = request.gripper or request.target and request.target.gripper or target.gripper
    elseif request.moves then
      request.axes = native.axes()
      for axis, at in pairs(request.moves) do
        request.axes[axis] = at
      end
    end
    slow_down(request, target)
    return request
  end

  return ways
end
