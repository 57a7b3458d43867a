-- A row a stay: from when on a wafer lies in a station, and when a robot begins to take it. Picks and places
-- follow from that, with this tool's one robot and its times.
local robot, pick_s, place_s = "R", 3, 3

return {
  separator = ";",
  expand = function(row)
    local rows = {}
    local function add(action, begin_s, end_s)
      rows[#rows + 1] = { robot = action ~= "start" and robot or nil, action = action, wafer = row.wafer, station = row.station,
        slot = row.slot, begin_s = begin_s, end_s = end_s }
    end
    local load, unload = tonumber(row.load), tonumber(row.unload)
    if load then
      add("place", load - place_s, load)
    else
      add("start", 0, 0)
    end
    if unload then
      add("pick", unload, unload + pick_s)
    end
    return rows
  end,
}
