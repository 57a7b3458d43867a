-- An atmospheric robot serves two stacks, a robot in vacuum a process station. Between them are two load locks, one for
-- the way in and one for the way out, which each robot enters from its own side.
local aside = math.deg(math.atan(250, 730))   -- where the load locks are from the robot in vacuum

return {
  robots = {
    ATM = { kind = "TRZY", at = { -900, 0, 0 } },
    VAC = { kind = "TRZ", at = { 600, 0, 0 } },   -- its blade points along the arm
  },
  grippers = {
    { name = "ATM blade", on = "ATM" },
    { name = "VAC blade", on = "VAC" },
  },
  stations = {
    FROM = { at = { -1500, -400, 900 }, rpy = { 0, 0, 180 }, slots = 4 },   -- the atmospheric robot alone
    TO = { at = { -1500, 400, 900 }, rpy = { 0, 0, 180 }, slots = 4 },      -- comes to these two
    IN = { at = { -130, -250, 900 }, by = { ATM = {}, VAC = { rpy = { 0, 0, 180 + aside } } } },
    OUT = { at = { -130, 250, 900 }, by = { ATM = {}, VAC = { rpy = { 0, 0, 180 - aside } } } },
    PM = { at = { 1300, 0, 900 } },                                         -- and the one in vacuum to this one
  },
  wafers = {
    { name = "W1", station = "FROM", slot = 1 }, { name = "W2", station = "FROM", slot = 2 },
    { name = "W3", station = "FROM", slot = 3 }, { name = "W4", station = "FROM", slot = 4 },
  },
}
