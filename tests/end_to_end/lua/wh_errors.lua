-- What the module `wh` refuses, and the words that it finds. Run by wh_test.lua.

local harness = require "harness"
local wh = require "wh"
local test, equal, same, raises = harness.test, harness.equal, harness.same, harness.raises

local function at(x, y, z)
  return { r = { x, y, z } }
end

local function rotation(...)
  local n = { ... }
  return { r = { 0, 0, 0 }, R = { { n[1], n[2], n[3] }, { n[4], n[5], n[6] }, { n[7], n[8], n[9] } } }
end

local HERE = at(0, 0, 0)
local NOT_ROTATION = "a matrix is no rotation (not orthonormal, or it mirrors) [3]"

local function new_cell()
  return wh.cell { grippers = 2, wafers = { HERE, at(500, 0, 0) } }
end

-- Calls and messages: "bad argument #<argument> to '<name>' (<message>)".
local function refused(argument, name, message, call)
  raises(("bad argument #%d to '%s' (%s)"):format(argument, name, message), call)
end

test("poses that are none", function()
  local cases = {
    { nil, "wafer: table expected, got nil" },
    { 7, "wafer: table expected, got number" },
    { {}, "wafer.r: table expected, got nil" },
    { { r = { 1, 2 } }, "wafer.r[3]: number expected, got nil" },
    { { r = { 1, "2", 3 } }, "wafer.r[2]: number expected, got string" },
    { { r = { 1, 2, 3, 4 } }, "wafer.r[4]: no such entry (expected a list of 3)" },
    { { r = { 1, 2, 3, x = 1 } }, "wafer.r.x: no such entry (expected a list of 3)" },
    { { r = { 0, 0, 0 }, q = {} }, "wafer.q: no such field (expected r, R)" },
    { { r = { 0, 0, 0 }, [1] = {} }, "wafer[1]: no such field (expected r, R)" },
    { { r = { 0, 0, 0 }, [true] = 1 }, "wafer.(a boolean as key): no such field (expected r, R)" },
    { { r = { 0, 0, 0 }, R = 1 }, "wafer.R: table expected, got number" },
    { { r = { 0, 0, 0 }, R = { { 1, 0, 0 } } }, "wafer.R[2]: table expected, got nil" },
    { rotation(1, 0, 0, 0, 1, nil, 0, 0, 1), "wafer.R[2][3]: number expected, got nil" },
    { rotation(1, 0, 0, 0, 1, 0, 0, 0, -1), "wafer: " .. NOT_ROTATION },
    { rotation(1, 0, 0, 0, 1, 0, 0, 0, 1.00001), "wafer: " .. NOT_ROTATION },
    { at(0, 1 / 0, 0), "wafer.r[2]: inf (a number is NaN or infinite) [2]" },
    { rotation(1, 0, 0, 0, 1, 0, 0, -1 / 0, 1), "wafer.R[3][2]: -inf (a number is NaN or infinite) [2]" },
  }
  for i = 1, #cases do
    refused(1, "proximity", cases[i][2], function() wh.proximity(cases[i][1], HERE) end)
    refused(1, "rim_gap", cases[i][2], function() wh.rim_gap(cases[i][1], HERE, 150) end)
    local second = cases[i][2]:gsub("^wafer", "gripper")
    refused(2, "proximity", second, function() wh.proximity(HERE, cases[i][1]) end)
  end
  local ok, message = pcall(wh.proximity, at(0, 0 / 0, 0), HERE)
  equal(ok, false)
  equal(message:find("(wafer.r[2]: ", 1, true) ~= nil and message:find("nan (a number", 1, true) ~= nil, true)
end)

test("arguments that are missing", function()
  refused(1, "proximity", "wafer: table expected, got nil", function() wh.proximity() end)
  refused(2, "proximity", "gripper: table expected, got nil", function() wh.proximity(HERE) end)
  refused(3, "rim_gap", "radius: number expected, got nil", function() wh.rim_gap(HERE, HERE) end)
  refused(1, "cell", "table expected, got nil", function() wh.cell() end)
  refused(1, "cell", "table expected, got string", function() wh.cell("x") end)
  refused(1, "step", "inputs: table expected, got nil", function() new_cell():step() end)
  refused(1, "wafer", "wafer: number expected, got nil", function() new_cell():wafer() end)
  refused(1, "held", "gripper: number expected, got nil", function() new_cell():held() end)
  refused(2, "place", "pose: table expected, got nil", function() new_cell():place(1) end)
end)

