-- An edge sensor is calibrated with a wafer of known diameter and the robot that carries it. The script compares ALIGN's
-- result for the middle of a wafer that lies 7 mm aside, before and after.
cell "../layouts/calibrate.lua"

-- The error of the middle that ALIGN finds, in um.
local function how_far_off()
  local told, dx, dy = align("P"), offset("W", "P", 1)
  return 1000 * math.sqrt((told.after_dx - dx) ^ 2 + (told.after_dy - dy) ^ 2)
end

local function put_aside(dx, dy)
  get("P", 1)
  put("P", 1, { dx = dx, dy = dy })
end

get("A", 1)
put("P", 1)
align("P", { mark = "none" })
put_aside(5, -5)
local before = how_far_off()

put_aside(0, 0)
local found = calibrate("P")
print("")
print(found.text)

put_aside(5, -5)
local after = how_far_off()
print(("off by %.1f um before, %.1f um after\n"):format(before, after))
expect(before > 5 and after <= 2, "the calibrated sensor tells the middle to 2 um")
