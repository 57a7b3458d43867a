-- Why a scan does not tell where a wafer lies: a function of what the estimate has seen, the station, and ALIGN's options.

-- Local copies: a script may set globals of these names.
local math = math

local TURN = 2 * math.pi

local function number_of_samples(seen)
  local text = "%d of %d samples see the rim, %d nothing, %d are covered, %d never came"
  local all = seen.seen + seen.nothing + seen.covered + seen.missed
  return text:format(seen.seen, all, seen.nothing, seen.covered, seen.missed)
end

local function offset_text(seen)
  return ("%.3f mm off the axis"):format(math.sqrt(seen.x * seen.x + seen.y * seen.y))
end

local function mark_text(seen)
  local depth = seen.limits.notch_depth
  return depth and ("a notch %.6g mm deep"):format(depth) or "a flat"
end

local reasons = {}

function reasons.TOO_FEW_SAMPLES(seen)
  return ("%s (expected at least %d that do)"):format(number_of_samples(seen), seen.limits.samples)
end

function reasons.BAD_SCAN(seen)
  return number_of_samples(seen)
end

function reasons.OFF_SENSOR(seen, station)
  local sensor, text = station.sensor, "the wafer is %s, its radius %.3f mm; the sensor sees from %.6g to %.6g mm"
  local half = sensor.length / 2
  return text:format(offset_text(seen), seen.radius, sensor.middle - half, sensor.middle + half)
end

function reasons.TOO_ECCENTRIC(seen)
  return ("%s (expected at most %.6g mm)"):format(offset_text(seen), seen.limits.eccentricity)
end

function reasons.CENTRE_NOT_SURE(seen)
  local limits = seen.limits
  if not seen.radius then
    return "no circle is near half of the samples: " .. number_of_samples(seen)
  elseif math.abs(seen.radius - limits.radius) > limits.radius_off then
    local text = "the rim's radius is %.3f mm (expected %.6g mm, give or take %.6g)"
    return text:format(seen.radius, limits.radius, limits.radius_off)
  end
  local text = "its standard deviation is %.5f mm (expected at most %.6g mm); %s"
  return text:format(seen.sd_centre, limits.sd_centre, number_of_samples(seen))
end

-- The dent most like a notch, and the limits of a notch.
local function dent_text(seen)
  if not seen.notch_depth then
    return ""
  elseif seen.notch_depth == 0 then
    return "; there is no dent"
  end
  local depth = ("; the likeliest dent is %.3f mm deep (expected %.3f to %.3f)"):format(
    seen.notch_depth, seen.notch_least, seen.notch_most)
  if seen.narrow_at > 0 then
    local text = " and, %.3f mm below the circle, %.2f mm wide (expected %.2f at least)"
    return depth .. text:format(seen.narrow_at, seen.width, seen.width_least)
  end
  local text = ", has %d and %d samples on its flanks (expected %d at least) and %d beside them (expected 0)"
  return depth .. text:format(seen.flank_right, seen.flank_left, seen.flank_least, seen.notch_off)
end

function reasons.NO_NOTCH(seen)
  local text = 'the rim is round all round (expected %s; mark = "none" aligns the centre alone)'
  return text:format(mark_text(seen)) .. dent_text(seen)
end

function reasons.TWO_NOTCHES(seen)
  return ("expected one alone that is %s"):format(mark_text(seen))
end

-- FINE: the largest distance of samples on the rim, mm, that always resolves a notch. THROUGH: a larger share of
-- samples off the circle means that light comes through.
local FINE, THROUGH = 0.31, 0.03

function reasons.NOTCH_NOT_SURE(seen, station, own)
  local text = "expected %s, known to %.6g degrees and unlike any other dent; %s, %d are off the circle"
  local sd, apart = math.deg(seen.limits.sd_direction), TURN * seen.radius / station.sensor.samples
  local hint = ""
  if apart > FINE and seen.limits.notch_depth then
    hint = ("; they are %.2f mm apart on the rim (expected at most %.6g mm: sensor.samples)"):format(apart, FINE)
  elseif seen.masked > THROUGH * seen.seen then
    hint = "; if light comes through the wafer, `glass` says how much" .. (own.glass and ": is it truly %.10g?" or "")
  end
  return text:format(mark_text(seen), sd, number_of_samples(seen), seen.masked) .. dent_text(seen) .. hint:format(own.glass)
end

return function(seen, station, own)
  local reason = reasons[seen.verdict]
  return reason and reason(seen, station, own) or nil
end
