-- One GET and PUT in a cell that is never exactly as taught: how often does it work, and where does the wafer lie then?
-- waferhand study lua/examples/07_study.lua --trials 10000, or over the slots: waferhand sweep with --set slot=1:8:25
cell "../layouts/study.lua"

get("A", 1)   put("B", params.slot or 2)

-- The next tool takes wafers that lie within 1.8 mm.
expect_offset("Wafer 1", "B", params.slot or 2, 0, 0, 1.8)
