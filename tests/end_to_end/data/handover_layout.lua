-- A chuck at a height and with a valve order that the test draws.
return {
  grippers = { { name = "EE" }, { name = "PA", on = "P" } },
  stations = {
    B = { at = { 0, 700, params.slot_height }, rpy = { 0, 0, 90 } },
    P = { kind = "prealigner", at = { -600, 0, params.chuck_height }, rpy = { 0, 0, 180 }, handover = params.handover },
  },
  wafers = { { name = "Wafer", station = "B", slot = 1, dx = params.dx, dy = params.dy } },
}
