-- The module `wh` as plain Lua sees it. Usage: lua5.4 tests/end_to_end/lua/wh_test.lua [build directory]

local here = arg[0]:match("^(.*)/[^/]*$") or "."
local build = arg[1] or os.getenv("WH_BUILD") or here .. "/../../../build"
package.cpath = build .. "/?.so"
package.path = here .. "/?.lua"

local harness = require "harness"
local wh = require "wh"
local test, equal, near, same = harness.test, harness.equal, harness.near, harness.same

local IDENTITY = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }

local function at(x, y, z)
  return { r = { x, y, z }, R = IDENTITY }
end

-- Turned by an angle about base's x, then moved.
local function tilted(angle, x, y, z)
  local c, s = math.cos(angle), math.sin(angle)
  return { r = { x, y, z }, R = { { 1, 0, 0 }, { 0, c, -s }, { 0, s, c } } }
end

local function open(x, y, z)
  return { pose = at(x, y, z), valve = 0 }
end

local function closed(x, y, z)
  return { pose = at(x, y, z), valve = 1 }
end

local function pair(fields)
  local config = { grippers = 2, wafers = { at(0, 0, 0), at(500, 0, 0) } }
  for name, value in pairs(fields or {}) do
    config[name] = value
  end
  return wh.cell(config)
end

