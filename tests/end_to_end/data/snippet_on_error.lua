-- A handler of errors from the manual, in place of the comment: the STOP of one robot does not end the flow.
cell "../../tests/end_to_end/data/flow_mixed.lua"
stop_in(15, "VAC")
local told = flow {
  lots = { { wafers = { "FROM", 1, 2 } } }, routes = { R = { "L", "PM1", "PM2", "M", "TO" } },
  -- the snippet
}
expect(told["end"] == "done" and told.wafers == 2, "both wafers are there")
