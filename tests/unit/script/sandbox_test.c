/* The sandbox holds: whatever a script does, it ends with a reason and a line, and the state stays usable. */
#include "support/sandbox.h"

#include "script/sandbox.h"

typedef struct {
    const char *script;
    wh_sandbox_reason_t reason;
    const char *message; /* a part of it; it begins with "case.lua" when there is one */
} case_t;

static const case_t cases[] = {
    {"local x = 1 + 1", WH_SANDBOX_OK, ""},
    /* thrown errors of every kind */
    {"\nlocal x = nil + 1", WH_SANDBOX_ERROR, "case.lua:2: attempt to perform arithmetic on a nil value"},
    {"\n\nerror('broken')", WH_SANDBOX_ERROR, "case.lua:3: broken"},
    {"\nerror('broken', 0)", WH_SANDBOX_ERROR, "case.lua:2: broken"},
    {"error()", WH_SANDBOX_ERROR, "case.lua:1: (error object is a nil value)"},
    {"error(true)", WH_SANDBOX_ERROR, "case.lua:1: (error object is a boolean value)"},
    {"error(12)", WH_SANDBOX_ERROR, "case.lua:1: 12"},
    {"error({})", WH_SANDBOX_ERROR, "case.lua:1: (error object is a table value)"},
    {"\nerror({ number = 42, message = 'wafer missing' })", WH_SANDBOX_ERROR, "case.lua:2: wafer missing"},
    {"error(setmetatable({}, { __tostring = function() return 'mine' end }))", WH_SANDBOX_ERROR,
     "case.lua:1: mine"},
    {"error(setmetatable({}, { __tostring = function() error('no') end }))", WH_SANDBOX_ERROR,
     "__tostring failed"},
    {"error(setmetatable({}, { __tostring = function() return {} end }))", WH_SANDBOX_ERROR,
     "__tostring failed"},
    {"error(setmetatable({}, { __tostring = function() while true do end end }))", WH_SANDBOX_BUDGET,
     "budget"},
    {"error('a\\0b')", WH_SANDBOX_ERROR, "case.lua:1: a\\x00b"},
    {"error(string.rep('x', 100000))", WH_SANDBOX_ERROR, "xxx..."},
    {"coroutine.wrap(function() error('inside') end)()", WH_SANDBOX_ERROR, "case.lua:1: inside"},
    {"x = = 1", WH_SANDBOX_SYNTAX, "case.lua:1: unexpected symbol"},
    {"\x1bLua", WH_SANDBOX_SYNTAX, "case.lua: attempt to load a binary chunk"},
    /* loops */
    {"\nwhile true do end", WH_SANDBOX_BUDGET, "case.lua:2: instruction budget of 1000000 spent"},
    {"::a:: goto a", WH_SANDBOX_BUDGET, "case.lua:1: instruction budget"},
    {"repeat until false", WH_SANDBOX_BUDGET, ""},
    {"while true do pcall(function() while true do end end) end", WH_SANDBOX_BUDGET, ""},
    {"while true do pcall(error) end", WH_SANDBOX_BUDGET, ""},
    {"while true do xpcall(function() while true do end end, function() while true do end end) end",
     WH_SANDBOX_BUDGET, ""},
    {"xpcall(error, function() while true do end end)", WH_SANDBOX_BUDGET, ""},
    {"while true do coroutine.wrap(function() while true do end end)() end", WH_SANDBOX_BUDGET, ""},
    {"while true do pcall(coroutine.wrap(function() while true do end end)) end", WH_SANDBOX_BUDGET, ""},
    {"while true do coroutine.resume(coroutine.create(function() end)) end", WH_SANDBOX_BUDGET, ""},
    {"local f = coroutine.wrap(function() while true do coroutine.yield() end end) while true do f() end",
     WH_SANDBOX_BUDGET, ""},
    {"local c = { __close = function() while true do end end }\n"
     "while true do pcall(function() local x <close> = setmetatable({}, c) while true do end end) end",
     WH_SANDBOX_BUDGET, ""},
    {"local c = { __close = function() while true do end end }\n"
     "local f = coroutine.wrap(function() local x <close> = setmetatable({}, c) while true do end end)\n"
     "while true do pcall(f) end",
     WH_SANDBOX_BUDGET, ""},
    {"local c = { __close = function() while true do end end }\n"
     "local e = 0.5\n"
     "local co = coroutine.create(function() local x <close> = setmetatable({}, c) local y = 2 ^ e end)\n"
     "coroutine.resume(co) coroutine.close(co)",
     WH_SANDBOX_BUDGET, ""},
    {"local c = { __close = function() while true do end end }\n"
     "local co = coroutine.create(function() local x <close> = setmetatable({}, c) coroutine.yield() end)\n"
     "coroutine.resume(co) coroutine.close(co)",
     WH_SANDBOX_BUDGET, ""},
    {"local t = setmetatable({}, { __index = function(t, k) return t[k + 1] end }) local x = t[1]",
     WH_SANDBOX_ERROR, "overflow"},
    {"local t = {} setmetatable(t, { __index = t }) local x = t[1]", WH_SANDBOX_ERROR, "loop"},
    {"for i, v in ipairs(setmetatable({}, { __index = function() return 1 end })) do end", WH_SANDBOX_BUDGET,
     ""},
    {"table.sort({ 3, 2, 1 }, function() while true do end end)", WH_SANDBOX_BUDGET, ""},
    {"string.gsub('x', 'x', function() while true do end end)", WH_SANDBOX_BUDGET, ""},
    {"while true do load('x = 2 ^ 0.5') end", WH_SANDBOX_BUDGET, ""},
    /* deep recursion */
    {"local function f() return 1 + f() end f()", WH_SANDBOX_MEMORY, "case.lua:1"},
    {"local function f() pcall(f) end f()", WH_SANDBOX_OK, ""},
    {"local function f() local ok, e = pcall(f) if not ok then error(e, 0) end end f()", WH_SANDBOX_ERROR,
     "overflow"},
    {"local function f() return (string.gsub('x', 'x', f)) end f()", WH_SANDBOX_ERROR, "C stack overflow"},
    {"local function f() return coroutine.wrap(f)() end f()", WH_SANDBOX_ERROR, "C stack overflow"},
    {"local function f() local co = coroutine.create(function()\n"
     "local x <close> = setmetatable({}, { __close = f }) coroutine.yield() end)\n"
     "coroutine.resume(co) local ok, e = coroutine.close(co) if not ok then error(e, 0) end end f()",
     WH_SANDBOX_ERROR, "C stack overflow"},
    {"local function f() error(setmetatable({}, { __tostring = f })) end f()", WH_SANDBOX_ERROR,
     "__tostring failed"},
    {"load(string.rep('(', 1000) .. '1' .. string.rep(')', 1000))()", WH_SANDBOX_ERROR, ""},
    {"local t = {} for i = 1, 1000 do t = setmetatable({}, { __eq = function() return t == {} end }) end",
     WH_SANDBOX_OK, ""},
    /* memory */
    {"local t = {}\nfor i = 1, 1e9 do t[i] = { nil, nil, nil, nil, nil, nil, nil, nil, nil, nil, nil, nil } "
     "end",
     WH_SANDBOX_MEMORY, "case.lua:2: memory cap of 16 MiB reached"},
    {"local s = 'x'\nwhile true do s = s .. s end", WH_SANDBOX_MEMORY, "case.lua:2: memory cap"},
    {"local s = ('x'):rep(1e9)", WH_SANDBOX_MEMORY, "case.lua:1: memory cap"},
    {"while true do pcall(string.rep, 'x', 1e9) end", WH_SANDBOX_MEMORY, ""},
    {"local t = {} for i = 1, 1e9 do t[i] = 'x' .. i end", WH_SANDBOX_MEMORY, ""},
    {"local t = {} while true do coroutine.wrap(function() for i = 1, 1e9 do t[i] = { i } end end)() end",
     WH_SANDBOX_MEMORY, ""},
    {"local t = {} for i = 1, 12 do t[i] = ('x'):rep(1000000) end t = nil\n"
     "for i = 1, 6 do local u = ('y'):rep(1000000) end",
     WH_SANDBOX_OK, ""},
    /* C functions that loop where no hook sees them */
    {"local s = string.rep('', 1e18)", WH_SANDBOX_OK, ""},
    {"assert(string.rep('', 1 << 60) == '') assert(string.rep('ab', 2, ',') == 'ab,ab')", WH_SANDBOX_OK, ""},
    {"string.rep('a', 40):find(string.rep('a?', 40) .. string.rep('a', 40))", WH_SANDBOX_BUDGET, ""},
    {"string.rep('a', 500):match(string.rep('.-', 30) .. 'b')", WH_SANDBOX_BUDGET, ""},
    {"for w in string.rep('a', 500):gmatch(string.rep('a*', 20) .. 'b') do end", WH_SANDBOX_BUDGET, ""},
    {"string.rep('a', 500):gsub(string.rep('a*', 20) .. 'b', '')", WH_SANDBOX_BUDGET, ""},
    {"local s = string.rep('a', 4e6) while true do s:find(string.rep('a', 1000) .. 'b', 1, true) end",
     WH_SANDBOX_BUDGET, ""},
    {"table.move({}, 1, 1 << 53, 2)", WH_SANDBOX_BUDGET, "case.lua:1: instruction budget"},
    {"table.concat({}, '', 1, math.maxinteger)", WH_SANDBOX_BUDGET, ""},
    {"table.unpack({}, 1, 1e8)", WH_SANDBOX_BUDGET, ""},
    {"table.unpack({}, 1, 1 << 60)", WH_SANDBOX_ERROR, "too many results"},
    {"table.insert(setmetatable({}, { __len = function() return 1 << 60 end }), 1, 1)", WH_SANDBOX_ERROR,
     "__len"},
    {"table.remove(setmetatable({}, { __len = function() return 1 << 60 end }), 1)", WH_SANDBOX_ERROR,
     "__len"},
    {"table.concat(setmetatable({}, { __len = function() return 1 << 60 end }))", WH_SANDBOX_ERROR, "__len"},
    {"table.unpack(setmetatable({}, { __len = function() return 1 << 60 end }))", WH_SANDBOX_ERROR, "__len"},
    {"table.sort(setmetatable({}, { __len = function() return 1 << 60 end }))", WH_SANDBOX_ERROR, "__len"},
    {"local t = {} for k = 0, 62 do t[1 << k] = 1 t[(1 << k) + 1] = 1 end t[3] = 1 table.insert(t, 1, 1)",
     WH_SANDBOX_BUDGET, ""},
    {"local t = {} for i = 1, 2e5 do t[i] = i end for i = 1, 2e5 do t[i] = nil end while true do next(t) end",
     WH_SANDBOX_BUDGET, ""},
    {"local s = ('\\x80'):rep(1e6) local f = utf8.codes(s) while true do pcall(f, s, 1) end",
     WH_SANDBOX_BUDGET, ""},
    {"local s = ('a'):rep(1e6) while true do utf8.len(s) end", WH_SANDBOX_BUDGET, ""},
    {"local s = ('1'):rep(1e6) while true do local x = tonumber(s) end", WH_SANDBOX_BUDGET, ""},
    {"local s = ('1'):rep(1e6) while true do local x = s + 0 end", WH_SANDBOX_BUDGET, ""},
    /* ways out that are not there */
    {"for _, name in ipairs { 'os', 'io', 'debug', 'package', 'dofile', 'loadfile', 'collectgarbage', 'warn' "
     "} do\n"
     "  assert(rawget(_G, name) == nil)\n"
     "  local ok, why = pcall(function() return _G[name] end)\n"
     "  assert(not ok and why:find('case.lua:3: ' .. name .. ': not in the sandbox (', 1, true))\n"
     "end for _, name in ipairs { 'exp', 'log', 'log10', 'pow', 'frexp', 'ldexp', 'sinh', 'cosh', 'tanh' } "
     "do\n"
     "  local ok, why = pcall(function() return math[name](1) end)\n"
     "  assert(not ok and why:find('case.lua:6: math.' .. name .. ': not in the sandbox (', 1, true))\n"
     "end assert(not rawget(string, 'dump') and not rawget(math, 'exp') and math.unknown == nil)",
     WH_SANDBOX_OK, ""},
    {"require 'math\\0x'", WH_SANDBOX_ERROR, "case.lua:1: require: \"math\\x00x\": not in the sandbox"},
    {"error('red\\0x\\27')", WH_SANDBOX_ERROR, "case.lua:1: red\\x00x\\x1B"},
    {"require 'socket'", WH_SANDBOX_ERROR,
     "case.lua:1: require: \"socket\": not in the sandbox (expected NAME.lua beside"},
    {"assert(require 'math' == math)", WH_SANDBOX_OK, ""},
    /* globals that nobody defined */
    {"\nreturn { collision = True }", WH_SANDBOX_ERROR,
     "case.lua:2: True: nobody defined this global (did you mean true?)"},
    {"height = 5 local x = heigth", WH_SANDBOX_ERROR,
     "heigth: nobody defined this global (did you mean height?)"},
    {"local f = function() return qqq end pcall(f) f()", WH_SANDBOX_ERROR,
     "qqq: nobody defined this global (rawget"},
    {"coroutine.wrap(function() return qqq end)()", WH_SANDBOX_ERROR, "qqq: nobody"},
    {"load('return qqq', '=inner')()", WH_SANDBOX_ERROR, "inner:1: qqq: nobody"},
    {"assert(rawget(_G, 'qqq') == nil and params.qqq == nil and _G[1] == nil) qqq = nil", WH_SANDBOX_OK, ""},
    {"setmetatable(_G, { __index = function() return 5 end }) assert(qqq == 5)", WH_SANDBOX_OK, ""},
    {"x = 1 for name in pairs(_G) do x = nil end for name in next, {} do end", WH_SANDBOX_OK, ""},
    {"load(function() return nil end)", WH_SANDBOX_ERROR, "'load' takes a string"},
    {"assert(load('\\27Lua', 'x', 'b'))", WH_SANDBOX_ERROR, "attempt to load a binary chunk"},
    {"assert(load('return 1', 'x', 'b'))", WH_SANDBOX_ERROR, "attempt to load a text chunk"},
    {"assert(load('return y', 'x', 't', { y = 5 })() == 5)", WH_SANDBOX_OK, ""},
    {"setmetatable({}, { __gc = function() while true do end end })", WH_SANDBOX_ERROR, "__gc"},
    {"setmetatable({}, { __gc = false })", WH_SANDBOX_ERROR, "__gc"},
    {"getmetatable('').__index = nil", WH_SANDBOX_ERROR, "index a boolean value"},
    {"assert(getmetatable('') == false and getmetatable(1) == nil)", WH_SANDBOX_OK, ""},
    {"print(string.format('%p', {}))", WH_SANDBOX_ERROR, "'%p' is refused"},
    {"print(string.format('%-5p', {}))", WH_SANDBOX_ERROR, "'%p' is refused"},
    {"math.randomseed()", WH_SANDBOX_ERROR, "a seed is needed"},
    {"math.sin(1e6)", WH_SANDBOX_ERROR, "number from -100000.0 to 100000.0 expected"},
    {"math.asin(1.5)", WH_SANDBOX_ERROR, "number from -1.0 to 1.0 expected"},
    /* '^' */
    {"local e = 0.5\nlocal a = 1\nlocal x = 2 ^ e\nlocal b = 2", WH_SANDBOX_ERROR,
     "case.lua:3: '^' needs a whole-number exponent; got 0.5"},
    {"\nlocal x = 2 ^ 0.5\n\nlocal y = 1", WH_SANDBOX_ERROR,
     "case.lua:2: '^' needs a whole-number exponent; got 0.5"},
    {"\nreturn 4 ^ .5", WH_SANDBOX_ERROR, "case.lua:2: '^' needs a whole-number exponent; got 0.5"},
    {"\nlocal x = '2' ^ 0.5", WH_SANDBOX_ERROR, "case.lua:2: '^' needs a whole-number exponent; got 0.5"},
    {"local x = 2 ^ math.huge", WH_SANDBOX_ERROR, "'^' needs"},
    {"local e = 0.5\ncoroutine.wrap(function()\nlocal x = 2 ^ e end)()", WH_SANDBOX_ERROR,
     "case.lua:3: '^' needs"},
    {"local e = 0.5 local ok, why = pcall(function() return 2 ^ e end) assert(not ok and why:find('whole'))",
     WH_SANDBOX_OK, ""},
    {"if false then local x = 2 ^ 0.5 end", WH_SANDBOX_OK, ""},
    {"load('return 2 ^ 0.5', '=inner')()", WH_SANDBOX_ERROR, "inner:1: '^' needs"},
    {"assert(2 ^ 10 == 1024 and 2 ^ -2 == 0.25 and (-3) ^ 3 == -27 and 10 ^ -3 == 1e-3 and '2' ^ 3 == 8)\n"
     "local z, n = 0, -1074 assert(z ^ 0 == 1 and 2 ^ n == 0x1p-1074 and 1 / z ^ 5 == math.huge)\n"
     "local h = 1e300 assert(2 ^ h == math.huge and 0.5 ^ h == 0 and 1 ^ h == 1 and 2 ^ -h == 0)",
     WH_SANDBOX_OK, ""},
};

