-- Two robots hand wafers over at two load locks: each side is a task of its own, and only one robot at a time has a station.
-- With --set alone=true one thing is done after the other.
cell "../layouts/two_robots.lua"

local ATM, VAC = robot "ATM", robot "VAC"
local PROCESS = 4   -- seconds

local function bring(slot)
  ATM:get("FROM", slot)   ATM:put("IN", 1)
end

local function treat()
  VAC:get("IN", 1)   VAC:put("PM", 1)
  wait(PROCESS)
  VAC:get("PM", 1)   VAC:put("OUT", 1)
end

local function take_away(slot)
  ATM:get("OUT", 1)   ATM:put("TO", slot)
end

if params.alone then
  for slot = 1, 4 do
    bring(slot)   treat()   take_away(slot)
  end
else
  local vacuum = task(function()
    for _ = 1, 4 do
      await "in is full"
      treat()
      signal "out is full"
    end
  end)
  for slot = 1, 5 do
    if slot < 5 then
      bring(slot)   signal "in is full"
    end
    if slot > 1 then
      await "out is full"   take_away(slot - 1)
    end
  end
  join(vacuum)
end

for slot = 1, 4 do
  expect_offset("W" .. slot, "TO", slot, 0, 0, 1e-6)
end
