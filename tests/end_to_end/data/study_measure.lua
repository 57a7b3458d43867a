-- Decides by a measured number, or by a distance of frames: recorded decisions cannot have either.
cell "study_cell.lua"

get("A", 1)
if params.by == "frames" then
  put("B", distance("A/1", "B/1") > 950 and 1 or 2)
else
  local dx = offset("Wafer 1", "A", 1)
  put("B", dx > 0 and 1 or 2)
end
