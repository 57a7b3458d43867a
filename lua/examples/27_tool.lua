-- 25 wafers go through a tool with two robots and four process stations, each robot and each process in a task of its own;
-- collisions are looked for between all parts.
cell "../layouts/tool.lua"

local ATM, VAC = robot "ATM", robot "VAC"
local WAFERS <const>, STATIONS <const> = 25, 4
local PROCESS = params.process or 40   -- seconds

-- A process runs after its station was filled.
for i = 1, STATIONS do
  task(function()
    for _ = i, WAFERS, STATIONS do
      await("PM" .. i .. " is full")
      wait(PROCESS)
      signal("PM" .. i .. " is done")
    end
  end)
end

-- In vacuum one arm brings new wafers, and the other one takes finished ones.
local function take_out()
  await "OUT is empty"
  VAC:put("OUT", 1, { gripper = "VAC 2" })
  signal "OUT is full"
end

local vacuum = task(function()
  for wafer = 1, WAFERS do
    local station = "PM" .. (wafer - 1) % STATIONS + 1
    await "IN is full"
    VAC:get("IN", 1, { gripper = "VAC 1" })
    signal "IN is empty"
    if wafer <= STATIONS then
      VAC:put(station, 1, { gripper = "VAC 1" })
      signal(station .. " is full")
    else
      await(station .. " is done")
      VAC:swap(station, 1)
      signal(station .. " is full")
      take_out()
    end
  end
  for wafer = WAFERS - STATIONS + 1, WAFERS do
    local station = "PM" .. (wafer - 1) % STATIONS + 1
    await(station .. " is done")
    VAC:get(station, 1, { gripper = "VAC 2" })
    take_out()
  end
end)

-- In air one blade does both.
signal "IN is empty"
signal "OUT is empty"
local brought, taken = 0, 0
while taken < WAFERS do
  if await("OUT is full", 0) then
    taken = taken + 1
    ATM:get("OUT", 1)
    signal "OUT is empty"
    ATM:put("TO", taken)
  elseif brought < WAFERS and await("IN is empty", 0.1) then
    brought = brought + 1
    ATM:get("FROM", brought)
    ATM:put("IN", 1)
    signal "IN is full"
  elseif brought == WAFERS then
    wait(0.1)
  end
end
join(vacuum)   await "IN is empty"   await "OUT is empty"

for wafer = 1, WAFERS do
  expect_offset(("W%02d"):format(wafer), "TO", wafer, 0, 0, 1e-6)
end
