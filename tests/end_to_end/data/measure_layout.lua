-- Wafers whose names are also those of a station and of slots: some that there are, and one that there is not.
return {
  grippers = { { name = "EE" }, { name = "PA", on = "P" } },
  stations = {
    A = { at = { 650, 0, 900 }, rpy = { 0, 0, 0 }, slots = 3 },
    B = { at = { 0, 650, 900 }, rpy = { 0, 3, 90 }, slots = 3 },
    P = { kind = "prealigner", at = { -600, 0, 950 }, rpy = { 0, 0, 180 } },
  },
  wafers = {
    { name = "Wafer", station = "A", slot = 1, dx = 3, dy = 4 },
    { name = "B", station = "A", slot = 2 },
    { name = "A/3", station = "A", slot = 3, dx = 1 },
    { name = "A/4", station = "B", slot = 3, dy = 2 },
  },
}
