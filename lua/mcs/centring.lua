-- Centring on the way: a PUT with `centre` passes the beams at its station's door, and goes aside by the
-- wafer's offset on the blade that they give.

-- Local copies: a script may set globals of these names.
local ipairs, math, table = ipairs, math, table

return function(native, lookup, stations)
  local centring = {}

  -- The result of the last pass, for scripts; nil before one.
  local last = nil

  -- By gripper: the direction of the held wafer's notch in its frame, and its deviation, rad.
  local notches = {}

  -- The direction of the notch of the wafer that a gripper holds is known from an alignment: in the gripper's
  -- frame, rad, with its standard deviation. Without a direction it is unknown, as after each GET and PUT.
  function centring.know_notch(gripper, direction, deviation)
    notches[gripper] = direction and { notch = direction, sd_notch = deviation } or nil
  end

  -- Call it when the way into a station begins.
  function centring.begin(target)
    if target.centre then
      local station = lookup.station(target.station)
      native.arm_beams(station.index, target.gripper, stations.shift(station, target.robot))
    end
  end

  -- A point of the blade relative to the blade's middle, in base.
  local function in_base(gripper, x, y)
    local R = native.gripper_pose(gripper).R
    return R[1][1] * x + R[1][2] * y, R[2][1] * x + R[2][2] * y
  end

  -- The vector in the slot's frame, seen from above.
  local function in_slot(target, x, y)
    local along, across = target.place.dir_x, target.place.dir_y
    local bx, by = in_base(target.gripper, x, y)
    return bx * along + by * across, by * along - bx * across
  end

  -- The limits of the allowed corrections, as parts of both: corners, and the middles between them.
  local ENDS = { { -1, -1 }, { -1, 0 }, { -1, 1 }, { 0, -1 }, { 0, 1 }, { 1, -1 }, { 1, 0 }, { 1, 1 } }

  -- In a plan, at the end of the way in: raises unless the blade can go to every place where beams may send
  -- it, from the taught slot.
  function centring.check_room(target)
    local most, place = native.layout.corrections, target.place
    for _, part in ipairs(ENDS) do
      local along, across = part[1] * most.dx - target.dx, part[2] * most.dy - target.dy
      native.try_segment {
        line = { along * place.dir_x - across * place.dir_y, along * place.dir_y + across * place.dir_x, 0 },
        gripper = target.gripper, target = target, where = "where `centre` may lead (`corrections.x` and `.y` of the layout), in",
      }
    end
  end

  local function told(target, found)
    local best = found.candidates[1]
    local result = {
      station = target.station, gripper = native.layout.grippers[target.gripper].name, error = found.error,
      sure = found.error == 0, used = best and best.used or 0, missed = found.missed,
      crossings = found.crossings, candidates = {},
    }
    for index, candidate in ipairs(found.candidates) do
      local dx, dy = in_slot(target, candidate.x, candidate.y)
      result.candidates[index] =
        { dx = dx, dy = dy, radius = candidate.radius, sd = candidate.sd, used = candidate.used }
    end
    if result.sure then
      local dx, dy = in_slot(target, best.sd_x, 0)
      local ex, ey = in_slot(target, 0, best.sd_y)
      result.dx, result.dy = result.candidates[1].dx, result.candidates[1].dy
      result.sd_dx, result.sd_dy = math.sqrt(dx * dx + ex * ex), math.sqrt(dy * dy + ey * ey)
      result.sd, result.radius = best.sd, best.radius
    end
    return result
  end

  -- The axis on which the offset from the taught place, including the command's own, exceeds the
  -- layout's limit; or nil.
  local function too_large(target, result)
    for _, name in ipairs({ "dx", "dy" }) do
      local most = native.layout.corrections[name]
      if math.abs(target[name] - result[name]) > most then
        return name
      end
    end
  end

  local function say_too_large(target, result)
    local name = too_large(target, result)
    local axis, own = name:sub(2), target[name]
    local text = "the wafer is %.3f mm off along the slot's %s (expected at most %.10g: corrections.%s of the layout)"
    local all = own ~= 0 and ("; with %s = %.10g the blade would go %.3f mm aside, and both count"):format(name, own,
      own - result[name]) or ""
    return text:format(result[name], axis, native.layout.corrections[name], axis) .. all
  end

  -- The blade stands in the station: the wafer's offset from the centre in base, or false.
  function centring.answer(target)
    local found = native.centre(notches[target.gripper] or {})
    native.disarm_beams()
    last = told(target, found)
    target.centred = last
    if last.sure and too_large(target, last) then
      last.sure, last.error = false, lookup.errors.CORRECTION_TOO_LARGE.number
    end
    return last.sure and { in_base(target.gripper, found.candidates[1].x, found.candidates[1].y) }
  end

  local MISFIT = {
    [0] = "no place of the wafer fits the crossings: a beam may stand elsewhere than the layout says (its `sd` says how "
      .. "well that is known), or true diameters vary (wafer.spread)",
    "the crossings fit one place alone, %s, with a radius of %.3f mm, which is not likely and which nothing confirms: a "
      .. "beam may stand elsewhere than the layout says",
    "the crossings fit two places of the wafer: %s",
  }

  local function describe(candidates)
    local texts = {}
    for index, candidate in ipairs(candidates) do
      texts[index] = ("dX %.3f, dY %.3f mm"):format(candidate.dx, candidate.dy)
    end
    local radius = candidates[1] and candidates[1].radius
    return MISFIT[#candidates]:format(table.concat(texts, " or "), radius)
  end

  -- The beams that nothing crossed, as text; empty if there is none.
  local function say_silent(result, beams)
    local silent = {}
    for beam = 1, beams do
      local is_crossed = false
      for _, crossing in ipairs(result.crossings) do
        is_crossed = is_crossed or crossing.beam == beam
      end
      silent[#silent + 1] = not is_crossed and ("none of beam %d"):format(beam) or nil
    end
    return silent[1] and ", " .. table.concat(silent, ", ") or ""
  end

  -- Raises the reason why the PUT has brought its wafer out again.
  function centring.fail(target)
    local result, errors, refused = target.centred, lookup.errors, target.refused
    local still = "; " .. native.layout.grippers[target.gripper].name .. " still holds the wafer"
    if refused then
      native.fail(refused.name, refused.text:gsub("^error %d+ [%u_]+: [^;]*; ", "") .. still)
    elseif result.error == errors.CORRECTION_TOO_LARGE.number then
      native.fail("CORRECTION_TOO_LARGE", say_too_large(target, result) .. still)
    elseif result.error == errors.CENTRE_NOT_SURE.number then
      native.fail("CENTRE_NOT_SURE", describe(result.candidates) .. still)
    end
    local beams = lookup.station(target.station).beams[target.robot]
    local text = "%d crossings of %d beams%s, %d latches missed"
    native.fail("TOO_FEW_SAMPLES", text:format(#result.crossings, beams, say_silent(result, beams), result.missed) .. still)
  end

  -- The beams' result of the last PUT that centred: see waferhand.centring in lua/mcs/words.lua.
  function centring.last()
    return last
  end

  return centring
end
