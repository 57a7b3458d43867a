-- Stations round one robot: wafers lie in A, go through three modules, and end in B. `seed` turns them and draws how long they process.
-- With two arms the robot exchanges.
local seed, arms = params.seed or 1, params.arms or 1
local function draw(number, from, to)
  local share = (seed * 7919 + number * 104729) % 1009 / 1009
  return from + math.floor(share * (to - from))
end

local stations, angle = {}, draw(1, 0, 40)
for number, name in ipairs { "A", "P1", "P2", "P3", "B" } do
  local turn, far = math.rad(angle), 640 + draw(10 + number, 0, 100)
  stations[name] = { at = { far * math.cos(turn), far * math.sin(turn), 890 }, rpy = { 0, 0, angle }, retract = 320 }
  if name:find "P" then
    stations[name].process = draw(20 + number, params.least or 1, params.most or 30)
  else
    stations[name].slots, stations[name].pitch = 25, 5
  end
  angle = angle + 55 + draw(30 + number, 0, 20)
end

local wafers = {}
for slot = 1, params.wafers or 24 do
  wafers[slot] = { name = ("W%d"):format(slot), station = "A", slot = slot }
end

return {
  robot = { kind = arms == 1 and "TRZY" or "TRZ", theta = { min = -720, max = 720 },
    arms = arms == 2 and { { heading = 0 }, { heading = 180, height = 10 } } or nil },
  grippers = arms == 1 and { { name = "EE" } } or { { name = "E1", arm = 1 }, { name = "E2", arm = 2 } },
  stations = stations, wafers = wafers, look_ahead = false,
}
