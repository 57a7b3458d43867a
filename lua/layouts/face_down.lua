-- Wafers lie face down in D, as a grinder leaves them. B takes them so, U does not.
return {
  grippers = {
    { name = "EE", on = "robot" },
    { name = "P1", on = "P" },
  },
  stations = {
    D = { at = { 700, 0, 900 }, slots = 5, face = "down" },
    B = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, slots = 5, face = "down" },
    U = { at = { 0, -700, 900 }, rpy = { 0, 0, -90 }, slots = 5, face = "up" },
    P = { kind = "prealigner", at = { -620, 0, 950 }, rpy = { 0, 0, 180 }, sensor = { noise = 0.005 } },
  },
  wafers = {
    { name = "W01", station = "D", slot = 1, dx = 1.5, dy = -0.8, rpy = { 0, 0, 37 } },
    { name = "W02", station = "D", slot = 2, dx = -0.6, dy = 0.9, rpy = { 0, 0, -110 } },
    { name = "W03", station = "U", slot = 3 },
  },
}
