-- Beams of light at the doors of two load locks, and wafers that lie beside the middle of their slots. Those of LL stand at different
-- distances from the way; those of OLD at nearly the same one, so that they cannot always tell which crossing met a notch.
local function beams(...)
  local list = {}
  for i, y in ipairs({ ... }) do
    list[i] = { y = y, delay_on = 50e-6, delay_off = 80e-6, jitter = 3e-6 }
  end
  return list
end

return {
  grippers = { { name = "EE" } },
  stations = {
    A = { at = { 700, 0, 900 }, slots = 3 },
    LL = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, slots = 2, centre = true, beams = beams(60, -110) },
    OLD = { at = { 0, -700, 900 }, rpy = { 0, 0, -90 }, centre = true, beams = beams(85, -91) },
  },
  wafers = {
    { name = "W1", station = "A", slot = 1, dx = 1.5, dy = -0.8, rpy = { 0, 0, 90 } },
    { name = "W2", station = "A", slot = 2, dx = -0.6, dy = 2.1, rpy = { 0, 0, 23 }, rim = { diameter = 300 } },
    { name = "W3", station = "A", slot = 3, dx = 0.4, dy = 0.3, rpy = { 0, 0, 33.88 } },
  },
}
