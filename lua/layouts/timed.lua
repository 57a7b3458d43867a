-- A tool of times alone: two load ports, a module with a window, and two without.
return {
  robots = { R = { kind = "timed", pick = 3, place = 3, move = 2 } },
  stations = {
    LP1 = { kind = "load_port" },
    LP2 = { kind = "load_port" },
    ETCH = { process = 35, window = 3 },
    STRIP1 = { process = 20 },
    STRIP2 = { process = 20 },
  },
}
