-- A peer in another language: hears what `sim --view` publishes for viewers, and prints a line for each message, until it is
-- killed:
--
--   LOAD 15 bodies, 42 shapes: obstacles, stations::A, ...
--   DRAW 8283 ms: obstacles 0.000000 0.000000 0.000000, ...          (places in m)
--
--   lcm-gen -l lcm_types/*.lcm --lpath TYPES
--   LUA_PATH="TYPES/?.lua;TYPES/?/init.lua;;" lua5.2 viewer.lua URL
--
-- On standard error it says when it is listening. Needs Lua 5.2 with Debian's liblcm-lua.

unpack = unpack or table.unpack -- the generated code is for Lua 5.1

local lcm = require "lcm"
local load = require "waferhand.viewer_load"
local draw = require "waferhand.viewer_draw"

local link = (lcm.lcm or lcm).new(arg[1])
io.stdout:setvbuf("line")

link:subscribe("DRAKE_VIEWER_LOAD_ROBOT", function(_, data)
  local message = load.decode(data)
  local names, shapes = {}, 0
  for i = 1, message.num_links do
    names[i] = message.link[i].name
    shapes = shapes + message.link[i].num_geom
  end
  print(("LOAD %d bodies, %d shapes: %s"):format(message.num_links, shapes, table.concat(names, ", ")))
end)

link:subscribe("DRAKE_VIEWER_DRAW", function(_, data)
  local message = draw.decode(data)
  local places = {}
  for i = 1, message.num_links do
    places[i] = ("%s %.6f %.6f %.6f"):format(message.link_name[i], unpack(message.position[i]))
  end
  print(("DRAW %d ms: %s"):format(message.timestamp, table.concat(places, ", ")))
end)

io.stderr:write("listening\n")
while true do
  link:handle()
end
