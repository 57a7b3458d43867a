-- 10,000 wafers (--set wafers=N) through a tool of times alone: each robot carries out its own list, as tests/bench/peer_simpy.py does.
cell "flow_tool.lua"
local atm, vac = {}, {}
local count = params.wafers
local bring, let_in = { "LP", "IN" }, { "pump", "IN", "vacuum" }
local take, let_out = { "OUT", "LP" }, { "pump", "OUT", "vacuum" }
local back, out = { "pump", "IN", "atmosphere" }, { "pump", "OUT", "atmosphere" }
local into, from = {}, {}
for i = 1, 6 do into[i], from[i] = { "IN", "PM" .. i }, { "PM" .. i, "OUT" } end
for i = 1, count + 6 do
  local module = (i - 1) % 6 + 1
  if i <= count then
    atm[#atm + 1] = bring
    atm[#atm + 1] = let_in
  end
  if i > 6 then
    atm[#atm + 1] = take
    atm[#atm + 1] = let_out
    vac[#vac + 1] = from[module]
    vac[#vac + 1] = out
  end
  if i <= count then
    vac[#vac + 1] = into[module]
    vac[#vac + 1] = back
  end
end
local told = flow {
  lots = { { wafers = { "LP", 1, count }, back = "LP" } },
  routes = { A = { "IN", { "PM1", "PM2", "PM3", "PM4", "PM5", "PM6" }, "OUT" } },
  rule = { order = { ATM = atm, VAC = vac } },
}
expect(told["end"] == "done", "all wafers are back")
print(("makespan_s %.6f"):format(told.makespan_s))
