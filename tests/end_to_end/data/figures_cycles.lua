-- Three cycles of 7.502, 9.502 and 9.502 s with a wafer each; the last mark begins nothing.
cell "figures_layout.lua"
for slot = 1, 3 do
  cycle("of slot " .. slot)
  get("A", slot)
  wait(0.5)
  put("B", slot)
end
cycle()
