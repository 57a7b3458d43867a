-- Catches failures and takes another way: half of the trials have other commands than the run without errors. Or, with
-- params.by, decides by its measurements.
cell "study_cell.lua"

-- By a measured number, or by a distance of frames, which recorded decisions cannot have.
if params.by then
  get("A", 1)
  local far = params.by == "frames" and distance("A/1", "B/1") > 950
  put("B", (far or params.by == "offset" and offset("Wafer 1", "A", 1) > 0) and 1 or 2)
  return
end

local function try(command, ...)
  local ok, problem = pcall(command, ...)
  return ok, problem and problem.name
end

local taken, why = try(get, "A", 1)
if not taken then
  expect(why == "WAFER_MISSING", "a GET fails for a wafer missing alone, not for " .. tostring(why))
  taken = try(get, "A", 1, { offset = 3.4, stroke = 6.8 })
end
if taken and holder("Wafer 1") == "EE" then
  put("P", 1)
  rotate("P", 90)
  local back = try(get, "P", 1)
  expect(back, "the chuck gives its wafer back")
  if back then
    put("B", 1)
  end
end
expect_offset("Wafer 1", "B", 1, 0, 0, 3)
get("A", 2)
put("B", 3)
expect_offset("Wafer 2", "B", 3, 0.25, 0, 1.5)