test("the manual's example", function()
  local wafer, gripper, tolerance = at(0, 0, 0.25), at(0, 0, 0), "paper"
  local pose, g1, g2 = at(0, 0, 0.25), at(0, 0, 0), at(900, 0, 0)
  local p = wh.proximity(wafer, gripper, tolerance)     -- poses { r = {x,y,z}, R = {{..},{..},{..}} }; tolerance optional
  same({ p.n1_proj_n2, p.dr_proj_z, p.dr_proj_xy, p.dr_proj_xy_norm, p.ready, p.failed },
    { 1.0, 0.25, { 0, 0, 0.25 }, 0.0, true, {} })
  do
    local cell = wh.cell { grippers = 2, wafers = { pose, pose }, tolerance = { projz = 0.5, projxy = 50, planar = 0.99 },
                           check = "sampled" }
    local events = cell:step { { pose = g1, valve = 1 }, { pose = g2, valve = 0 } }   -- a list of { kind=, wafer=, gripper=, ... }
    local pose, holder = cell:wafer(1)                     -- indices from 1; holder nil or the gripper's index
    same(events, {})
    same(pose, at(0, 0, 0.25))
    equal(holder, nil)
    equal(#cell:hash(), 16)
  end
end)

test("a measurement carries every value of the equations", function()
  local p = wh.proximity(tilted(0.1, 10, 60, 2), at(4, 0, 1), { projz = 0.5, projxy = 50, planar = 0.99 })
  local c, s = math.cos(0.1), math.sin(0.1)
  same(p.dr, { 6, 60, 1 })
  near(p.n1_proj_n2, c, 1e-15)
  near(p.dr_proj_z, -60 * s + c, 1e-14)
  near(p.dr_proj_xy[1], 6, 1e-14)
  near(p.dr_proj_xy[2], 60 * c + s, 1e-13)
  near(p.dr_proj_xy[3], -60 * s + c, 1e-13)
  near(p.dr_proj_xy_norm, math.sqrt(36 + (60 * c + s) ^ 2), 1e-13)
  equal(p.ready, false)
  same(p.failed, { projz = true, projxy = true })
  near(p.margin.projz, 0.5 - (60 * s - c), 1e-14)
  near(p.margin.projxy, 50 - p.dr_proj_xy_norm, 0)
  near(p.margin.planar, c - 0.99, 1e-15)
end)

test("all three conditions are strict", function()
  local tolerance = { projz = 0.5, projxy = 50, planar = 0.99 }
  same(wh.proximity(at(0, 0, 0.5), at(0, 0, 0), tolerance).failed, { projz = true })
  same(wh.proximity(at(30, 40, 0), at(0, 0, 0), tolerance).failed, { projxy = true })
  same(wh.proximity(tilted(0.2, 0, 0, 0), at(0, 0, 0), tolerance).failed, { planar = true })
  equal(wh.proximity(at(30, 39.999, 0.4999), at(0, 0, 0), tolerance).ready, true)
end)

test("tolerances: presets, tables, what is left out", function()
  local paper = { projz = 0.5, projxy = 50.0, planar = 0.99 }
  same(wh.tolerance(), paper)
  same(wh.tolerance(nil), paper)
  same(wh.tolerance("paper"), paper)
  same(wh.tolerance("strict"), { projz = 0.5, projxy = 5.0, planar = 0.99998 })
  same(wh.tolerance { projxy = 7 }, { projz = 0.5, projxy = 7.0, planar = 0.99 })
  equal(wh.proximity(at(10, 0, 0), at(0, 0, 0)).ready, true)
  equal(wh.proximity(at(10, 0, 0), at(0, 0, 0), "strict").ready, false)
end)

test("rim gap: the centre's distance and the tilt at the radius", function()
  near(wh.rim_gap(tilted(0.1, 0, 0, 0.25), at(0, 0, 0), 150), 0.25 + 150 * math.sin(0.1), 1e-12)
  equal(wh.rim_gap(at(0, 0, 0.25), at(0, 0, 0), 0), 0.25)
end)

test("a pose without R is not turned", function()
  same(wh.proximity({ r = { 1, 2, 3 } }, { r = { 0, 0, 0 } }), wh.proximity(at(1, 2, 3), at(0, 0, 0)))
end)

test("version and catalogue", function()
  equal(wh.version:match("^%d+%.%d+%.%d+$"), wh.version)
  equal(wh.errors.OK.number, 0)
  same(wh.errors.HELD, { number = 8, text = "the wafer is held by a gripper" })
  equal(wh.errors.WAFER_MISSING.number, 42)
end)

test("pick, carry, release", function()
  local cell = pair()
  local events = cell:step { open(0, 0, -0.25), closed(900, 0, 0) }
  equal(#events, 1)
  local picked = events[1]
  same({ picked.kind, picked.slice, picked.measured_slice, picked.wafer, picked.gripper },
    { "picked", 1, 1, 1, 1 })
  same({ picked.dr_proj_z, picked.ready, picked.from, picked.holder }, { 0.25, true, nil, nil })
  same({ picked.margin.projz, picked.dr, picked.failed }, { 0.25, { 0, 0, 0.25 }, {} })
  equal(cell:held(1), 1)
  equal(cell:held(2), nil)
  same(cell:step { open(0, 0, 100), closed(900, 0, 0) }, {})
  local pose, holder = cell:wafer(1)
  same(pose, at(0, 0, 100.25))
  equal(holder, 1)
  events = cell:step { closed(0, 0, 100), closed(900, 0, 0) }
  same({ #events, events[1].kind, events[1].wafer, events[1].gripper, events[1].slice },
    { 1, "released", 1, 1, 3 })
  equal(select(2, cell:wafer(1)), nil)
  same(cell:counters(), { slices = 3, refused = 0, picked = 1, released = 1, handed_over = 0,
    near_misses = 0, contested = 0 })
end)

test("hand-over: one event that names both grippers", function()
  local cell = pair()
  cell:step { open(0, 0, 0), closed(900, 0, 0) }
  local events = cell:step { closed(0, 0, 0), open(0, 0, -0.125) }
  equal(#events, 1)
  local event = events[1]
  same({ event.kind, event.wafer, event.gripper, event.from }, { "handed_over", 1, 2, 1 })
  equal(event.dr_proj_z, 0.125)
  equal(cell:held(1), nil)
  equal(cell:held(2), 1)
  equal(select(2, cell:wafer(1)), 2)
end)

test("near miss: the closest values and when they were", function()
  local cell = pair()
  same(cell:step { open(0, 0, -3), closed(900, 0, 0) }, {})
  same(cell:step { open(0, 0, -1), closed(900, 0, 0) }, {})
  same(cell:step { open(0, 0, -2), closed(900, 0, 0) }, {})
  local events = cell:step { open(0, 0, -60), closed(900, 0, 0) }
  equal(#events, 1)
  local miss = events[1]
  same({ miss.kind, miss.wafer, miss.gripper, miss.slice, miss.measured_slice }, { "near_miss", 1, 1, 4, 2 })
  same({ miss.dr_proj_z, miss.ready, miss.failed }, { 1.0, false, { projz = true } })
end)

test("the neighbourhood follows the tolerance and can be set", function()
  local function misses(fields, x, z)
    local cell = pair(fields)
    cell:step { open(x, 0, z), closed(900, 0, 0) }
    return #cell:step { closed(x, 0, z), closed(900, 0, 0) }
  end
  same({ misses({}, 0, -4.4), misses({}, 0, -4.6), misses({}, 99, 0), misses({}, 101, 0) }, { 1, 0, 1, 0 })
  local strict = { tolerance = "strict" }
  same({ misses(strict, 9, 0), misses(strict, 11, 0) }, { 1, 0 })
  local own = { near_projz = 2, near_projxy = 120 }
  same({ misses(own, 0, -1.9), misses(own, 0, -2.1), misses(own, 119, 0) }, { 1, 0, 1 })
end)

test("contested: names who held the wafer", function()
  local cell = pair()
  cell:step { open(0, 0, 0), closed(900, 0, 0) }
  same(cell:step { open(0, 0, 0), open(0, 0, -0.25) }, {})
  local events = cell:step { open(0, 0, 0), open(0, 0, -90) }
  local event = events[1]
  same({ #events, event.kind, event.wafer, event.gripper, event.holder, event.from, event.measured_slice },
    { 1, "contested", 1, 2, 1, nil, 2 })
  equal(cell:counters().contested, 1)
end)

test("swept checking and seating are switches", function()
  local function run(fields)
    local cell = pair(fields)
    cell:step { open(0, 0, -20), closed(900, 0, 0) }
    cell:step { open(0, 0, 20), closed(900, 0, 0) }
    return cell
  end
  equal(run { check = "sampled" }:held(1), nil)
  local swept = run { check = "swept" }
  equal(swept:held(1), 1)
  near(swept:wafer(1).r[3], 20.499, 1e-12)
  near(run { check = "swept", seat = true }:wafer(1).r[3], 20, 1e-12)
end)

test("place moves a free wafer", function()
  local cell = pair()
  local before = cell:hash()
  equal(select("#", cell:place(2, at(1, 2, 3))), 0)
  same(cell:wafer(2), at(1, 2, 3))
  equal(cell:hash() ~= before, true)
  cell:place(2, { r = { 500, 0, 0 } })
  equal(cell:hash(), before)
end)

test("hash: 16 hex digits, equal for equal runs, different for different ones", function()
  local function run(z, steps)
    local cell = pair()
    for i = 1, steps do
      cell:step { open(0, 0, z), open(500, 0, -i) }
    end
    return cell:hash()
  end
  local hashes = { run(0, 0), run(0, 1), run(0, 2), run(0.1, 2), run(-0.0, 2) }
  for i, hash in ipairs(hashes) do
    equal(hash:match("^%x+$"), hash)
    equal(#hash, 16)
    for j = 1, i - 1 do
      equal(hash ~= hashes[j], true, "hashes " .. i .. " and " .. j .. " differ")
    end
  end
  equal(run(0.1, 2), hashes[4])
end)

test("whole floats are integers; sizes from none to the largest", function()
  local cell = wh.cell { grippers = 2.0, wafers = { at(0, 0, 0) } }
  cell:step { { pose = at(0, 0, 0), valve = 0.0 }, { pose = at(9, 9, 9), valve = 1.0 } }
  equal(cell:held(1.0), 1)
  equal(select(2, cell:wafer(1.0)), 1)
  equal(math.type(cell:held(1)), "integer")
  local empty = wh.cell { grippers = 8, wafers = {} }
  local inputs = {}
  for i = 1, 8 do
    inputs[i] = open(i, 0, 0)
  end
  same(empty:step(inputs), {})
end)

test("what is handed out belongs to the caller", function()
  local cell = pair()
  local hash = cell:hash()
  local pose = cell:wafer(1)
  pose.r[1], pose.R[1][1] = 77, 77
  wh.tolerance("paper").projz = 77
  equal(cell:hash(), hash)
  equal(wh.tolerance("paper").projz, 0.5)
end)

test("tables with metatables are read through them", function()
  local function through(target)
    return setmetatable({}, { __index = target, __len = function() return #target end })
  end
  local R = through { through { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }
  local pose = through { r = through { 0, 0, 0.25 }, R = R }
  equal(wh.proximity(pose, at(0, 0, 0), through { projz = 0.125 }).margin.projz, -0.125)
  local cell = wh.cell(through { grippers = 1, wafers = through { pose, pose, pose } })
  equal(cell:step(through { through { pose = at(0, 0, 0), valve = 0 } })[1].wafer, 1)
  same(cell:wafer(3), at(0, 0, 0.25))
end)

test("an input that steps the same cell while it is read", function()
  local cell, plain = pair(), pair()
  local inner = { closed(1, 1, 1), open(500, 0, 0) }
  local outer = { open(0, 0, 0), closed(500, 0, 9) }
  local sly = setmetatable({ valve = 0 }, { __index = function(_, key)
    cell:step(inner)
    return outer[1][key]
  end })
  cell:step { sly, outer[2] }
  plain:step(inner)
  plain:step(outer)
  equal(cell:hash(), plain:hash())
  same(cell:counters(), plain:counters())
end)

test("garbage: cells come and go, also half made ones", function()
  local wafers = {}
  for i = 1, 1000 do
    wafers[i] = at(60 * i, 0, 0)
  end
  local broken = table.move(wafers, 1, 999, 1, {})
  broken[1000] = { r = { 0, 0, 0 / 0 } }
  collectgarbage()
  local before = collectgarbage("count")
  for i = 1, 300 do
    local cell = wh.cell { grippers = 1, wafers = wafers }
    equal(cell:step({ open(60 * i, 0, 0) })[1].wafer, i)
    equal(pcall(wh.cell, { grippers = 1, wafers = broken }), false)
  end
  collectgarbage()
  collectgarbage()
  equal(collectgarbage("count") < before + 200, true, "memory is returned")
end)

require "wh_errors"
harness.finish()
