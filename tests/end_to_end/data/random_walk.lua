-- Commands at random, whatever comes of them: params.stations, params.grippers and params.robots are names with commas between,
-- params.seed says which commands, params.count how many.
cell(params.layout)

local state = params.seed % 2147483646 + 1

local function below(n)
  state = state * 48271 % 2147483647
  return state // 16 % n
end

local function one_of(names)
  local list = {}
  for name in names:gmatch("[^,]+") do
    list[#list + 1] = name
  end
  return list[1 + below(#list)]
end

local function between(low, high)
  return low + (high - low) * below(1001) / 1000
end

local function place()
  return one_of(params.stations), below(3) == 0 and 1 + below(4) or 1
end

local function gripper()
  return one_of(params.grippers)
end

-- A word that moves a robot, of one of several.
local function by_robot(word, ...)
  if params.robots == "" then
    return _G[word](...)
  end
  local words = robot(one_of(params.robots))
  return words[word](words, ...)
end

local ops = {
  function() get(place()) end,
  function() get(place()) end,
  function() put(place()) end,
  function() put(place()) end,
  function() swap(place()) end,
  function() by_robot("ready", place()) end,
  function() by_robot("line", { dz = between(-12, 12) }) end,
  function() by_robot("line", { dz = between(-25, 25) }) end,
  function() by_robot("line", { dx = between(-60, 60), dy = between(-60, 60) }) end,
  function() by_robot("line", { dx = between(-9, 9), dy = between(-9, 9), dz = between(-9, 9) }) end,
  function() by_robot("move", { r = between(300, 900) }) end,
  function() by_robot("move", { z = between(850, 1150), theta = between(-180, 180) }) end,
  function() valve(gripper(), 0) end,
  function() valve(gripper(), 1) end,
  function() wait(between(0, 3)) end,
  function() wait(below(20) / 1000) end,
  function() rotate(one_of(params.stations), between(-270, 270)) end,
  function() lift(one_of(params.stations), below(2) == 0 and "up" or "down") end,
  function() flip(gripper()) end,
  function() align(one_of(params.stations)) end,
  function() by_robot("home") end,
  function() by_robot("recover") end,
  function() stop_in(between(0, 1)) end,
  function() fault({ kind = "leak", gripper = gripper(), value = between(0, 1), lasting = between(0, 2) }) end,
  function() fault({ kind = "valve_stuck", gripper = gripper(), lasting = between(0, 0.5) }) end,
  function()
    local first, second = place(), place()
    local others = task(function() pcall(get, first, 1) end)
    pcall(put, second, 2)
    join(others)
  end,
  function()
    local others = task(function() rotate(one_of(params.stations), between(-270, 270)) end)
    wait(between(0, 1))
    join(others)
  end,
}

for _ = 1, params.count do
  pcall(ops[1 + below(#ops)])
end
