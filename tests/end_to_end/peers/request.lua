-- A peer in another language: asks motion control to execute lines, waits for the answers, and reads the simulator's states.
--
--   lcm-gen -l lcm_types/*.lcm --lpath TYPES
--   LUA_PATH="TYPES/?.lua;TYPES/?/init.lua;;" lua5.2 request.lua URL "GET A 1" "PUT B 2"
--
-- Needs Lua 5.2 with Debian's liblcm-lua; both mcs and sim must run at URL. If a state comes meanwhile, the last is printed.

unpack = unpack or table.unpack -- the generated code is for Lua 5.1

local lcm = require "lcm"
local request = require "waferhand.request"
local mcs = require "waferhand.mcs"
local state = require "waferhand.state"

local link = (lcm.lcm or lcm).new(arg[1])
local answers, last = {}, nil

link:subscribe("WAFERHAND_MCS", function(_, data)
  local message = mcs.decode(data)
  if message.request ~= 0 and (message.phase == 3 or message.phase == 4) then
    answers[message.request] = message
  end
end)

link:subscribe("WAFERHAND_STATE", function(_, data)
  last = data
end)

-- Sends the line again each second until its answer comes: motion control executes a number once.
local function ask(number, line)
  local sent, give_up = nil, os.time() + 30
  while not answers[number] do
    if os.time() > give_up then
      error("no answer to " .. line)
    end
    if sent ~= os.time() then
      local message = request:new()
      message.utime, message.seq, message.run, message.layout_hash = 0, number, 0, 0
      message.command_line = line
      link:publish("WAFERHAND_REQUEST", message:encode())
      sent = os.time()
      io.stderr:write("asked\n")
    end
    link:timedhandle(0.2)
  end
  return answers[number]
end

-- Motion control remembers numbers: those of two hosts, or of a host that is started again, must differ.
local first = 0
for byte in io.open("/dev/urandom", "rb"):read(6):gmatch "." do
  first = first * 256 + byte:byte()
end
for i = 2, #arg do
  local answer = ask(first + i, arg[i])
  print(("%s -> %d %s"):format(arg[i], answer.error, answer.text))
end
if last then
  last = state.decode(last)
  print(("state of slice %d: %d wafers, the first at %.3f %.3f %.3f, sensors %d"):format(
    last.seq, last.wafer_count, last.wafers[1].position[1], last.wafers[1].position[2], last.wafers[1].position[3],
    last.sensors))
end
