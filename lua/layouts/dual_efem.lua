-- A robot with two arms on a rail between three FOUPs, side by side, and two aligners.
local function foup(y)
  return { kind = "foup", at = { 700, y, 900 }, rail = y, retract = 340 }
end
local function aligner(y)
  return { kind = "prealigner", at = { -700, y, 900 }, rpy = { 0, 0, 180 }, rail = y, retract = 340 }
end

local wafers = {}
for slot = 1, 5 do
  wafers[#wafers + 1] = { name = "A" .. slot, station = "FOUP1", slot = slot }
end
for slot = 1, 5 do
  wafers[#wafers + 1] = { name = "B" .. slot, station = "FOUP2", slot = slot }
end

return {
  collision = true,
  robot = { kind = "TRZ", heading = 90, rail = { min = -600, max = 600 },
            arms = { { heading = 0 }, { heading = 180, height = 10 } } },
  grippers = {
    { name = "ONE" }, { name = "TWO", arm = 2 },
    { name = "PA1", on = "P1" }, { name = "PA2", on = "P2" },
  },
  stations = {
    FOUP1 = foup(-505), FOUP2 = foup(0), FOUP3 = foup(505),
    P1 = aligner(-250), P2 = aligner(250),
  },
  wafers = wafers,
}
