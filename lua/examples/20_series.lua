-- Process modules in series: each works beside the robot, which waits in front of one until its wafer is done.
-- --set n=4 --set p=20 --set p2=35: number of modules, seconds of each, seconds of module 2. --set dual=true: two blades swap.
cell "../layouts/series.lua"

local n, lot = params.n or 3, params.lot or 12
local processes = {}

local function begin_process(i)
  processes[i] = task(function() wait(params["p" .. i] or params.p or 10) end)
end

-- Waits in front of a module until its wafer is done; at a load lock there is no wait.
local function wait_in_front(i, slot, gripper)
  ready("S" .. i, slot, { gripper = gripper })
  if processes[i] then
    join(processes[i])
    processes[i] = nil
  end
end

-- One blade: the last module is emptied first, so that there is room for the next wafers.
local function pull(round)
  for i = n, 0, -1 do
    if processes[i] or i == 0 and round <= lot then
      local from, to = i == 0 and round or 1, i == n and round - n or 1
      wait_in_front(i, from, "EE")
      get("S" .. i, from)
      ready("S" .. i + 1, to)
      put("S" .. i + 1, to)
      if i < n then begin_process(i + 1) end
    end
  end
end

-- Two blades: the robot goes from module to module, and each finished wafer goes on into the next.
local loaded
local function exchange(i, slot, is_full)
  local free = loaded == "EE" and "E2" or "EE"
  if is_full then
    wait_in_front(i, slot, free)
    if loaded then swap("S" .. i, slot) else get("S" .. i, slot, { gripper = free }) end
  elseif loaded then
    wait_in_front(i, slot, loaded)
    put("S" .. i, slot, { gripper = loaded })
  end
  local is_filled = loaded ~= nil
  loaded = is_full and free or nil
  return is_filled
end

local function go_round(round)
  exchange(0, round, round <= lot)
  for i = 1, n do
    if exchange(i, 1, processes[i] ~= nil) then begin_process(i) end
  end
end

local work, rounds = pull, lot + n
if params.dual then
  work, rounds = go_round, lot + n + 1
end
for round = 1, rounds do
  cycle(tostring(round))
  work(round)
end
local last = params.dual and "S0" or "S" .. n + 1
for i = 1, lot do
  local wafer, slot = ("W%02d"):format(i), params.dual and i + n + 1 or i
  expect_offset(wafer, last, slot, 0, 0)
end
