-- Centring on the way: a PUT with `centre` passes the beams at its station's door, and goes aside by what they
-- say of the wafer on its blade.

-- Kept, for a script may set globals of these names.
local ipairs, math, table = ipairs, math, table

return function(native, lookup)
  local centring = {}

  -- What the last pass told, for scripts; nil before one.
  local last = nil

  -- By gripper: in which direction of its frame the held wafer's notch is, and how sure that is, rad.
  local notches = {}

  -- The direction of the notch of the wafer that a gripper holds is known from an alignment: in the gripper's
  -- frame, rad, with its standard deviation. Without a direction it is not, as after each GET and PUT.
  function centring.know_notch(gripper, direction, deviation)
    notches[gripper] = direction and { notch = direction, sd_notch = deviation } or nil
  end

  -- The way into a station begins.
  function centring.begin(target)
    if target.centre then
      native.arm_beams(lookup.station(target.station).index, target.gripper)
    end
  end

  -- A point of the blade as seen from the blade's middle: in base.
  local function in_base(gripper, x, y)
    local R = native.gripper_pose(gripper).R
    return R[1][1] * x + R[1][2] * y, R[2][1] * x + R[2][2] * y
  end

  -- The same in the slot's frame, seen from above.
  local function in_slot(target, x, y)
    local along, across = target.place.dir_x, target.place.dir_y
    local bx, by = in_base(target.gripper, x, y)
    return bx * along + by * across, by * along - bx * across
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

  -- Beyond what the layout allows a command to go beside what was taught, that of the command included.
  local function too_large(target, result)
    for _, name in ipairs({ "dx", "dy" }) do
      local most = native.layout.corrections[name]
      if math.abs(target[name] - result[name]) > most then
        return name
      end
    end
  end

  -- The blade stands in the station: how far the wafer's centre is off in base, or false.
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

  local function describe(candidates)
    local texts = {}
    for index, candidate in ipairs(candidates) do
      texts[index] = ("dX %.3f, dY %.3f mm"):format(candidate.dx, candidate.dy)
    end
    return table.concat(texts, " or ")
  end

  -- The PUT has brought its wafer out again: why.
  function centring.fail(target)
    local result, errors = target.centred, lookup.errors
    local still = "; " .. native.layout.grippers[target.gripper].name .. " still holds the wafer"
    if result.error == errors.CORRECTION_TOO_LARGE.number then
      local name = too_large(target, result)
      local text = "the wafer is %.3f mm off along the slot's %s (expected at most %.10g: corrections.%s of the layout)"
      native.fail("CORRECTION_TOO_LARGE", text:format(result[name], name:sub(2), native.layout.corrections[name],
        name:sub(2)) .. still)
    elseif result.error == errors.CENTRE_NOT_SURE.number then
      local text = #result.candidates > 0 and "the crossings fit two places of the wafer: "
        .. describe(result.candidates) or "no place of the wafer fits the crossings: if true diameters vary, wafer.spread of the layout says so"
      native.fail("CENTRE_NOT_SURE", text .. still)
    end
    local text = "%d crossings of %d beams, %d latches missed"
    native.fail("TOO_FEW_SAMPLES",
      text:format(#result.crossings, lookup.station(target.station).beams, result.missed) .. still)
  end

  -- What the beams of the last PUT that centred said: see waferhand.centring in lua/mcs/words.lua.
  function centring.last()
    return last
  end

  return centring
end
