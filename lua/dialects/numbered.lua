-- One line, one answer, numbered, as a widespread laboratory arm has it: `0 ...` or `-NNNN text`. Commands are read in either case.
-- A motion is answered when it begins; the next one, and `waitForEom`, when it has ended; picks, places and homing at their end. Two
-- ports share one state: `status` asks and stops, `motion` also moves. Motions need power (`hp 1`) and `attach 1`; both go when the
-- client at `motion` goes. Joints are 1 z, 2 shoulder, 3 elbow, 4 wrist, 5 gripper, 6 rail; mm and degrees. A location names the
-- nest that is nearest to it; the hand goes where the location is, so one that was taught 3 mm aside picks 3 mm aside. A robot without one of the joints 1 to 4 has no answer to `wherej`: -2800. A tester may tell "estop on",
-- "hand elbow 170" (moved by hand, or back without a value) and "overshoot elbow 134.062", beyond its travel, which homing mends.
-- Power, brakes, emergency stop and overshoot are the state of the robot's controller, `now.controller`. A set brake holds all joints until
-- it is released, or power comes. While joints are free, `freemode`, nothing moves.
-- A profile's speed counts, and the lesser of its acceleration and deceleration, for both ends of a motion are alike. Picks and
-- places go by profile 1. A straight motion at 100 % has 500 mm/s, or what the joints allow. A simulated joint ends where it was
-- sent, so each `inrange` from 0 on is met at once; -1, motions that blend, is refused. Ramps and `speed2` are kept and told, and
-- change nothing.

local AXES = { "z", "theta", "forearm", "yaw", "gripper", "rail" }
local JOINTS = { z = 1, shoulder = 2, elbow = 3, wrist = 4, gripper = 5, rail = 6 }
local MOST = 20       -- locations, and profiles
local STRAIGHT = 500  -- mm/s: 100 % of a straight motion
local NEAR = 25       -- mm: a location farther from every nest is none
local ELBOWS = { "right", "left" }
local TURNED = 0x1000 -- of a configuration: the wrist within half a turn

local attached = false
local payload, monitor, selected = 0, 100, 1
local shown = {}       -- joints that were moved by hand: what their encoders tell
local cut_short = false -- something was stopped or has failed: the arm comes out of a nest before it picks or places
local free = {}        -- joints that can be moved by hand: nothing else moves the robot meanwhile
local profiles, locations, signals, parameters, parameter_count = {}, {}, {}, {}, 0
local width, open_width, close_width = 125, 125, 85
local grasp = { 85, 50, 10 }
local base = { 0, 0, 0, 0 }
local tool = { 0, 0, 0, 0, 0, 0 }
local rail_next        -- posted for the next motion
local destination      -- of the last motion, as an answer of wherec or wherej has it: { kind, text }

for place = 1, MOST do
  profiles[place] = { 50, 0, 100, 100, 0.1, 0.1, 10, 0 }
  locations[place] = { angles = false, 0, 0, 0, 0, 0, 0, config = 0, clearance = 50, world = 0, access = 0, kind = 0, above = 0, grasp = 0, rail = 0 }
end

local function fail(code, text)
  host.refuse("BAD_ARGUMENT", text, tostring(code))
end

local function number(text, least, most)
  local value = tonumber(text)
  if not value or value - value ~= 0 then
    fail(-712, "Invalid syntax: " .. (text or "a number is missing"))
  end
  if least and value < least then
    fail(-705, "Value too small: " .. text)
  elseif most and value > most then
    fail(-706, "Value too large: " .. text)
  end
  return value
end

local function whole(text, least, most)
  local value = math.tointeger(number(text, least, most))
  return value or fail(-712, "Invalid syntax: " .. text)
end

local function numbers(words, first, count)
  local list = {}
  for place = 1, count do
    list[place] = number(words[first + place - 1])
  end
  return list
end

local function text_of(...)
  local list = {}
  for place, value in ipairs({ ... }) do
    list[place] = math.type(value) == "float" and ("%.3f"):format(value):gsub("^-0%.000$", "0.000") or tostring(value)
  end
  return table.concat(list, " ")