test("radius", function()
  local expected = " (expected a finite number, 0 or more)"
  refused(3, "rim_gap", "radius: -1.0" .. expected, function() wh.rim_gap(HERE, HERE, -1) end)
  refused(3, "rim_gap", "radius: inf" .. expected, function() wh.rim_gap(HERE, HERE, 1 / 0) end)
end)

test("tolerances that are none", function()
  local range = " (expected projz in (0, 1e6], projxy in [1e-6, 1e6], planar in [0, 1)) [6]"
  local cases = {
    { { projyz = 1 }, "tolerance.projyz: no such field (expected projz, projxy, planar)" },
    { { a = 1, b = 1, c = 1, d = 1 }, "tolerance.a: no such field (expected projz, projxy, planar)" },
    { { projz = "1" }, "tolerance.projz: number expected, got string" },
    { { projz = 0 }, "tolerance: projz 0.0, projxy 50.0, planar 0.99" .. range },
    { { planar = 1 }, "tolerance: projz 0.5, projxy 50.0, planar 1.0" .. range },
    { "loose", 'tolerance: "loose" (expected "paper", "strict" or a table)' },
    { 0.5, "tolerance: table or a preset's name expected, got number" },
    { false, "tolerance: table or a preset's name expected, got boolean" },
  }
  for _, case in ipairs(cases) do
    refused(3, "proximity", case[2], function() wh.proximity(HERE, HERE, case[1]) end)
    refused(1, "tolerance", case[2], function() wh.tolerance(case[1]) end)
    refused(1, "cell", case[2], function() wh.cell { grippers = 1, wafers = {}, tolerance = case[1] } end)
  end
end)

test("cells that cannot be", function()
  local fields = "grippers, wafers, tolerance, check, seat, near_projz, near_projxy"
  local near_range = " (expected both in (0, 1e6]): a tolerance is out of its range [6]"
  local many = setmetatable({}, { __len = function() return 1000001 end })
  local cases = {
    { { wafer = {} }, "wafer: no such field (expected " .. fields .. ")" },
    { { [1] = HERE }, "[1]: no such field (expected " .. fields .. ")" },
    { { grippers = 0 }, "grippers: 0 (expected 1 to 8)" },
    { { grippers = 9 }, "grippers: 9 (expected 1 to 8)" },
    { { grippers = 1.5 }, "grippers: 1.5 (expected 1 to 8)" },
    { { grippers = 1e300 }, "grippers: 1e+300 (expected 1 to 8)" },
    { { grippers = "2" }, "grippers: number expected, got string" },
    { { wafers = 3 }, "wafers: table expected, got number" },
    { { wafers = { HERE, 5 } }, "wafers[2]: table expected, got number" },
    { { wafers = { HERE, [3] = HERE } }, "wafers[3]: no such entry (expected a list of 1)" },
    { { wafers = { HERE, rotation(2, 0, 0, 0, 1, 0, 0, 0, 1) } }, "wafers[2]: " .. NOT_ROTATION },
    { { wafers = { { r = { 0, 0, 1 / 0 } } } }, "wafers[1].r[3]: inf (a number is NaN or infinite) [2]" },
    { { wafers = many }, "wafers: 1000001 entries (expected 0 to 1000000)" },
    { { check = "literal" }, 'check: "literal" (expected "sampled" or "swept")' },
    { { check = 1 }, "check: string expected, got number" },
    { { seat = 1 }, "seat: boolean expected, got number" },
    { { near_projz = true }, "near_projz: number expected, got boolean" },
    { { near_projz = 0 }, "near_projz 0.0, near_projxy 100.0" .. near_range },
    { { near_projxy = 2e6 }, "near_projz 4.5, near_projxy 2000000.0" .. near_range },
  }
  for _, case in ipairs(cases) do
    local config = { grippers = 1, wafers = {} }
    for key, value in pairs(case[1]) do
      config[key] = value
    end
    refused(1, "cell", case[2], function() wh.cell(config) end)
  end
  refused(1, "cell", "grippers: number expected, got nil", function() wh.cell { wafers = {} } end)
  refused(1, "cell", "wafers: table expected, got nil", function() wh.cell { grippers = 1 } end)
end)

