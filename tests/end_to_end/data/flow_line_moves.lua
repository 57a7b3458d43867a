-- Measures each GET and PUT from READY, and each way between two stations from READY to READY, loaded or empty as a
-- flow goes it; tells them in s.
cell "flow_line.lua"
local slots = { A = 8, B = 8, P1 = 1, P2 = 1, P3 = 1 }
local route = { "A", "P1", "P2", "P3", "B" }

local function clock(name, body)
  local begun = now()
  body()
  print(("%s %.6f"):format(name, now() - begun))
end

local function way(from, to)
  ready(from, slots[from])
  clock("move " .. from .. " " .. to, function() ready(to, slots[to]) end)
end

for i = 2, 4 do
  way(route[i + 1], route[i - 1])
end
way("P1", "P3")
for i = 1, 4 do
  local from, to = route[i], route[i + 1]
  ready(from, slots[from])
  clock("get " .. from, function() get(from, slots[from]) end)
  clock("move " .. from .. " " .. to, function() ready(to, slots[to]) end)
  clock("put " .. to, function() put(to, slots[to]) end)
  if to ~= "B" then
    clock("process " .. to, function() wait_for(to) end)
  end
end
