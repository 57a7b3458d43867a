-- Marks of cycles that are refused: before the cell, without a name that is one, and within a command.
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
expect(number.name == "BAD_ARGUMENT" and number.line == 4, "a number: " .. tostring(number))
expect(within and within.name == "BUSY", "within a command: " .. tostring(within))
