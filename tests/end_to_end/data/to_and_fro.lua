-- A robot goes ahead where nobody can go on, and comes back without a wafer: it must not go on for ever.
cell "to_and_fro_tool.lua"
flow { lots = {
{ name = "L0", wafers = { "LP1", 1, 6 }, route = "A", priority = 1, back = "LP1" },
{ name = "L1", wafers = { "LP1", 7, 12 }, route = "C", arrives = 137, priority = 1, dummy = true },
}, routes = {
A = { "P11", "P14", { "P13", "P12", process = 60 }, { "B1", "B1x" }, { "P22", "P21" }, { "B1", "B1x" }, "LP2" },
B = { "P13", { "P11", process = 34 }, { "P12", "P14" }, "LP2", partial = { [3] = 1 } },
C = { "P14", "P12", { "P11", "P13", process = 28 }, { "B1", "B1x" }, { "P21", "P22" }, { "B1", "B1x" }, "LP2" },
},
until_s = 20000,
rule = "backward",
down = { { "P22", at = 171, seconds = 113 } },
takt = 0,
safe = false,
late = "tell" }
