-- Two stations and a prealigner, two wafers in A; the vacuum takes its time.
return {
  vacuum = "delayed",
  grippers = { { name = "EE" }, { name = "PA", on = "P" } },
  stations = {
    A = { at = { 650, 0, 900 }, slots = 5 },
    B = { at = { 0, 650, 900 }, rpy = { 0, 0, 90 }, slots = 5 },
    P = { kind = "prealigner", at = { -600, 0, 950 }, rpy = { 0, 0, 180 } },
  },
  wafers = { { station = "A", slot = 1 }, { station = "A", slot = 4 } },
}
