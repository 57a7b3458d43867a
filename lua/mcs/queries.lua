-- The operator's words that ask and judge: offset, holder, proximity, measure, expect, expect_offset, ...

-- Local copies: a script may set globals of these names.
local math, select, tostring, type = math, select, tostring, type

return function(native, lookup, wh, judge_stay)
  local queries = {}

  -- dx, dy, dz (mm) and tilt (degrees) of a wafer in a slot's frame.
  function queries.offset(wafer, station_name, slot)
    local station = lookup.station(station_name)
    return native.measure(lookup.wafer(wafer), station.index, lookup.slot(station, slot))
  end

  -- "up" or "down": the direction of the wafer's front face.
  function queries.face(wafer)
    return native.face(lookup.wafer(wafer))
  end

  -- The name of the gripper that holds the wafer, or nil.
  function queries.holder(wafer)
    local gripper = native.holder(lookup.wafer(wafer))
    return gripper and native.layout.grippers[gripper].name
  end

  -- The check of a wafer against a gripper at their present poses: see wh.proximity.
  function queries.proximity(wafer, gripper)
    local tolerance = native.layout.tolerance
    local index = lookup.gripper(gripper)
    local base_from_face = native.wafer_pose(lookup.wafer(wafer), index)
    return wh.proximity(base_from_face, native.gripper_pose(index, "real"), tolerance)
  end

  -- The second frame relative to the first: the distance of the origins; dx, dy, dz in the first frame's axes,
  -- mm; the angle between the z axes, the whole turn, and the heading of the second's x about the first's z,
  -- degrees. A frame is the name of a wafer, a gripper, a station (its slot 1) or a slot, such as "B/10", or
  -- "base".
  function queries.measure(first, second)
    local base_from_first = lookup.frame("measure", first)
    local distance, dx, dy, dz, angle, turn, heading =
      native.relate(base_from_first, lookup.frame("measure", second))
    return { distance = distance, dx = dx, dy = dy, dz = dz, angle = angle, turn = turn, heading = heading }
  end

  -- The distance of two frames' origins, mm.
  function queries.distance(first, second)
    return (native.relate(lookup.frame("distance", first), lookup.frame("distance", second)))
  end

  -- The angle between two frames' z axes, degrees.
  function queries.angle(first, second)
    return (select(5, native.relate(lookup.frame("angle", first), lookup.frame("angle", second))))
  end

  -- The collisions so far: a list of { kind = "hit" or "undecided", parts = both names, at = { x, y, z },
  -- time = s }.
  function queries.hits()
    return native.hits()
  end

  -- The smallest gap of a kind so far, mm, its limit or nil, when (s), and both parts' names; nil if the
  -- gap never was within range, and in a cell that is not checked here.
  function queries.clearance(kind)
    local found = native.clearance(tostring(kind))
    if found == false then
      local kinds = native.clearance_kinds()
      local expected = lookup.listed(kinds) .. lookup.nearest(kind, kinds)
      native.fail("BAD_ARGUMENT", ("kind: %s (expected %s)"):format(lookup.quote(kind), expected))
    end
    found = found or {}
    return found.gap, found.limit ~= 0 and found.limit or nil, found.time, found.parts
  end

  -- Without figures that one trial alone has found, the text is `name`.
  local function expect_found(condition, text, name)
    native.expect(condition, text, #name)
    return condition
  end

  -- States an expectation. If it is false, the run goes on and fails at its end. Returns the condition.
  function queries.expect(condition, text)
    if condition ~= nil and type(condition) ~= "boolean" then
      local refusal = "condition: %s (expected true, false or nil: any other value counts as true in Lua)"
      native.fail("BAD_ARGUMENT", refusal:format(lookup.quote(condition)))
    end
    native.expect(condition, text == nil and "an expectation without words" or tostring(text))
    return condition
  end

  local function where(station, slot)
    return station and ("lies in %s slot %d"):format(station, slot) or "lies in no slot"
  end

  -- The found value as text; a value at its limit is marked.
  local function found_text(value, expected, tolerance)
    local off, text = math.abs(value - expected), ("%.12g"):format(value)
    if off < tolerance or ("%.12g"):format(off) ~= ("%.12g"):format(tolerance) then
      return text
    end
    return ("%s (%.17g off, expected less than %.17g)"):format(text, off, tolerance)
  end

  -- Expects the wafer in that slot with this offset, mm; to 1e-9 mm unless a tolerance follows. A wafer
  -- that hangs above the slot does not lie in it.
  function queries.expect_offset(wafer, station_name, slot, dx, dy, tolerance)
    tolerance = lookup.number("tolerance", tolerance == nil and 1e-9 or tolerance, { nil, nil, "mm" })
    lookup.number("dx", dx)
    lookup.number("dy", dy)
    local index, station = lookup.wafer(wafer), lookup.station(station_name)
    if tolerance <= 0 or tolerance > station.radius then
      native.fail("BAD_ARGUMENT", ("tolerance: %.10g mm (expected above 0, up to the wafer's radius of %.10g mm)")
        :format(tolerance, station.radius))
    end
    local place = lookup.slot(station, slot)
    local verdict, x, y, z, found, at = native.lies(index, station.index, place, dx, dy, tolerance)
    local text = "%s in %s slot %d with dX %.10g, dY %.10g to %.3g mm"
    text = text:format(wafer, station_name, slot, dx, dy, tolerance)
    local name = text
    if verdict == 0 then
      text = ("%s; it %s"):format(text, where(found, at))
    elseif verdict == 1 then
      local most = native.layout.tolerance.projz
      text = ("%s; found dX %s, dY %s"):format(text, found_text(x, dx, tolerance), found_text(y, dy, tolerance))
      text = math.abs(z) < most and text
        or ("%s, dZ %s (expected within %.10g mm of the slot's plane)"):format(text, found_text(z, 0, most), most)
    end
    return expect_found(verdict == 2, text, name)
  end

  -- Expects that the wafer's last stay in the station, from its process's end until it was taken, or until now, lasts at
  -- most so many seconds.
  function queries.expect_within(wafer, station, seconds)
    return expect_found(judge_stay(wafer, station, seconds))
  end

  return queries
end
