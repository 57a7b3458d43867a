-- A tool of times alone: a coater and an oven of two slots, through which each wafer goes twice.
return {
  robots = { R = { kind = "timed", pick = 3, place = 3, move = 2, at = "LP1" } },
  stations = {
    LP1 = { kind = "load_port" },
    COAT = { process = 40 },
    BAKE = { slots = 2, process = 60 },
    OUT = { kind = "load_port" },
  },
}
