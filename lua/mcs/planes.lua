-- Planes: the side from which a blade comes to a wafer. A target has one of them, and grips and patterns go by it.
--
--   enter(target, loaded)          the height at which the blade moves in and, having done its work, out again
--   reach(target)                  of an empty blade: from there to where its pads touch the wafer
--   rise(target), sink(target)     from there out, with the wafer and without
--   sweep(target, open)            reaches the wafer of a plain slot; `open` opens the valve and may return why to end
--   keep(target), fail(target, close)   after a sweep: out with the wafer; closes the valve, and out without
--   lower(target)                  of a loaded blade: to where it lets the wafer go
--   withdraw(target, is_kept)      from there out; `is_kept`, if given, asks whether the wafer is still there
--   retreat(target, height)        out from any height, for RECOVER

return function(steps)
  local stroke = steps.stroke

  -- From below, as pads lie that point up.
  local below = {}

  local function bottom(target)
    return target.offset - target.stroke
  end

  function below.enter(target, loaded)
    return loaded and target.offset or bottom(target)
  end

  function below.reach(target)
    stroke(target, -bottom(target))
  end

  function below.rise(target)
    stroke(target, target.offset)
  end

  function below.sink(target)
    stroke(target, bottom(target))
  end

  function below.sweep(target, open)
    local why = open(true)
    if not why then
      stroke(target, target.stroke)
    end
    return why
  end

  function below.keep() end

  -- Moves down to where a PUT lets go, closes the valve, moves down below the wafer: a wafer on the blade
  -- stays in the slot.
  function below.set_back(target, height, close)
    if height > target.release then
      stroke(target, target.release - height)
      height = target.release
    end
    close(target)
    stroke(target, target.offset - target.stroke - height)
  end

  function below.fail(target, close)
    below.set_back(target, target.offset, close)
  end

  function below.lower(target)
    stroke(target, target.release - target.offset)
  end

  function below.withdraw(target, is_kept)
    stroke(target, (is_kept and is_kept(target) and target.offset or bottom(target)) - target.release)
  end

  function below.retreat(target, height)
    if target.loaded then
      stroke(target, target.offset - height)
    else
      target.grip.settle(target, height)
    end
  end

  -- From above, with a blade that is turned over. Its pads take a wafer and let go of one at the height
  -- `target.touch`.
  local above = {}

  function above.enter(target)
    return target.touch + target.offset
  end

  function above.reach(target)
    stroke(target, -target.offset)
  end

  above.lower, above.rise, above.sink, above.keep, above.withdraw = above.reach, below.rise, below.rise, below.rise, below.rise

  function above.sweep(target, open)
    above.reach(target)
    return open(false)
  end

  function above.fail(target, close)
    close(target)
    above.rise(target)
  end

  function above.retreat(target, height)
    stroke(target, above.enter(target) - height)
  end

  return { below = below, above = above }
end
