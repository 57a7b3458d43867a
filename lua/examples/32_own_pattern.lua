-- A pattern of one's own: a GET from above that waits longer for a slow vacuum, and a look into the slot before it.
-- `--set patterns=false` plays the shipped GET, which does not wait so long.
if params.patterns ~= false then
  patterns "../patterns/careful.lua"
end
cell "../layouts/flip.lua"

get("A", 1)
flip("EE")
put("D", 1)                                   -- W01 lies face down
fault { kind = "slow_vacuum", gripper = "EE", value = 1 }
if params.patterns ~= false then
  pattern("look", "D", 1)
end
get("D", 1)                                   -- from above: the wafer comes after more than a second
expect(holder("W01") == "EE", "the blade has waited for W01")