end

local function location(word)
  return locations[whole(word, 1, MOST)]
end

local function profile(word)
  return profiles[whole(word, 1, MOST)]
end

------------------------------------------------------------------------------------------------------------- where it is

local function has_rail(now)
  return now.position.rail ~= nil
end

-- The joints, as encoders tell them.
local function joints(now)
  local list = {}
  for place, name in ipairs(AXES) do
    list[place] = shown[place] or name == "gripper" and width + 0.0 or now.position[name]
    if not list[place] and name ~= "rail" then
      fail(-2800, ("Warning Parameter Mismatch: the robot has no joint %d (expected one with %s)"):format(place, name))
    end
  end
  return list
end

local function elbow_of(now)
  return (now.position.forearm or 1) < 0 and 2 or 1
end

-- The first blade by its name.
local function hand_name(now)
  local first
  for name in pairs(now.poses) do
    first = (not first or name < first) and name or first
  end
  return first or "hand"
end

local function hand(now)
  return now.poses[hand_name(now)] or { x = 0, y = 0, z = 0, yaw = 0 }
end

local function where_c(now)
  local pose = hand(now)
  return text_of(pose.x, pose.y, pose.z, pose.yaw, 90.0, 180.0, elbow_of(now))
end

local function where_j(now)
  return text_of(table.unpack(joints(now)))
end

-------------------------------------------------------------------------------------------------------------- may it move

local function is_on(now)
  return now.controller.power == "on"
end

local function check_power(request, now)
  if now.controller.estop == "on" then
    fail(-1028, "Hard E-Stop")
  elseif not is_on(now) then
    fail(-1046, "Power not enabled")
  elseif request.port ~= "motion" or not attached then
    fail(-1009, "No robot attached")
  end
end

local function check_free()
  if next(free) then
    fail(-1000, "Joints are free: freemode -1 ends that")
  end
end

local function check_hands()
  for place, at in pairs(shown) do
    fail(-1012, ("Joint out-of-range: joint %d at %s"):format(place, text_of(at + 0.0)))
  end
end

local function check_joints(now)
  check_hands()
  for place, name in ipairs(AXES) do
    if name == now.controller.exceeded then
      fail(-1012, ("Joint out-of-range: joint %d at %s"):format(place, text_of(now.position[name] + 0.0)))
    end
  end
end

local function check_motion(request, now)
  check_power(request, now)
  check_free()
  check_joints(now)
end

local function part(percent)
  return math.min(1, math.max(1e-3, percent / 100))
end

local function speed_of(words)
  return part(words[1] * monitor / 100)
end

local function acceleration_of(words)
  return part(math.min(words[3], words[4]))
end

-- The parts of the limits of a profile.
local function shares(words)
  return ("speed=%.6g acceleration=%.6g"):format(speed_of(words), acceleration_of(words))
end

