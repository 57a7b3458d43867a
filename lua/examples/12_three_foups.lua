-- FOUPs side by side are served without a hand-coded move: `robot.transit` keeps blade and wafer within a circle
-- while the robot turns. Without it the first way from FOUP1 to FOUP2 ends in a wall.
cell "../layouts/three_foups.lua"

for slot = 1, 3 do
  get("FOUP1", slot)   put("FOUP2", slot)
  get("FOUP2", slot)   put("FOUP3", slot)
end
home()

for slot = 1, 3 do
  expect(holder(("W%02d"):format(slot)) == nil, ("the wafer of slot %d was put down"):format(slot))
  local dx, dy = offset(("W%02d"):format(slot), "FOUP3", slot)
  expect(math.abs(dx) < 1e-6 and math.abs(dy) < 1e-6, "and lies in FOUP3 as it did in FOUP1")
end
