-- A module fails for ever with a wafer inside: that one is lost, and told by name. The others go on through the module beside it, and
-- the lot closes down. If both fail, the last wafers go past them: `--set second=300`.
cell "../layouts/timed.lua"

local down = { { "STRIP1", at = 200 } }
if params.second then down[2] = { "STRIP2", at = params.second } end
local told = flow {
  lots = { { name = "A", wafers = { "LP1", 1, 25 }, back = "LP1" } },
  routes = { strip = { { "STRIP1", "STRIP2" } } },
  down = down,
}
expect(told.lost >= 1, "who was inside is lost")
expect(params.second ~= nil or told.wafers == 24, "all others are at their ends")
