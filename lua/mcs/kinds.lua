-- Plans of known kinds: where time is counted, a GET, PUT or SWAP of a known kind is not planned again.
--
-- A kind is all that a plan goes by: its pattern, its target with all options and taught places, its robot, in front of what that
-- stands, and what native.take_kind compares, the bits of axes, valves and speeds. No plan is found by a text. Patterns of one's own may go by
-- anything, so their plans are not kept; nor are those that measure on the way, or stand still in a phase.

-- Local copies: a script may set globals of these names.
local ipairs, pairs, table = ipairs, pairs, table

return function(native, patterns, arm, tasks)
  local kinds = {}
  -- The most that are kept; then all of them are forgotten.
  local MOST = 128
  -- By station and slot: a list.
  local known, count = {}, 0
  local shipped = { get = patterns.get, put = patterns.put, swap = patterns.swap }
  -- The fields of a request that may be a target.
  local AIMS = { "target", "enters", "note" }

  -- A pattern of ours, while none of the three is a script's own, in a command without shares of speed or acceleration.
  local function may_be_kept(pattern)
    local get, put, swap = patterns.get, patterns.put, patterns.swap
    return get == shipped.get and put == shipped.put and swap == shipped.swap and (pattern == get or pattern == put or pattern == swap)
      and not tasks.current().share
  end

  local function is_plain(target)
    return not target.centre and not target.stop and not target.source and not target.place.up
  end

  local function list_at(target)
    local place = target.get or target
    local slots = known[place.station]
    return slots and slots[place.slot]
  end

  local function is_alike(kind, target)
    if kind.get then
      return target.get and native.is_alike(kind.get, target.get) and native.is_alike(kind.put, target.put)
    end
    return native.is_alike(kind.own, target)
  end

  -- The kind's plan, for this target.
  local function plan_of(kind, target)
    local plan = table.move(kind.plan, 1, #kind.plan, 1, { pattern = kind.plan.pattern, target = target, answers = {},
      detours = kind.plan.detours, way = kind.plan.way, became = kind.plan.became })
    for _, aim in ipairs(kind.aims) do
      aim.request[aim.field] = aim.part and target[aim.part] or target
    end
    return plan
  end

  -- The plan of a target's kind, ready to be played, or nil.
  function kinds.find(pattern, target)
    local list = list_at(target)
    if not list or not may_be_kept(pattern) then
      return nil
    end
    local robot, front = tasks.current().robot or 1, arm.state().front
    for _, kind in ipairs(list) do
      if kind.plan.pattern == pattern and kind.robot == robot and kind.station == (front and front.station)
        and kind.gripper == (front and front.gripper) and is_alike(kind, target)
        and native.take_kind(kind.data, robot) then
        return plan_of(kind, target)
      end
    end
  end

  local function copy(target)
    if not target then
      return nil
    end
    local copied = {}
    for name, value in pairs(target) do
      copied[name] = value
    end
    return copied
  end

  -- Which fields of a plan's requests are its target, or one of its parts.
  local function list_aims(plan)
    local aims, target = {}, plan.target
    for _, request in ipairs(plan) do
      for _, field in ipairs(AIMS) do
        local aim = request[field]
        aims[#aims + 1] = aim and { request = request, field = field, part = aim ~= target and (aim == target.get and "get" or "put") or nil } or nil
      end
    end
    return aims
  end

  local function add(target, kind)
    local place = target.get or target
    if count >= MOST then
      known, count = {}, 0
    end
    known[place.station] = known[place.station] or {}
    local slots = known[place.station]
    slots[place.slot] = slots[place.slot] or {}
    table.insert(slots[place.slot], kind)
    count = count + 1
  end

  -- Keeps a plan that was just made and not begun.
  function kinds.keep(plan)
    local target, robot = plan.target, tasks.current().robot or 1
    if not may_be_kept(plan.pattern) or not is_plain(target.get or target) or not is_plain(target.put or target) then
      return
    end
    local data, front = native.keep_kind(robot), arm.state().front
    if data then
      add(target, { plan = plan, data = data, robot = robot, station = front and front.station, gripper = front and front.gripper,
        own = copy(not target.get and target or nil), get = copy(target.get), put = copy(target.put), aims = list_aims(plan) })
    end
  end

  return kinds
end
