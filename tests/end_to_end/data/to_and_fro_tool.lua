return { robots = {
R1 = { kind = "timed", arms = 1, at = "P11", pick = 5, place = 1, move = 1 },
R2 = { kind = "timed", arms = 1, at = "P21", pick = 2, place = 2, swap = 2, move = 3 },
}, stations = {
B1 = { slots = 3, pump = { down = 10, up = 4 }, state = "atmosphere", into = { 1 }, out = { 2 }, by = { R1 = { side = "atmosphere" }, R2 = { side = "vacuum" } } },
LP1 = { slots = 25, kind = "load_port", by = { R1 = {} } },
LP2 = { slots = 25, kind = "load_port", by = { R1 = {} } },
P11 = { slots = 1, process = 69, window = 13, clean = { after = 1, seconds = 6, empty = true }, by = { R1 = { door = { open = 2, close = 2 } } } },
P12 = { slots = 1, process = 67, by = { R1 = {} } },
P13 = { slots = 1, process = 64, by = { R1 = {} } },
P14 = { slots = 1, process = 62, by = { R1 = {} } },
P21 = { slots = 1, process = 48, by = { R2 = {} } },
P22 = { slots = 1, process = 12, window = 5, by = { R2 = { door = { open = 0, close = 2 } } } },
B1x = { slots = 3, pump = { down = 10, up = 4 }, state = "vacuum", into = { 1 }, out = { 2 }, by = { R1 = { side = "atmosphere" }, R2 = { side = "vacuum" } } },
} }
