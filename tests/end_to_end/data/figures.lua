-- Runs whose figures are computed by hand: params.case names one; without it, the cycles.
local cases = {}

-- Three cycles of 7.502, 9.502 and 9.502 s with a wafer each; the last mark begins nothing.
function cases.cycles()
  cell "figures_layout.lua"
  for slot = 1, 3 do
    cycle("of slot " .. slot)
    get("A", slot)
    wait(0.5)
    put("B", slot)
  end
  cycle()
end

-- Marks of cycles that are refused: before the cell, without a name that is one, and within a command.
function cases.errors()
  local _, early = pcall(cycle)
  cell "figures_layout.lua"
  local _, number = pcall(cycle, 3)
  local within
  local evil = setmetatable({}, { __tostring = function()
    local _, problem = pcall(cycle)
    within = problem
    return "evil"
  end })
  pcall(valve, "EE", evil)
  expect(early.name == "NO_LAYOUT", "before the cell: " .. tostring(early))
  expect(number.name == "BAD_ARGUMENT" and number.line == 20, "a number: " .. tostring(number))
  expect(within and within.name == "BUSY", "within a command: " .. tostring(within))
end

-- A wafer over the prealigner and back to where it was, one that is dropped, and a GET that finds nothing.
function cases.prealigner()
  cell "figures_layout.lua"
  cycle "over the prealigner"
  get("A", 1) put("P", 1) rotate("P", 90) get("P", 1) put("A", 1)
  cycle "dropped"
  get("A", 2)
  valve("EE", 1)
  pcall(get, "B", 1)
end

-- Two blades at a prealigner that is never empty: a wafer in and another one out each cycle.
function cases.swap()
  cell "../../../lua/layouts/dual.lua"
  get("A", 1) put("P", 1)
  cycle "in with the second"
  get("A", 2) swap("P", 1) put("A", 1, { gripper = "BACK" })
  cycle "in with the first"
  get("A", 1) swap("P", 1) put("A", 2, { gripper = "BACK" })
end

-- One wafer, over B and back: two, if B counts.
function cases.lock()
  cell "figures_layout.lua"
  get("A", 1) put("B", 1) get("B", 1) put("A", 1)
end

function cases.aligner()
  cell "figures_layout.lua"
  get("A", 1) put("P", 1)
end

-- Two tasks at the prealigner and one that waits for a signal, beside the paper's first run; one that fails.
function cases.tasks()
  cell "../../../lua/layouts/paper.lua"
  local turned = task(function() for _ = 1, 3 do rotate("P", 90) signal("turned") end end)
  local noted = task(function() return await("turned") and await("turned", 5) end)
  local twice = task(function() rotate("P", -20) valve("PA", 1) end)
  get("A", 1) put("B", 2)
  expect(join(noted) and not pcall(join, task(function() get("A", 99) end)), "two turns, and no slot 99")
  join(turned, twice)
end

cases[params.case or "cycles"]()
