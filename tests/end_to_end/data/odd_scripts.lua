-- Scripts that do what no operator would: params.case names one.
local cases = {}

-- A metamethod runs a command in the middle of another one: that is refused, and both are on record.
function cases.nested_command()
  cell "../../../lua/layouts/paper.lua"
  local evil = setmetatable({}, { __tostring = function() pcall(wait, 0.1) return "evil" end })
  local ok = pcall(valve, "EE", evil)
  expect(not ok, "the valve has no such level")
  wait(0.1)
end

-- A script may use the names of Lua's own functions for its own things.
function cases.globals()
  cell "../../../lua/layouts/paper.lua"
  pairs, ipairs, type, tostring, error = 1, 2, 3, 4, 5
  get("A", 1)
  put("B", 2)
  expect_offset("Wafer 1", "B", 2, 0, 0)
end

-- Errors from within a pattern name the script's line.
function cases.error_lines()
  cell "../../../lua/layouts/paper.lua"
  local _, far = pcall(get, "A", 1, { retract = 5000 })
  expect(far.name == "OUT_OF_REACH" and far.line == 25, "the first: " .. tostring(far))
  local _, slow = pcall(line, { dz = 1, speed = 1e-300 })
  expect(slow.name == "BAD_SEGMENT" and slow.line == 27, "the second: " .. tostring(slow))
end

-- The record lies outside of Lua's memory: it must not grow without end.
function cases.endless_record()
  local text = ("x"):rep(1000000)
  while true do
    expect(true, text)
  end
end

cases[params.case]()
