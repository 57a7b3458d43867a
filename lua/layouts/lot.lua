-- A FOUP whose wafers lie aside and turned as they came, a prealigner that sees their edges, and a FOUP that they go to in order.
local function wafer(number, dx, dy, turn, rim)
  return { name = ("W%02d"):format(number), station = "A", slot = number, dx = dx, dy = dy, rpy = { 0, 0, turn }, rim = rim }
end

return {
  grippers = { { name = "EE" }, { name = "PA", on = "P" } },
  stations = {
    A = { kind = "foup", at = { 700, 0, 900 } },
    B = { kind = "foup", at = { 0, 700, 900 }, rpy = { 0, 0, 90 } },
    P = { kind = "prealigner", at = { -620, 0, 950 }, rpy = { 0, 0, 180 }, sensor = { noise = 0.005 } },
  },
  wafers = {
    wafer(1, 1.5, -0.8, 37, { diameter = 300.05 }),
    wafer(2, -2.1, 0.4, -120, { diameter = 299.9, chips = { { at = 110, width = 2, depth = 0.3 } } }),
    wafer(3, 0.3, 2.6, 179, { notch = { depth = 1.2, angle = 93 } }),
    wafer(4, -0.9, -1.7, 5, { chips = { { at = 200, width = 6, depth = 2 }, { at = 320, width = 1, depth = 0.4 } } }),
    wafer(5, 0.6, 0.6, 60, { notch = { depth = 0 } }),
  },
}
