-- Lots whose carriers come and go while a flow goes on: `case` is one of what may happen.
cell "flow_carriers.lua"
local case = params.case
local lots = {
  { name = "A", wafers = { "LP1", 1, 2 }, back = "LP1" },
  { name = "B", wafers = { "LP2", 1, 2 }, back = "LP2", arrives = 6, carrier = "C2" },
}
local heard, routes, until_s, ends = {}, { R = { "PM" } }, nil, "done"
local answer = function() return "retry" end

-- The lot of C2 without saying whose it is: that one comes by somebody else.
local function by_others()
  lots[2].carrier, lots[2].arrives = nil, nil
end

if case == "late" then
  lots[3] = { name = "C", wafers = { "LP1", 1, 2 }, back = "LP1", arrives = 8, carrier = "C3", recipe = "nitride" }
elseif case == "skip" or case == "fault" then
  by_others()
  carrier("LP2", { name = "C2", at = 3, slots = { [2] = "protruded" } })
  lots[2].wafers = { "LP2", 1, 4 }
  answer = case == "skip" and function(problem) return problem.kind == "map" and "skip" or nil end or nil
elseif case == "task" then
  by_others()
  task(function() wait(9) carrier("LP2", { name = "C2" }) end)
elseif case == "nobody" then
  by_others()
  answer = nil
elseif case == "brings" then
  by_others()
  answer = function(problem) carrier(problem.station, { name = "C2" }) return "retry" end
elseif case == "timeout" then
  fault { kind = "e84_stuck", station = "LP2", step = "tp2", after = 0, lasting = 9 }
  answer = not params.gives_up and answer or nil
elseif case == "stuck" then
  fault { kind = "station_stuck", station = "LP2", after = 7 }
  answer = nil
elseif case == "away" then
  task(function() wait(11) take_away "LP2" end)
  answer = params.again and function(problem) carrier(problem.station, { name = "C2" }) return "retry" end or nil
elseif case == "other" then
  task(function() wait(11) take_away "LP2" carrier("LP2", { name = "C3" }) end)
  answer = nil
elseif case == "docked" then
  by_others()
elseif case == "ends" then
  lots[2] = nil
  lots[1].back = "LP2"
  if not params.gives_up then carrier("LP2", { name = "EMPTY", at = 12 }) end
  answer = nil
elseif case == "route" then
  lots[2] = nil
  lots[1].back, lots[1].leaves, routes.R[2] = nil, true, "LP2"
  carrier("LP2", { name = "EMPTY", at = 2 })
elseif case == "cut" then
  until_s, ends = 8, "cut"
elseif case == "again" then
  lots[2].wafers, lots[2].arrives = { "LP2", 1, 1 }, 0
  lots[3] = { name = "C", wafers = { "LP2", 1, 1 }, back = "LP2", arrives = 1, carrier = "C2", recipe = "nitride" }
end

local told = flow {
  lots = lots, routes = routes, until_s = until_s, rule = params.rule,
  on_error = answer and function(tool, problem)
    heard[#heard + 1] = ("%s %s %s"):format(problem.kind, problem.station, problem.name)
    return answer(problem)
  end,
}
print("end", told["end"], told.why, told.wafers, told.skipped)
print("heard", table.concat(heard, ", "))
expect(told["end"] == ends, "the flow ends as it should")
