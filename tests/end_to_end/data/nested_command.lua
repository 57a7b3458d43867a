-- A metamethod runs a command in the middle of another one: that is refused, and both are on record.
cell "../../../lua/layouts/paper.lua"
local evil = setmetatable({}, { __tostring = function() pcall(wait, 0.1) return "evil" end })
local ok = pcall(valve, "EE", evil)
expect(not ok, "the valve has no such level")
wait(0.1)
