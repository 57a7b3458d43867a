-- A layout that leaves string functions behind whose results are no text, though they can be strung together.
local odd = {}
setmetatable(odd, { __concat = function() return odd end })
string.gsub = function() return odd end
string.find = function() return 5 end
return {
  grippers = { { name = "EE" } },
  stations = { A = { at = { 700, 0, 900 } } },
}
