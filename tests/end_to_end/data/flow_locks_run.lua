-- Flows with real robots: `case` says what happens on the way.
cell "flow_locks.lua"
local case, last = params.case, params.wafers or 6
local routes = { R = { "L", "PM1", "PM2", "M", "TO" } }
local flows = { lots = { { wafers = { "FROM", 1, last } } }, routes = routes, rule = params.rule, late = params.late }

local function told(tool, problem)
  print("told", problem.kind, problem.robot, problem.action, problem.station, problem.slot, problem.name, tool.now)
  return params.answer
end

if params.answer then
  flows.on_error = told
end
if case == "shared" then -- both locks both ways
  routes.R = { { "L", "M" }, "PM1", "PM2", { "L", "M" }, "TO" }
elseif case == "error" then
  fault { error = params.error }
elseif case == "stop" then
  stop_in(params.at, params.mechanism)
elseif case == "recover" then
  stop_in(params.at, "VAC")
  flows.on_error = function(tool, problem)
    robot(problem.robot):recover()
    return told(tool, problem) or "retry"
  end
elseif case == "until" then
  flows.until_s = params.at
elseif case == "down" then
  flows.down = { { "PM1", at = 10, seconds = params.seconds or math.huge } }
elseif case == "fault" then
  fault { kind = params.kind, station = params.station, value = params.value, after = params.after }
elseif case == "door" then
  fault { kind = "door_stuck", door = "PM1 door", after = params.after }
elseif case == "own" then
  flows.rule = function(tool) return tool.choices end
elseif case == "list" then
  flows.rule = { order = {
    ATM = { { "FROM", "L" }, { "FROM", "L" }, { "M", "TO" }, { "M", "TO" } },
    VAC = { { "L", "PM1" }, { "PM1", "PM2" }, { "L", "keep" }, { "PM2", "M" }, { "keep", "PM1" }, { "PM1", "PM2" }, { "PM2", "M" } },
  } }
elseif case == "process" then
  routes.R[2] = { "PM1", process = 3 }
elseif case == "arrives" then
  flows.lots = { { name = "first", wafers = { "FROM", 1, 2 } }, { name = "second", wafers = { "FROM", 3, last }, arrives = 100 } }
elseif case == "late start" then
  wait(7)
elseif case == "open" then
  open "PM1 door"
  open "PM2 door"
end

local figures = flow(flows)
print("end", figures["end"], figures.makespan_s, figures.why)