static bool ended_as_told(const case_t *c) {
    wh_sandbox_result_t result;
    wh_sandbox_t *const sandbox = new_with(c->reason == WH_SANDBOX_MEMORY ? 5000000 : 1000000);
    const bool ok = evaluate(sandbox, c->script, &result);
    const bool as_told = result.status == c->reason && ok == (c->reason == WH_SANDBOX_OK) &&
                         strstr(result.message, c->message) != NULL &&
                         (ok || strncmp(result.message, "case.lua", 8) == 0);
    if (!as_told) {
        print_error("%s\n  ended with %d, \"%s\", not %d, \"%s\"\n", c->script, (int)result.status,
                    result.message, (int)c->reason, c->message);
    }
    lua_settop(wh_sandbox_state(sandbox), 0);
    assert_usable(sandbox);
    assert_true(wh_sandbox_memory_high_water(sandbox) <= (size_t)16 << 20);
    wh_sandbox_free(sandbox);
    return as_told;
}

static void scripts_end_with_reason_and_line(void **state) {
    (void)state;
    int failed = 0;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        failed += !ended_as_told(&cases[i]);
    }
    assert_int_equal(failed, 0);
}

/* The same, with all of them in one sandbox one after the other. */
static void one_sandbox_survives_them_all(void **state) {
    (void)state;
    wh_sandbox_result_t result;
    wh_sandbox_t *const sandbox = new_small();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        (void)evaluate(sandbox, cases[i].script, &result);
        lua_settop(wh_sandbox_state(sandbox), 0);
        assert_usable(sandbox);
    }
    wh_sandbox_free(sandbox);
}

