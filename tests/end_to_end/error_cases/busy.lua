-- A command's options are read within it; these run another.
cell "cell.lua"
get("A", 1, setmetatable({}, { __pairs = function() get("A", 2) return next, {}, nil end }))
