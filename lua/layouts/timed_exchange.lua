-- A tool of times alone, with the times of a real one: a robot at atmosphere with one arm, one in vacuum with two, two load locks
-- and two modules, each with its doors. Locks have a slot for each way; `--set slots=1`: one slot for both.
local ways = (params.slots or 2) == 2

local function lock(down, up, atmosphere, vacuum)
  return {
    slots = ways and 2 or 1, into = ways and { 1 } or nil, out = ways and { 2 } or nil,
    pump = { down = down, up = up }, state = "atmosphere",
    by = { ATM = { side = "atmosphere", door = atmosphere }, VAC = { side = "vacuum", door = vacuum } },
  }
end

local function module(open)
  return { process = 70, by = { VAC = { door = { open = open, close = 0.75 } } } }
end

return {
  robots = {
    ATM = { kind = "timed", pick = 4.15, place = 4.1, move = 1.1, at = "LP1" },
    VAC = { kind = "timed", arms = 2, pick = 5.83, place = 5.3, move = 1.65, at = "PM1" },
  },
  stations = {
    LP1 = { kind = "load_port", by = { ATM = { door = { open = 1.1, close = 1.4 } } } },
    AL = { process = 10, by = "ATM" },
    LLA = lock(19.26, 19.30, { open = 0.64, close = 1.03 }, { open = 0.87, close = 0.88 }),
    LLB = lock(19.76, 19.24, { open = 0.53, close = 0.92 }, { open = 0.83, close = 0.90 }),
    PM1 = module(1.31),
    PM2 = module(3.83),
  },
}
