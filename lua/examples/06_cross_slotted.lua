-- A wafer that lies across two slots is found by MAP, and no GET goes in there.
cell "../layouts/crossed.lua"

local codes = map("A")
local text = table.concat(codes)
print("A: " .. text)
expect(text == "1104400201", "one single slot after another, 4 and 5 crossed, 8 doubled")

for _, slot in ipairs { 4, 5, 8 } do
  local ok, problem = pcall(get, "A", slot)
  expect(not ok and problem.name == "BAD_SLOT", "GET A " .. slot .. " is refused")
end

-- No blade went in, so no wafer was touched; a slot beside a crossed one is refused, too.
local ok, problem = pcall(get, "A", 3)
expect(not ok and problem.name == "BAD_SLOT", "the blade would meet the crossed wafer from slot 3, too")
local _, _, dz = offset("Crossed", "A", 4)
expect(dz == 5 and holder("Crossed") == nil, "the crossed wafer lies as it did")

-- The sound slots are free to use.
map("B")
get("A", 1)   put("B", 1)
get("A", 2)   put("B", 2)