-- "MOVE ..." to joints, by place; those that are nil stay. The gripper opens as told.
local function line_of_joints(values, words)
  local list = { "MOVE" }
  for place, name in ipairs(AXES) do
    if values[place] and name == "gripper" then
      width = values[place]
    elseif values[place] then
      list[#list + 1] = ("%s=%.9f"):format(name, values[place])
    end
  end
  list[#list + 1] = shares(words)
  return table.concat(list, " ")
end

-- Lines to a pose; straight if the profile says so. The hand is level: other pitches and rolls are no pose of it.
local function lines_of_pose(pose, config, words, now)
  if math.abs(pose[5] - 90) > 0.01 or math.abs(math.abs(pose[6]) - 180) > 0.01 then
    fail(-1012, ("Joint out-of-range: pitch %s and roll %s (expected 90 and 180)"):format(pose[5], pose[6]))
  end
  local rail = rail_next
  rail_next = nil
  local side = ELBOWS[config & 3]
  if config & 3 == 3 or config & ~(TURNED | 3) ~= 0 then
    fail(-1042, "Can't change robot config: " .. config)
  end
  local to = ("MOVE x=%.9f y=%.9f z=%.9f yaw=%.9f%s%s %s"):format(pose[1], pose[2], pose[3], pose[4],
    side and " elbow=" .. side or "", rail and (" rail=%.9f"):format(rail) or "", shares(words))
  if words[8] == 0 then
    return { to }
  elseif side and side ~= ELBOWS[elbow_of(now)] then
    fail(-1042, "Can't change robot config on a straight line")
  end
  return { ("LINE x=%.9f y=%.9f z=%.9f speed=%.6g acceleration=%.6g"):format(pose[1], pose[2], pose[3],
    STRAIGHT * speed_of(words), acceleration_of(words)), to }
end

-- Where a location is: x, y, z, yaw.
local function point_of(at)
  if not at.angles then
    return at
  end
  local axes = {}
  for place, name in ipairs(AXES) do
    axes[name] = name ~= "gripper" and at[place] or nil
  end
  local point = host.forward(axes)
  return { point.x, point.y, point.z, point.yaw }
end

-- Lines to a location, `back` mm before it: up, or against the way in of the hand.
local function lines_to(at, back, words, now)
  if at.angles and back == 0 then
    return { line_of_joints(at, words) }
  end
  local point = point_of(at)
  local pose = { point[1], point[2], point[3], point[4], at.angles and 90 or at[5], at.angles and 180 or at[6] }
  if at.access == 1 then
    pose[3] = pose[3] + back
  else
    local yaw = math.rad(pose[4])
    pose[1], pose[2] = pose[1] - back * math.cos(yaw), pose[2] - back * math.sin(yaw)
  end
  return lines_of_pose(pose, at.angles and 0 or at.config, words, now)
end

local function note(kind, text)
  destination = { kind = kind, text = text }
end

-- The lines of a motion that runs in the background.
local function motion(make)
  return { does = "MOVE LINE", when = "at once", queue = 1, run = function(request, now)
    check_motion(request, now)
    return make(request.words, now)
  end }
end

-- How far the location is from the nest, along the axes of its slot.
local function corrections(point, nest)
  local slot = host.pose(nest.station, nest.slot)
  local x, y, yaw = point[1] - slot.x, point[2] - slot.y, math.rad(slot.yaw)
  local turn = (point[4] - slot.yaw + 180) % 360 - 180
  return ("dx=%.9f dy=%.9f dz=%.9f turn=%.9f"):format(x * math.cos(yaw) + y * math.sin(yaw), y * math.cos(yaw) - x * math.sin(yaw),
    point[3] - slot.z, turn)
end

-- A pick or a place at a location: the nest that is nearest to it.
local function transfer(word)
  return function(request, now)
    check_motion(request, now)
    local at = location(request.words[1])
    local point = point_of(at)
    local nest = host.nearest(point[1], point[2], point[3])
    if not nest or nest.distance > NEAR then
      fail(-1040, ("Position too far: no nest within %d mm of the location"):format(NEAR))
    end
    local line = ("%s %s %d %s %s"):format(word, nest.station, nest.slot, corrections(point, nest), shares(profiles[1]))
    if cut_short then
      cut_short = false
      return { "RECOVER", line }
    end
    return line
  end
end

------------------------------------------------------------------------------------------------------------ queries

local function ask(answer)
  return { does = "LOCAL", run = function(request, now) return answer(request.words, now, request) end }
end

-- Tells a value without arguments, else sets it.
local function value(read, write)
  return ask(function(words, now, request)
    if #words == 0 then
      return text_of(read())
    end
    return write(words, request) or ""
  end)
end

-- The limits of a profile's fields.
local LEAST, HIGHEST = { 0.001, 0, 0.001, 0.001, 0, 0, 0, -1 }, { [7] = 100, [8] = 1 }

local function read_field(place, word)
  if place == 7 and tonumber(word) == -1 then
    fail(-705, "Value too small: -1: motions that blend are not simulated")
  end
  return number(word, LEAST[place], HIGHEST[place])
end

-- A field of a profile.
local function of_profile(place, told)
  return ask(function(words)
    local list = profile(words[1])
    if not words[2] then
      return text_of(whole(words[1])) .. " " .. (told and told(list[place]) or text_of(list[place] + 0.0))
    end
    list[place] = read_field(place, words[2])
    return ""
  end)
end

local commands = {
  nop = ask(function() return "" end),
  version = ask(function() return "Waferhand" end),
  mode = value(function() return 0 end, function(words)
    if whole(words[1], 0, 1) ~= 0 then
      fail(-706, "Value too large: only PC mode, 0, is simulated")
    end
  end),
  hp = ask(function(_, now) return is_on(now) and "1" or "0" end),
  ["hp 1"] = { does = "CONTROLLER", run = function(_, now)
    if now.controller.estop == "on" then
      fail(-1028, "Hard E-Stop")
    end
    return "CONTROLLER power=on brakes=released"
  end },
  ["hp 0"] = { does = "CONTROLLER", run = function()
    free = {}
    return "CONTROLLER power=off"
  end },
  attach = value(function() return attached and -1 or 0 end, function(words, request)
    if request.port ~= "motion" then
      fail(-1009, "No robot attached")
    end
    attached = whole(words[1], 0, 1) == 1
  end),
  sysstate = ask(function(_, now)
    return text_of(now.controller.estop == "on" and 14 or is_on(now) and (attached and 21 or 20) or 7)
  end),
  state = { does = "STATUS", answer = function(_, result)
    return result.status.phase == "running" and "1" or "0"
  end },
  selectrobot = value(function() return selected end, function(words) selected = whole(words[1], 0, 1) end),
  payload = value(function() return payload end, function(words) payload = whole(words[1], 0, 100) end),
  mspeed = value(function() return monitor end, function(words) monitor = whole(words[1], 1, 100) end),
  base = value(function() return base[1] + 0.0, base[2] + 0.0, base[3] + 0.0, base[4] + 0.0 end, function(words)
    for _, part in ipairs(numbers(words, 1, 4)) do
      if part ~= 0 then
        fail(-1041, "Invalid Base transform: only none is simulated")
      end
    end
  end),
  tool = value(function() return table.unpack({ 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 }) end, function(words)
    for _, part in ipairs(numbers(words, 1, 6)) do
      if part ~= 0 then
        fail(-706, "Value too large: only the hand without a tool is simulated")
      end
    end
  end),
  sig = ask(function(words)
    local which = whole(words[1], 1, 999)
    if words[2] then
      signals[which] = whole(words[2])
      return ""
    end
    return text_of(which, signals[which] or 0)
  end),
  pd = ask(function(words) return parameters[table.concat(words, " ")] or "0" end),
  pc = ask(function(words)
    local set = table.remove(words)
    local name = table.concat(words, " ")
    parameter_count = parameter_count + (parameters[name] == nil and 1 or 0)
    if parameter_count > 500 then
      fail(-706, "Value too large: more than 500 parameters")
    end
    parameters[name] = set
    return ""
  end),
  reset = ask(function() attached = false return "" end),

  wherej = ask(function(_, now) return where_j(now) end),
  wherec = ask(function(_, now) return where_c(now) end),
  where = ask(function(_, now) return where_c(now):gsub(" %S+$", "") .. " " .. where_j(now) end),
  destj = ask(function(words, now)
    local moves = now.status.phase == "running" or words[1] == "1"
    return moves and destination and destination.kind == "j" and destination.text or where_j(now)
  end),
  destc = ask(function(words, now)
    local moves = now.status.phase == "running" or words[1] == "1"
    return moves and destination and destination.kind == "c" and destination.text or where_c(now)
  end),
  waitforeom = { does = "LOCAL", when = "idle", run = function() return "" end },
  halt = { does = "STOP" },
  exit = { does = "LOCAL", closes = true, run = function() return "" end },

  speed = of_profile(1), speed2 = of_profile(2), accel = of_profile(3), decel = of_profile(4),
  accramp = of_profile(5), decramp = of_profile(6), inrange = of_profile(7),
  straight = of_profile(8, function(set) return set ~= 0 and "True" or "False" end),
  profile = ask(function(words)
    local list = profile(words[1])
    if not words[2] then
      return text_of(whole(words[1]), table.unpack(list))
    end
    local set = {}
    for place = 1, 8 do
      set[place] = read_field(place, words[place + 1])
    end
    table.move(set, 1, 8, 1, list)
    return ""
  end),

  locangles = ask(function(words, now)
    local at, count = location(words[1]), has_rail(now) and 6 or 5
    if words[2] then
      local list = numbers(words, 2, count)
      -- With a rail it comes first.
      for place = 1, count do
        at[place] = list[count == 6 and (place == 6 and 1 or place + 1) or place]
      end
      at.angles = true
      return ""
    end
    if not at.angles then
      fail(-1012, "the location is no angles")
    end
    return text_of(1, whole(words[1])) .. " " .. text_of(table.unpack(at, 1, count))
  end),
  locxyz = ask(function(words)
    local at = location(words[1])
    if words[2] then
      for place, set in ipairs(numbers(words, 2, 6)) do
        at[place] = set
      end
      at.angles = false
      return ""
    end
    if at.angles then
      fail(-1012, "the location is no point")
    end
    return text_of(0, whole(words[1])) .. " " .. text_of(at[1] + 0.0, at[2] + 0.0, at[3] + 0.0, at[4] + 0.0, at[5] + 0.0, at[6] + 0.0)
  end),
  locconfig = ask(function(words)
    local at = location(words[1])
    at.config = words[2] and whole(words[2], 0) or at.config
    return words[2] and "" or text_of(whole(words[1]), at.config)
  end),
  loczclearance = ask(function(words)
    local at = location(words[1])
    if words[2] then
      at.clearance, at.world = number(words[2]), words[3] and whole(words[3]) or at.world
      return ""
    end
    return text_of(whole(words[1]), at.clearance + 0.0, at.world)
  end),
  stationtype = ask(function(words)
    local at = location(words[1])
    if words[2] then
      at.access, at.kind = whole(words[2], 0, 1), whole(words[3], 0, 1)
      at.clearance, at.above, at.grasp = table.unpack(numbers(words, 4, 3))
      return ""
    end
    return text_of(whole(words[1]), at.access, at.kind, at.clearance + 0.0, at.above + 0.0, at.grasp + 0.0)
  end),
  rail = ask(function(words)
    local at = location(words[1])
    at.rail = words[2] and number(words[2]) or at.rail
    return words[2] and "" or text_of(at.rail + 0.0)
  end),
  herej = ask(function(words, now)
    local at = location(words[1])
    table.move(joints(now), 1, 6, 1, at)
    at.angles = true
    return ""
  end),
  herec = ask(function(words, now)
    local at, pose = location(words[1]), hand(now)
    table.move({ pose.x, pose.y, pose.z, pose.yaw, 90, 180 }, 1, 6, 1, at)
    at.angles, at.config = false, elbow_of(now)
    return ""
  end),
  teachplate = ask(function(words, now)
    local at, pose = location(words[1]), hand(now)
    table.move({ pose.x, pose.y, pose.z, pose.yaw, 90, 180 }, 1, 6, 1, at)
    at.angles, at.config, at.clearance = false, elbow_of(now), words[2] and number(words[2]) or 50
    return ""
  end),

  gripopenpos = value(function() return open_width + 0.0 end, function(words) open_width = number(words[1]) end),
  gripclosepos = value(function() return close_width + 0.0 end, function(words) close_width = number(words[1]) end),
  graspdata = value(function() return grasp[1] + 0.0, grasp[2] + 0.0, grasp[3] + 0.0 end, function(words) grasp = numbers(words, 1, 3) end),
  isfullyclosed = ask(function() return width <= 2 and "-1" or "0" end),
  freemode = ask(function(words, now, request)
    local which = whole(words[1], -1, 6)
    check_power(request, now)
    if which == 6 and not has_rail(now) then
      fail(-2800, "Warning Parameter Mismatch: no rail")
    elseif which == 5 then
      fail(-1012, "Joint out-of-range: the gripper")
    end
    free = which > 0 and { [which] = true } or which == 0 and { true, true, true, true, false, true } or {}
    return ""
  end),
  zerotorque = ask(function(words, now, request)
    check_power(request, now)
    free = whole(words[1], 0, 1) == 1 and { [whole(words[2] or "1", 1, 6)] = true } or {}
    return ""
  end),
  releasebrake = { does = "CONTROLLER", run = function(request)
    whole(request.words[1], 1, 6)
    return "CONTROLLER brakes=released"
  end },
  setbrake = { does = "CONTROLLER", run = function(request)
    whole(request.words[1], 1, 6)
    return "CONTROLLER brakes=set"
  end },

  -- Motions.
  movej = motion(function(words, now)
    local values = numbers(words, 2, has_rail(now) and 6 or 5)
    note("j", text_of(table.unpack(values)))
    return line_of_joints(values, profile(words[1]))
  end),
  movec = motion(function(words, now)
    local pose = numbers(words, 2, 6)
    note("c", text_of(table.unpack(pose)) .. " " .. elbow_of(now))
    return lines_of_pose(pose, words[8] and whole(words[8], 0) or 0, profile(words[1]), now)
  end),
  moveoneaxis = motion(function(words, now)
    local values, which = {}, whole(words[1], 1, 6)
    if which == 6 and not has_rail(now) then
      fail(-1002, "Invalid axis number: 6")
    end
    values[which] = number(words[2])
    if which == 5 then
      width = values[5]
      return "MOVE z=" .. ("%.9f"):format(now.position.z or 0)
    end
    return line_of_joints(values, profile(words[3] or "1"))
  end),
  move = motion(function(words, now) return lines_to(location(words[1]), 0, profile(words[2] or "1"), now) end),
  moveappro = motion(function(words, now)
    local at = location(words[1])
    return lines_to(at, at.clearance, profile(words[2] or "1"), now)
  end),
  moveextraaxis = ask(function(words, now, request)
    check_motion(request, now)
    if not has_rail(now) then
      fail(-1002, "Invalid axis number: no rail")
    end
    rail_next = number(words[1])
    return ""
  end),
  ["moverail 1"] = motion(function(words, now)
    if not has_rail(now) then
      fail(-2800, "Warning Parameter Mismatch: no rail")
    end
    return ("MOVE rail=%.9f %s"):format(words.rail or location(words.station or "").rail, shares(profiles[1]))
  end),
  moverail = ask(function(words, now, request)
    check_motion(request, now)
    rail_next = words.mode == 2 and (words.rail or location(words.station or "").rail) or nil
    return ""
  end),

  home = { does = "HOME", run = function(request, now)
    check_power(request, now)
    check_free()
    check_hands()
    return "HOME"
  end },
  movetosafe = { does = "HOME", run = function(request, now) check_motion(request, now) return "HOME" end },
  gripper = { does = "VALVE", run = function(request, now)
    check_power(request, now)
    local which = whole(request.words[1], 1, 2)
    width = which == 1 and open_width or close_width
    return ("VALVE %s %d"):format(hand_name(now), which == 1 and 1 or 0)
  end },
  pickplate = { does = "RECOVER GET", run = transfer("GET"), answer = function() width = grasp[1] return "-1" end },
  placeplate = { does = "RECOVER PUT", run = transfer("PUT"), answer = function() width = open_width end },
}
commands.homeall = { does = "HOME", run = function(_, now)
  if not is_on(now) then
    fail(-1046, "Power not enabled")
  elseif attached then
    fail(-1050, "Illegal while a robot is attached")
  end
  shown = {}
  return "HOME"
end }

------------------------------------------------------------------------------------------------------------ frames

-- "MoveRail STATION MODE RAIL", of which the first and the last may be missing.
local function take_rail(words)
  local count = #words
  words.mode = whole(words[count >= 3 and 2 or count == 2 and words[2]:find("[012]") == 1 and #words[2] == 1 and 2 or 1] or "0", 0, 2)
  words.station = count >= 3 and words[1] or count == 2 and #words[2] == 1 and words[1] or nil
  words.rail = count >= 3 and number(words[3]) or count == 2 and not words.station and number(words[2]) or nil
  return words.mode == 1 and "moverail 1" or "moverail"
end

local function decode(frame, client)
  local words = {}
  for word in frame:gmatch("%S+") do
    words[#words + 1] = word
  end
  local name = table.remove(words, 1)
  if not name then
    return nil
  end
  name = name:lower()
  if name == "moverail" then
    name = take_rail(words)
  elseif name == "hp" and words[1] then
    name = ("hp %d"):format(whole(words[1], 0, 1))
  end
  cut_short = cut_short or name == "halt" or name == "hp 0"
  return { command = name, words = words, port = client.port }
end

local function told(request, result)
  if request.command == "exit" then
    return nil
  elseif result.ok then
    local text = result.reply or request.words and commands[request.command].does == "LOCAL" and result.answer or ""
    if request.command == "placeplate" and result.answer:find("slot_occupied", 1, true) then
      return "-3100 Hard envelope error: something is in the nest"
    end
    return text == "" and "0" or "0 " .. text
  end
  cut_short = cut_short or request.command == "pickplate" or request.command == "placeplate"
  -- The gripper has closed on nothing: a pick that is told to have found no plate.
  if request.command == "pickplate" and (result.name == "WAFER_MISSING" or result.name == "VACUUM_TIMEOUT" or result.name == "VACUUM_BEFORE_PICK") then
    return "0 0"
  end
  return ("%s %s"):format(result.code, result.text)
end

-- These end a motion in its middle.
local CUTS = {}
for _, name in ipairs({ "STOPPED", "NO_POWER", "BRAKES_SET", "EMERGENCY_STOP", "SERVO_ERROR" }) do
  CUTS[wh.errors[name].number] = true
end

-- Moved by hand, stopped by hand.
local function tester(text)
  local what, joint, at = text:match("^(%a+)%s+(%a+)%s*(%S*)$")
  if what == "estop" and (joint == "on" or joint == "off") then
    cut_short = cut_short or joint == "on"
    return "CONTROLLER estop=" .. joint
  end
  local place, value = JOINTS[joint or ""], tonumber(at)
  if (what ~= "hand" and what ~= "overshoot") or not place or (at ~= "" and not (value and value - value == 0)) then
    host.refuse("BAD_ARGUMENT", "tell: " .. text .. " (expected estop on, estop off, hand JOINT [VALUE], or overshoot JOINT VALUE)")
  end
  if what == "overshoot" then
    return value and ("CONTROLLER exceeded=%s at=%.17g"):format(AXES[place], value) or "CONTROLLER exceeded=none"
  end
  shown[place] = value
end

return {
  name = "one line, one answer, numbered",
  mechanism = "robot",
  ports = { "status", "motion" },
  in_order = true,
  framing = { ends = { "\r\n", "\n" }, longest = 512 },
  begins = "CONTROLLER power=off",
  events = { "error" },
  gone = function(client)
    if client.port == "motion" then
      attached, rail_next, free, cut_short = false, nil, {}, true
      return "CONTROLLER power=off"
    end
  end,
  tester = tester,
  decode = decode,
  commands = commands,
  encode = {
    answer = told,
    complete = told,
    refuse = function(_, failure)
      return ("%s %s"):format(failure.code, failure.detail ~= "" and failure.detail or failure.text)
    end,
    bad = function(reason) return "-712 Invalid syntax: " .. reason end,
    -- Nobody is told: a motion that was answered when it began has ended in its middle.
    event = function(event) cut_short = cut_short or CUTS[event.value] or false end,
  },
  errors = {
    NO_SUCH_COMMAND = -2805, NOT_HOMED = -1021, LIMIT_EXCEEDED = -1012, OUT_OF_REACH = -1040, CORRECTION_TOO_LARGE = -1040, BUSY = -1050, STOPPED = -1045,
    NO_POWER = -1046, EMERGENCY_STOP = -1028, SOFT_LIMIT = -1012,
    COLLISION_AHEAD = -3102, WAFER_ALREADY_THERE = -3100, WAFER_ON_GRIPPER = -3101, WAFER_LOST = -3103, BAD_LIMITS = -706, NO_WAFER_ON_GRIPPER = -3104,
  },
  other_error = "-1000",
  states = { idle = "0", running = "1", held = "2" },
}
