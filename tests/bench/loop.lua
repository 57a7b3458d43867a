-- A script's own loop: one wafer to and fro, --set commands=N of them.
cell "../../lua/layouts/series.lua"
for _ = 1, params.commands // 4 do
  get("S0", 1)
  put("S1", 1)
  get("S1", 1)
  put("S0", 1)
end