test("steps that are refused change nothing and are counted", function()
  local good = { pose = HERE, valve = 0 }
  local two = "2 (expected 0, open, or 1, closed)"
  local cases = {
    { {}, "inputs[1]: table expected, got nil" },
    { { good }, "inputs[2]: table expected, got nil" },
    { { good, good, good }, "inputs[3]: no such entry (expected a list of 2)" },
    { { good, good, speed = 1 }, "inputs.speed: no such entry (expected a list of 2)" },
    { { good, { pose = HERE } }, "inputs[2].valve: number expected, got nil" },
    { { good, { pose = HERE, valve = 2 } }, "inputs[2].valve: " .. two },
    { { good, { pose = HERE, valve = 0.5 } }, "inputs[2].valve: 0.5 (expected 0, open, or 1, closed)" },
    { { good, { pose = HERE, valve = true } }, "inputs[2].valve: number expected, got boolean" },
    { { good, { valve = 0 } }, "inputs[2].pose: table expected, got nil" },
    { { good, { pose = HERE, valve = 0, v = 0 } }, "inputs[2].v: no such field (expected pose, valve)" },
    { { { pose = rotation(0, 0, 0, 0, 0, 0, 0, 0, 0), valve = 0 }, good },
      "inputs[1].pose: " .. NOT_ROTATION },
    { { good, { pose = at(0, 0, 1 / 0), valve = 0 } },
      "inputs[2].pose.r[3]: inf (a number is NaN or infinite) [2]" },
  }
  local cell = new_cell()
  cell:step { { pose = at(3, 0, 0), valve = 0 }, { pose = at(500, 0, 2), valve = 0 } }
  local hash = cell:hash()
  for i, case in ipairs(cases) do
    refused(1, "step", case[2], function() cell:step(case[1]) end)
    equal(cell:hash(), hash, "hash after " .. case[2])
    equal(cell:counters().refused, i, "refused")
  end
  equal(cell:counters().slices, 1)
  equal(cell:held(1), 1)
end)

test("place, wafer and held refuse", function()
  local cell = new_cell()
  cell:step { { pose = HERE, valve = 0 }, { pose = HERE, valve = 1 } }
  local hash = cell:hash()
  refused(1, "place", "wafer: 1 (the wafer is held by a gripper) [8]", function() cell:place(1, HERE) end)
  refused(1, "place", "wafer: 3 (expected 1 to 2)", function() cell:place(3, HERE) end)
  refused(2, "place", "pose: " .. NOT_ROTATION, function()
    cell:place(2, rotation(1, 0, 0, 0, 1, 0, 0, 0, -1))
  end)
  refused(2, "place", "pose.r[1]: inf (a number is NaN or infinite) [2]", function()
    cell:place(2, at(1 / 0, 0, 0))
  end)
  equal(cell:hash(), hash)
  equal(cell:counters().refused, 4)
  for _, index in ipairs { 0, 3, -1, 1.5, math.mininteger, math.maxinteger } do
    refused(1, "wafer", ("wafer: %s (expected 1 to 2)"):format(index), function() cell:wafer(index) end)
    refused(1, "held", ("gripper: %s (expected 1 to 2)"):format(index), function() cell:held(index) end)
  end
  refused(1, "wafer", "wafer: number expected, got string", function() cell:wafer("1") end)
  equal(cell:counters().refused, 4)
end)

test("methods of something else", function()
  local cell = new_cell()
  for _, name in ipairs { "step", "wafer", "held", "place", "hash", "counters" } do
    local method = cell[name]
    for _, other in ipairs { 1, "x", {}, io.stdout, print } do
      local ok, message = pcall(method, other, 1, HERE)
      equal(ok, false)
      equal(message:match("bad argument #1 to '.-' %(wh%.cell expected, got .+%)") ~= nil, true, message)
    end
    equal(pcall(method), false)
  end
  refused(1, "step", "wh.cell expected, got table", function() cell.step({}) end)
end)

test("a script cannot reach the methods of everyone's cells", function()
  equal(getmetatable(new_cell()), "wh.cell")
  equal(pcall(setmetatable, new_cell(), {}), false)
  equal(pcall(function() new_cell().step = print end), false)
end)

test("an error from within an input passes through and changes nothing", function()
  local cell = new_cell()
  local hash = cell:hash()
  local thrown = {}
  local trap = setmetatable({}, { __index = function() error(thrown) end })
  local ok, found = pcall(cell.step, cell, { trap, trap })
  same({ ok, found == thrown, cell:hash() == hash, cell:counters().refused }, { false, true, true, 1 })
end)
