-- Flows of robots of both kinds: `case` says what happens on the way.
cell "flow_mixed.lua"
local case, last = params.case, params.wafers or 6
local flows = { lots = { { wafers = { "FROM", 1, last } } }, routes = { R = { "L", "PM1", "PM2", "M", "TO" } }, rule = params.rule }

local function told(tool, problem)
  print("told", problem.kind, problem.robot, problem.action, problem.station, problem.slot, problem.name, tool.now)
  if case == "recover" and problem.robot then
    robot(problem.robot):recover()
  end
  return params.answer
end

if params.answer then
  flows.on_error = told
end
if case == "shared" then -- both locks both ways
  flows.routes.R = { { "L", "M" }, "PM1", "PM2", { "L", "M" }, "TO" }
elseif case == "door" then
  fault { kind = "door_stuck", door = params.door, after = params.after }
elseif case == "fault" then
  fault { kind = params.kind, station = params.station, value = params.value, after = params.after }
elseif case == "stop" then
  stop_in(params.at, params.mechanism)
elseif case == "down" then
  flows.down = { { params.station, at = params.at, seconds = params.seconds } }
elseif case == "own" then
  flows.rule = function(tool) return tool.choices end
end

local figures = flow(flows)
print("end", figures["end"], figures.makespan_s, figures.why)
for slot = 1, params.wafers or 6 do
  if figures["end"] == "done" then
    expect_offset(("W%02d"):format(slot), "TO", slot, slot == 1 and params.dx or 0, 0, 1e-6)
  end
end
