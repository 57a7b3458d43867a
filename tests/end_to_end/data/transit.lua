-- Within a circle: with two arms, on a rail with a blade that turns over, with a column that tilts, or by points.
cell "transit_layout.lua"
if params.robot == "two" then
  get("A", 1, { gripper = "LO" })
  get("B", 1, { gripper = "UP" })
  put("C", 1, { gripper = "LO" })
  put("D", 1, { gripper = "UP" })
  local going = task(function() ready("A", 1, { gripper = "UP" }) end)
  stop_in(0.4)
  local ok, problem = pcall(join, going)
  expect(not ok and problem.name == "STOPPED", "it was stopped as it turned")
  recover()
  ready("A", 1, { gripper = "UP" })
  ready("B", 1, { gripper = "LO" })
  move { theta = -40, r2 = 600 }
  move { theta = 120 }
  home()
  expect_offset("W1", "C", 1, 0, 0, 0.5)
  expect_offset("W2", "D", 1, 0, 0, 0.5)
elseif params.robot ~= "flips" then
  get("A", 1)
  put("C", 1)
  get("B", 1)
  ready("D", 1)
  put("D", 2)
  ready("B", 2)
  home()
  expect_offset("W1", "C", 1, 0, 0, 0.5)
  expect_offset("W2", "D", 2, 0, 0, 0.5)
else
  get("A", 1)
  put("B", 2)
  ready("C", 1)
  flip("LO")
  ready("D", 1)
  move { theta = 20, rail = 400, flip = 0 }
  ready("C", 1)
  move { rail = 300 }
  home()
  expect_offset("W1", "B", 2, 0, 0, 0.5)
end
