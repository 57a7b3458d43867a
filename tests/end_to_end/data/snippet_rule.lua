-- A rule of one's own from the manual, in place of the comment.
cell "../../lua/layouts/timed.lua"
local told = flow {
  lots = { { wafers = { "LP1", 1, 25 }, back = "LP1" } }, routes = { A = { "ETCH", "STRIP1" } }, late = "tell",
  -- the snippet
}
expect(told["end"] == "done" and told.wafers == 25, "all wafers are back")
