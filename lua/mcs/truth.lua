-- The cell's truth at the end of a command that went well by its sensors, or by what its pattern says. A controller
-- that asks no sensor cannot know it, so the command stays as it ended: the run expects it, and fails without.

return function(native, lookup)
  local truth = {}

  local function name_of(gripper)
    return native.layout.grippers[gripper].name
  end

  -- By whose word it went well, if that is a pattern of one's own.
  local function source(target)
    local own = target.source
    return own and "; " .. (own.claimed or "by " .. own.pattern) or ""
  end

  -- A GET has taken a wafer. One that asks no sensor may go to an empty slot: there nothing is missed.
  function truth.expect_taken(target)
    local text = ("GET %s %d: a wafer on %s"):format(target.station, target.slot, name_of(target.gripper))
    if native.held(target.gripper) then
      native.imply(true, text)
      return
    end
    local left = native.lies_in(lookup.station(target.station).index, target.slot)
    if left then
      native.imply(false, ("%s; %s still lies there%s"):format(text, left, source(target)))
    elseif target.asks then
      native.imply(false, ("%s; it holds none%s"):format(text, source(target)))
    end
  end

  -- Why a wafer is not where a PUT was to bring it, or nil. One that is off by a whole pitch or more lies well, but in
  -- another slot: no other check finds that.
  local function misplaced(target, wafer)
    local holder = native.holder(native.wafer(wafer))
    if holder and holder ~= target.chuck then
      return ("%s holds it"):format(name_of(holder))
    end
    local is_elsewhere, station, slot = native.is_elsewhere(wafer, lookup.station(target.station).index, target.slot)
    if is_elsewhere then
      return ("it lies in %s slot %d"):format(station, slot)
    elseif target.chuck and not holder then
      return ("%s does not hold it"):format(name_of(target.chuck))
    end
  end

  -- The wafer of a PUT is let go and lies in its slot, or its chuck holds it.
  function truth.expect_given(target, wafer)
    if not wafer then
      return
    end
    local text, why = ("PUT %s %d: %s in that slot"):format(target.station, target.slot, wafer), misplaced(target, wafer)
    native.imply(not why, why and ("%s; %s%s"):format(text, why, source(target)) or text)
  end

  -- Pins, or a chuck, have taken over the wafer that `giver` held.
  function truth.expect_passed(text, wafer, taker)
    local passed = not wafer or native.holder(native.wafer(wafer)) == taker
    if wafer then
      native.imply(passed, ("%s: %s on %s"):format(text, wafer, name_of(taker)))
    end
  end

  return truth
end
