-- Two robots go by their own points: side by side in tasks, held in a phase, and stopped on the way.
cell "via_robots_layout.lua"
local ATM, VAC = robot "ATM", robot "VAC"
local vacuum = task(function()
  VAC:home()
  await "there"
  VAC:get("LL", 1, { stop = "extended" })
  wait(0.1)
  VAC:continue()
end)
ATM:get("A", 1)
ATM:put("LL", 1)
ATM:home()
signal "there"
join(vacuum)
-- Stopped between two points: from there HOME goes straight.
local ready = task(function() VAC:ready("P", 1) end)
if not params.straight then
  stop_in(0.9, "VAC")
end
local ok, problem = pcall(join, ready)
expect(not ok and problem.name == "STOPPED", "it was stopped")
VAC:recover()
VAC:home()
ATM:ready("A", 1)
ATM:home()
expect(holder("W1") == "VAC blade", "VAC has it")
