-- The script of tutorial.md's second part: each robot and each process module is a task of its own.
cell "tool_cell.lua"
local ATM, VAC = robot "ATM", robot "VAC"
local WAFERS <const> = 6
local PROCESS = params.process or 30   -- seconds

local function run_module(name, valve, first)
  task(function()
    for _ = first, WAFERS, 2 do
      await(name .. " is full")
      close(valve)   wait(PROCESS)   open(valve)
      signal(name .. " is done")
    end
  end)
end
run_module("PM1", "V1", 1)
run_module("PM2", "V2", 2)

local function tell_air(what)
  signal(what)   signal "work in air"
end

task(function()
  for turn = 1, WAFERS + 2 do
    local name = turn % 2 == 1 and "PM1" or "PM2"
    local is_new, is_old = turn <= WAFERS, turn > 2   -- a wafer for the module, one out of it
    if is_new then
      await "IN is full"
      VAC:get("IN", 1, { gripper = "NEW" })
      if turn < WAFERS then tell_air "IN is empty" end
    end
    if is_old then await(name .. " is done") end
    if is_new and is_old then VAC:swap(name, 1)
    elseif is_new then VAC:put(name, 1, { gripper = "NEW" })
    else VAC:get(name, 1, { gripper = "DONE" }) end
    if is_new then signal(name .. " is full") end
    if is_old then
      await "OUT is empty"
      VAC:put("OUT", 1, { gripper = "DONE" })
      tell_air "OUT is full"
    end
  end
end)

if params.stuck then fault { kind = "door_stuck", door = params.stuck, after = 20 } end
tell_air "IN is empty"
signal "OUT is empty"
local brought, back = 0, 0
for _ = 1, 2 * WAFERS do
  await "work in air"
  if await("OUT is full", 0) then
    back = back + 1
    ATM:get("OUT", 1)
    if back < WAFERS then signal "OUT is empty" end
    ATM:put("LP", back)
  else
    await "IN is empty"
    brought = brought + 1
    ATM:get("LP", brought)
    ATM:put("IN", 1)
    signal "IN is full"
  end
end

for slot = 1, WAFERS do
  expect_offset("W" .. slot, "LP", slot, 0, 0, 1e-6)
end
