-- The script of tutorial.md: each wafer by way of the aligner and the load lock.
cell "efem_cell.lua"
for slot = 1, 3 do
  cycle()
  get("LP1", slot)   put("AL", 1)
  rotate("AL", 30)
  get("AL", 1)       put("LL", 1)
  get("LL", 1)       put("LP2", slot)
end
cycle()
expect_offset("W3", "LP2", 3, 0, 0, 0.1)
