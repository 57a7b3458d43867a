-- A flow from the manual, in place of the comment; without it nothing moves, and nothing is expected.
-- the snippet
expect(holder "W25" == nil, "the last wafer lies in a slot")
for slot = 1, 25 do
  expect_offset(("W%02d"):format(slot), "TO", slot, 0, 0, 1e-6)
end
