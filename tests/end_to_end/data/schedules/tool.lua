-- A load port, a lock between two robots, a buffer and two modules; each route is one that a test's wafers go.
return {
  robots = {
    R1 = { kind = "timed", pick = 2, place = 2, move = 1, at = "LP" },
    R2 = { kind = "timed", arms = 2, pick = 2, place = 2, move = 1, swap = 4, at = "BUF" },
  },
  stations = {
    LP = { kind = "load_port", slots = 5, by = "R1" },
    X = { slots = 2, by = "R1" },
    LL = {
      pump = { down = 10, up = 10 },
      by = { R1 = { side = "atmosphere", door = 1 }, R2 = { side = "vacuum", door = 1 } },
    },
    BUF = { slots = 4, by = "R2" },
    PM1 = { process = 30, window = 20, by = "R2" },
    PM2 = { process = 40, clean = { after = 1, seconds = 15 }, by = "R2" },
  },
  routes = {
    aside = { "X" },
    first = { "PM1", "BUF" },
    second = { "PM2", "BUF" },
    into = { "LL" },
    through = { "LL", "BUF" },
    over = { "BUF" },
  },
}
