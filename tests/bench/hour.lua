-- An hour (--set seconds=N) of a tool in vacuum: wafers to and fro between load lock, aligner and two chambers, where they are
-- processed meanwhile. tests/verify/hour plays it in full and counted.
cell "../../lua/layouts/vacuum_tool.lua"
local last = params.seconds or 3600
while now() < last do
  get("LL", 1)       put("AL", 1)
  rotate("AL", 90)
  lift("AL", "up")   lift("AL", "down")
  get("AL", 1)
  swap("PM1", 1)
  put("LL", 1, { gripper = "B" })
  get("LL", 2)       put("PM2", 1)
  wait(45)
  get("PM2", 1)      put("LL", 2)
  wait(30)
end