static void a_runaway_recursion_ends(void **state) {
    (void)state;
    wh_sandbox_result_t result;
    wh_sandbox_t *const sandbox = wh_sandbox_new(NULL);
    assert_false(evaluate(sandbox, "local function f() return 1 + f() end f()", &result));
    assert_int_equal(result.status, WH_SANDBOX_ERROR);
    assert_non_null(strstr(result.message, "case.lua:1: stack overflow"));
    assert_usable(sandbox);
    wh_sandbox_free(sandbox);
}

static void too_little_memory_is_no_sandbox(void **state) {
    (void)state;
    for (size_t bytes = 1000; bytes < 100000; bytes += 1000) {
        const wh_sandbox_limits_t limits = {.memory_bytes = bytes};
        wh_sandbox_free(wh_sandbox_new(&limits)); /* null or not: no crash, no leak */
    }
}

/* Runs out of memory at every possible place of a script that does a bit of all. */
static void memory_may_end_anywhere(void **state) {
    (void)state;
    static const char script[] =
        "local t = {} for i = 1, 50 do t['k' .. i] = { i } end\n"
        "for k, v in pairs(t) do t[k] = pcall(string.format, '%s', v) end\n"
        "local s = ('ab'):rep(200):gsub('a', function(a) return a .. #t end)\n"
        "local co = coroutine.wrap(function() coroutine.yield(load('return 1')()) end) co()\n"
        "table.sort({ 3, 1, 2 }) error({ message = s })";
    for (size_t bytes = 60000; bytes < 140000; bytes += 200) {
        const wh_sandbox_limits_t limits = {.memory_bytes = bytes};
        wh_sandbox_t *const sandbox = wh_sandbox_new(&limits);
        if (sandbox != NULL) {
            wh_sandbox_result_t result;
            assert_false(evaluate(sandbox, script, &result));
            assert_true(result.status == WH_SANDBOX_MEMORY || result.status == WH_SANDBOX_ERROR);
            wh_sandbox_free(sandbox);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scripts_end_with_reason_and_line), cmocka_unit_test(one_sandbox_survives_them_all),
        cmocka_unit_test(a_runaway_recursion_ends),         cmocka_unit_test(too_little_memory_is_no_sandbox),
        cmocka_unit_test(memory_may_end_anywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
