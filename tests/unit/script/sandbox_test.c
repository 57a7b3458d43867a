/* The sandbox holds: whatever a script does, it ends with a reason and a line, and the state stays usable. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <ctype.h>
#include <lauxlib.h>
#include <lualib.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "script/sandbox.h"
#include "support/sandbox.h"

typedef struct {
    const char *script;
    wh_sandbox_reason_t reason;
    const char *message; /* a part of it; it begins with "case.lua" if there is one */
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
    /* ways out that do not exist */
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

/* These cases run one after the other in one sandbox, too. */
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
    for (size_t bytes = 1000; bytes < 100000; bytes += 1000 * WH_TEST_SHARE) {
        const wh_sandbox_limits_t limits = {.memory_bytes = bytes};
        wh_sandbox_free(wh_sandbox_new(&limits)); /* null or not: no crash, no leak */
    }
}

/* Memory ends at every possible place of a script that does a bit of everything. */
static void memory_may_end_anywhere(void **state) {
    (void)state;
    static const char script[] =
        "local t = {} for i = 1, 50 do t['k' .. i] = { i } end\n"
        "for k, v in pairs(t) do t[k] = pcall(string.format, '%s', v) end\n"
        "local s = ('ab'):rep(200):gsub('a', function(a) return a .. #t end)\n"
        "local co = coroutine.wrap(function() coroutine.yield(load('return 1')()) end) co()\n"
        "table.sort({ 3, 1, 2 }) error({ message = s })";
    for (size_t bytes = 60000; bytes < 140000; bytes += 200 * WH_TEST_SHARE) {
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

/* ------------------------------------------------------------------------------------------ the host's side */

/* The host's side of the sandbox: files, layouts, charges, parameters, and the state after a script
 * has ended. */

/* ---- Files ---- */

static char folder[WH_TEST_PATH];

static const char *file_with(const char *name, const char *text, size_t size) {
    static char path[WH_TEST_PATH + 120];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *const file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, size, file), size);
    fclose(file);
    return path;
}

static const char *text_file(const char *name, const char *text) {
    return file_with(name, text, strlen(text));
}

static void assert_run(const char *path, wh_sandbox_reason_t reason, const char *part) {
    wh_sandbox_result_t result;
    wh_sandbox_t *const sandbox = new_small();
    (void)wh_sandbox_evaluate(wh_sandbox_state(sandbox), path, &result);
    if (result.status != reason || strstr(result.message, part) == NULL ||
        (reason != WH_SANDBOX_OK && strncmp(result.message, path, strlen(path)) != 0)) {
        fail_msg("%s ended with %d, \"%s\"", path, (int)result.status, result.message);
    }
    wh_sandbox_free(sandbox);
}

static void files_are_read_or_refused(void **state) {
    (void)state;
    assert_run(file_with("ok.lua", "\xEF\xBB\xBF# first\nassert(true)", 23), WH_SANDBOX_OK, "");
    assert_run(file_with("program.lua", "#!/usr/bin/waferhand\nassert(1 == 1)", 35), WH_SANDBOX_OK, "");
    assert_run(file_with("throws.lua", "\nerror('x')", 11), WH_SANDBOX_ERROR, "throws.lua:2: x");
    assert_run(file_with("binary.lua", "\x1bLua\0\0", 6), WH_SANDBOX_SYNTAX, "binary chunk");
    assert_run(file_with("a_name_that_is_longer_than_lua_itself_would_ever_show_in_a_message_of_its_own.lua",
                         "\n\nlocal x = nil + 1", 19),
               WH_SANDBOX_ERROR, "of_its_own.lua:3: attempt");
    assert_run("/nowhere/at/all.lua", WH_SANDBOX_UNREADABLE, "No such file");
    assert_run(folder, WH_SANDBOX_UNREADABLE, "directory");
    assert_run("/dev/zero", WH_SANDBOX_UNREADABLE, "no regular file");
    char fifo[WH_TEST_PATH + 20];
    snprintf(fifo, sizeof fifo, "%s/fifo", folder);
    assert_int_equal(mkfifo(fifo, 0600), 0);
    assert_run(fifo, WH_SANDBOX_UNREADABLE, "no regular file");
    const char *const large = file_with("large.lua", "", 0);
    assert_int_equal(truncate(large, (off_t)WH_SANDBOX_FILE_BYTES + 1), 0);
    assert_run(large, WH_SANDBOX_UNREADABLE, "larger than 16 MiB");
}

/* ---- The host's side ---- */

static int host_layout(lua_State *L) {
    wh_sandbox_result_t result;
    if (!wh_sandbox_evaluate(L, luaL_checkstring(L, 1), &result)) {
        return luaL_error(L, "%s", result.message);
    }
    return 1;
}

static int host_slices(lua_State *L) {
    wh_sandbox_charge(L, (uint64_t)luaL_checkinteger(L, 1));
    return 0;
}

static wh_sandbox_t *new_with_host(void) {
    wh_sandbox_t *const sandbox = new_small();
    lua_register(wh_sandbox_state(sandbox), "layout", host_layout);
    lua_register(wh_sandbox_state(sandbox), "slices", host_slices);
    return sandbox;
}

static void assert_ends(const char *script, wh_sandbox_reason_t reason, const char *part) {
    wh_sandbox_result_t result;
    wh_sandbox_t *const sandbox = new_with_host();
    (void)evaluate(sandbox, script, &result);
    if (result.status != reason || strstr(result.message, part) == NULL) {
        fail_msg("%s\n  ended with %d, \"%s\"", script, (int)result.status, result.message);
    }
    wh_sandbox_free(sandbox);
}

static void layouts_are_evaluated_within_scripts(void **state) {
    (void)state;
    char script[400];
    snprintf(script, sizeof script, "assert(layout('%s').slots == 25)",
             text_file("layout.lua", "return { slots = 25 }"));
    assert_ends(script, WH_SANDBOX_OK, "");
    snprintf(script, sizeof script, "\npcall(layout, '%s')\n x()",
             text_file("endless.lua", "\nwhile true do end"));
    assert_ends(script, WH_SANDBOX_BUDGET, "endless.lua:2: instruction budget");
    snprintf(script, sizeof script, "layout('%s')",
             text_file("greedy.lua", "local t = {}\nfor i = 1, 1e9 do t[i] = { i } end"));
    assert_ends(script, WH_SANDBOX_MEMORY, "greedy.lua:2: memory cap");
    snprintf(script, sizeof script, "layout('%s')", text_file("wrong.lua", "\nreturn 1 + nil"));
    assert_ends(script, WH_SANDBOX_ERROR, "wrong.lua:2: attempt");
}

/* The contents of a file that is no Lua: a script learns nothing of them. */
static void other_files_are_not_quoted(void **state) {
    (void)state;
    static const char *const texts[] = {
        "secret:x:1\n",         "\n= secret\n",      "'secret",
        "goto secret",          "return 3secret",    "\x1bLua secret",
        "local x <secret> = 1", "return '\\secret'", "x = { secret = 1 secret }"};
    char script[400];
    for (size_t i = 0; i < sizeof texts / sizeof *texts; ++i) {
        const char *file = text_file("other.lua", texts[i]);
        wh_sandbox_result_t result;
        wh_sandbox_t *const sandbox = new_with_host();
        snprintf(script, sizeof script, "local ok, why = pcall(layout, '%s') assert(not ok) error(why, 0)",
                 file);
        assert_false(evaluate(sandbox, script, &result));
        if (strstr(result.message, "secret") || !strstr(result.message, "other.lua")) {
            fail_msg("%s: %s", texts[i], result.message);
        }
        assert_false(wh_sandbox_evaluate(wh_sandbox_state(sandbox), file, &result));
        assert_true(i != 4 || strstr(result.message, "near '3s'")); /* its owner reads Lua's message */
        wh_sandbox_free(sandbox);
    }
}

static void a_key_that_stands_twice_is_found(void **state) {
    (void)state;
    static const struct {
        const char *text, *message;
    } cases_of[] = {
        {"return { a = 1,\n b = 2, a = 3 }",
         "2: a: given twice in one table (expected once; it stands in line 1, too)"},
        {"return { { x = 1 }, { x = 1; ['x'] = 2 } }", "1: x: given twice"},
        {"return { [2] = 1, 'one', 'two' }", "1: [2]: given twice"},
        {"return { [1.0] = 1, [0x1] = 2 }", "1: [1]: given twice"},
        {"return { a = function(...) local t = { b = 1, 2 } if t then a = 5 end return t end,\n\n a = 5 }",
         "3: a: given twice"},
        {"return { a = [[ a = 1, ]], b = ']', --[==[ a = 2 ]==] c = \"\\\"a = \", -- a = 3\n a = 4 }",
         "2: a: given twice"},
        {"return { a = { a = 1 }, b = (function() repeat local a = 1 until a == 1 for a = 1, 2 do end "
         "end)(), "
         "[{}] = 1, [{}] = 2, ['b' .. 'c'] = 1, ['b' .. 'c'] = 2, a == 1, a == 1, -5, [-1] = 1, 1e-3, "
         "['\\65'] = 1, A = 2 }",
         NULL},
        {"local a, b = 1, 2 a = 3 b = 4 a = 5 f = { a, b, a, b; a } g = f { a = 1 } h = f { a = 2 }",
         "attempt to call"},
    };
    for (size_t i = 0; i < sizeof cases_of / sizeof *cases_of; ++i) {
        wh_sandbox_result_t result;
        wh_sandbox_t *const sandbox = new_small();
        lua_pushinteger(wh_sandbox_state(sandbox), 1);
        lua_setglobal(wh_sandbox_state(sandbox), "a");
        const char *file = text_file("twice.lua", cases_of[i].text);
        const bool ran = wh_sandbox_evaluate(wh_sandbox_state(sandbox), file, &result);
        if (ran != !cases_of[i].message || (!ran && !strstr(result.message, cases_of[i].message))) {
            fail_msg("%s: %s", cases_of[i].text, result.message);
        }
        wh_sandbox_free(sandbox);
    }
}

static void modules_stand_beside_their_file(void **state) {
    (void)state;
    char module_folder[WH_TEST_PATH + 20];
    wh_sandbox_result_t result;
    snprintf(module_folder, sizeof module_folder, "%s/parts", folder);
    assert_int_equal(mkdir(module_folder, 0700), 0);
    (void)text_file("parts/inner.lua", "return { height = 5 }");
    (void)text_file("outer.lua", "count = (rawget(_G, 'count') or 0) + 1\nreturn require 'parts.inner'");
    (void)text_file("wrong.lua", "\nreturn heigth");
    (void)text_file("self.lua", "return require 'self'");
    const char *main =
        text_file("main.lua",
                  "assert(require 'outer'.height == 5 and require('outer') == require 'outer')\n"
                  "assert(count == 1) local ok, why = pcall(require, 'wrong')\n"
                  "assert(not ok and why:find('wrong.lua:2: heigth: nobody'), why)\n"
                  "ok, why = pcall(require, 'self') assert(not ok and why:find('requires itself'), why)\n"
                  "for _, name in ipairs { '../main', '/etc/passwd', '', '.', 'a..b', 'parts/inner' } do\n"
                  "  ok, why = pcall(require, name) assert(not ok and why:find('not in the sandbox'), why)\n"
                  "end");
    const wh_sandbox_limits_t trusted = {.trust = true};
    const wh_sandbox_limits_t *const both[] = {NULL, &trusted};
    for (size_t i = 0; i < 2; ++i) {
        wh_sandbox_t *const sandbox = wh_sandbox_new(both[i]);
        const bool ran = wh_sandbox_evaluate(wh_sandbox_state(sandbox), main, &result);
        if (!ran && !(i == 1 && strstr(result.message, "module '../main' not found"))) {
            fail_msg("%s", result.message);
        }
        wh_sandbox_free(sandbox);
    }
}

static void who_reads_a_parameter_is_known(void **state) {
    (void)state;
    static const struct {
        const char *script, *unread;
    } cases_of[] = {
        {"local x = params.rate, params.name", ""},
        {"local x = params.rate, params.nmae",
         "--set name: nobody read params.name (did you mean nmae? read: nmae, rate)"},
        {"", "--set name: nobody read params.name (read: none)"},
        {"params.name = 5 local x = params.rate + params.name",
         "--set name: nobody read params.name (read: rate)"},
        {"local n = 0 for k, v in pairs(params) do n = n + 1 end assert(n == 2)", ""},
        {"assert(next(params) == 'name' and rawget(params, 'rate') == 5)", ""},
        {"setmetatable(params, { __index = { z = 1 } }) assert(params.rate == 5 and params.z == 1)", ""},
        {"local p = params assert(p.rate == 5 and p.rate == 5 and p.name == 'x' and p.other == nil)", ""},
    };
    for (size_t i = 0; i < sizeof cases_of / sizeof *cases_of; ++i) {
        wh_sandbox_result_t result;
        char message[WH_SANDBOX_MESSAGE_BYTES];
        wh_sandbox_t *const sandbox = new_small();
        assert_true(wh_sandbox_set_parameter(sandbox, "rate=5", &result));
        assert_true(wh_sandbox_set_parameter(sandbox, "name=x", &result));
        if (!evaluate(sandbox, cases_of[i].script, &result)) {
            fail_msg("%s", result.message);
        }
        assert_int_equal(wh_sandbox_find_unread(sandbox, message), cases_of[i].unread[0] != '\0');
        assert_int_equal(wh_sandbox_is_unread(sandbox, "name=x"), message[0] != '\0');
        assert_string_equal(message, cases_of[i].unread);
        wh_sandbox_free(sandbox);
    }
}

static void slices_cost(void **state) {
    (void)state;
    assert_ends("slices(999000)", WH_SANDBOX_OK, "");
    assert_ends("\nslices(2000000)", WH_SANDBOX_BUDGET, "case.lua:2: instruction budget of 1000000 spent");
    assert_ends("while true do pcall(slices, 1000) end", WH_SANDBOX_BUDGET, "");
}

static void a_numbered_error_can_be_inspected(void **state) {
    (void)state;
    wh_sandbox_result_t result;
    wh_sandbox_t *const sandbox = new_small();
    lua_State *const L = wh_sandbox_state(sandbox);
    assert_false(
        evaluate(sandbox, "error(setmetatable({ number = 42, name = 'X', message = 'm' }, {}))", &result));
    wh_sandbox_push_error(L);
    lua_getfield(L, -1, "number");
    assert_int_equal(lua_tointeger(L, -1), 42);
    lua_settop(L, 0);
    assert_false(evaluate(sandbox, "error()", &result));
    wh_sandbox_push_error(L);
    assert_true(lua_isnil(L, -1));
    lua_settop(L, 0);
    wh_sandbox_free(sandbox);
}

static void a_spent_budget_stays_spent(void **state) {
    (void)state;
    wh_sandbox_result_t result;
    wh_sandbox_t *const sandbox = new_small();
    assert_false(evaluate(sandbox, "while true do end", &result));
    assert_false(evaluate(sandbox, "x = 1", &result));
    assert_int_equal(result.status, WH_SANDBOX_BUDGET);
    wh_sandbox_renew(sandbox);
    assert_int_equal(wh_sandbox_spent(sandbox), 0);
    assert_true(evaluate(sandbox, "x = 1", &result));
    wh_sandbox_free(sandbox);
}

static wh_sandbox_t *to_stop;

static int host_stop(lua_State *L) {
    (void)L;
    wh_sandbox_stop(to_stop);
    return 0;
}

static void a_stop_ends_the_script(void **state) {
    (void)state;
    wh_sandbox_result_t result;
    to_stop = new_small();
    lua_register(wh_sandbox_state(to_stop), "stop", host_stop);
    assert_false(evaluate(to_stop, "pcall(stop)\nwhile true do end", &result));
    assert_int_equal(result.status, WH_SANDBOX_STOPPED);
    lua_settop(wh_sandbox_state(to_stop), 0);
    assert_usable(to_stop);
    wh_sandbox_free(to_stop);
}

static void parameters_take_their_type(void **state) {
    (void)state;
    static const char *const good[] = {"n=0x10", "f=2.5", "t=true", "s=1e999",
                                       "e=",     "q=a=b", "w= 5",   "n2=nan"};
    static const char *const bad[] = {"",           "x",         "=1",         "1x=2",    "a b=1",
                                      "end=1",      "local x=1", "\xC3\xA4=1", "\x1B[2J", "\x1B[2J=1",
                                      "two\nlines", "n=0x10",    "t=false"};
    wh_sandbox_result_t result;
    wh_sandbox_t *const sandbox = new_small();
    for (size_t i = 0; i < sizeof good / sizeof *good; ++i) {
        assert_true(wh_sandbox_set_parameter(sandbox, good[i], &result));
    }
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        assert_false(wh_sandbox_set_parameter(sandbox, bad[i], &result));
        assert_int_not_equal(result.message[0], '\0');
        for (const char *c = result.message; *c != '\0'; ++c) {
            assert_false(iscntrl((unsigned char)*c));
        }
    }
    if (!evaluate(sandbox,
                  "local p = params assert(p.n == 16 and p.f == 2.5 and p.t == true and p.s == '1e999' and "
                  "p.e == '' and p.q == 'a=b' and p.w == ' 5' and p.n2 == 'nan')",
                  &result)) {
        fail_msg("%s", result.message);
    }
    wh_sandbox_free(sandbox);
}

static void trust_opens_the_libraries(void **state) {
    (void)state;
    wh_sandbox_result_t result;
    const wh_sandbox_limits_t limits = {.trust = true};
    wh_sandbox_t *const sandbox = wh_sandbox_new(&limits);
    assert_non_null(sandbox);
    if (!evaluate(sandbox,
                  "assert(os.time() and io.write and require and debug and collectgarbage and string.dump)\n"
                  "assert(tostring({}) == 'table') assert(not pcall(math.randomseed))",
                  &result)) {
        fail_msg("%s", result.message);
    }
    wh_sandbox_free(sandbox);
}

static int make_folder(void **state) {
    (void)state;
    return mkdtemp(wh_test_path(folder, "sandbox")) == NULL;
}

static int remove_folder(void **state) {
    char command[WH_TEST_PATH + 20];
    (void)state;
    snprintf(command, sizeof command, "rm -r '%s'", folder);
    return system(command) != 0;
}

/* ------------------------------------------------------------------------------------- the same in each run */

/* Each run of a script does the same; patterns behave as Lua's own; no text crashes the sandbox. */

static uint64_t random_state;

/* splitmix64 */
static uint64_t random_next(void) {
    uint64_t z = (random_state += UINT64_C(0x9E3779B97F4A7C15));
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
}

static size_t random_below(size_t limit) {
    return (size_t)(random_next() % limit);
}

static void random_begin(void) {
    const char *const wanted = getenv("WH_SEED");
    random_state = wanted != NULL ? strtoull(wanted, NULL, 0) : 1;
    print_message("seed %llu (WH_SEED)\n", (unsigned long long)random_state);
}

/* ---- What a script prints ---- */

/* Runs a text in a new sandbox and returns its output; the caller frees it. */
static char *printed_by(const char *script) {
    char *text = NULL;
    size_t size = 0;
    FILE *const to = open_memstream(&text, &size);
    const wh_sandbox_limits_t limits = {.instructions = 10000000, .print_to = to};
    wh_sandbox_result_t result;
    wh_sandbox_t *const sandbox = wh_sandbox_new(&limits);
    assert_non_null(sandbox);
    if (!wh_sandbox_evaluate_text(wh_sandbox_state(sandbox), "case.lua", script, strlen(script), &result)) {
        fail_msg("%s\n  %s", script, result.message);
    }
    wh_sandbox_free(sandbox);
    fclose(to);
    return text;
}

static void assert_prints(const char *script, const char *wanted) {
    char *const text = printed_by(script);
    assert_string_equal(text, wanted);
    free(text);
}

static void pairs_and_next_are_sorted(void **state) {
    (void)state;
    assert_prints(
        "local t = { b = 1, a = 2, [true] = 3, [false] = 4, [2.5] = 5, [-1] = 6, 7, 8, [1e300] = 9,\n"
        "[math.mininteger] = 10, [math.maxinteger] = 11, [-1e300] = 12, [''] = 13, ab = 14, ['a\\0'] = 15,\n"
        "['\\xff'] = 16, [0x1p63] = 17 }\n"
        "local keys = {} for k, v in pairs(t) do keys[#keys + 1] = v end\n"
        "local also = {} local k, v = next(t) while k ~= nil do also[#also + 1] = v k, v = next(t, k) end\n"
        "print(table.concat(keys, ' ')) print(table.concat(also, ' '))",
        "12 10 6 7 8 5 11 17 9 13 2 15 14 1 16 4 3\n12 10 6 7 8 5 11 17 9 13 2 15 14 1 16 4 3\n");
    assert_prints("local t = { a = 1, b = 2, c = 3 } for k in pairs(t) do t[k] = nil t.b = nil print(k) end",
                  "a\nc\n");
    assert_prints(
        "for k, v in pairs(setmetatable({}, { __pairs = function() return next, { x = 1 } end })) do\n"
        "print(k, v) end print(next({})) print(pcall(pairs, { [{}] = 1 }))",
        "x\t1\nnil\nfalse\ta table with a table for a key has no order to be read in\n");
    assert_prints(
        "local f, t = pairs { a = 1, b = 2 } print(f(t, nil)) print(f(t, 'a')) print(f(t)) print(f(t, 'a'))",
        "a\t1\nb\t2\na\t1\nb\t2\n");
}

static void texts_show_no_address(void **state) {
    (void)state;
    assert_prints("print({}, print, coroutine.create(print), nil, true, 1, 1.0, 1e100, 0/0, -(0/0), 1/0)",
                  "table\tfunction\tthread\tnil\ttrue\t1\t1.0\t1e+100\tnan\tnan\tinf\n");
    assert_prints("print(setmetatable({}, { __name = 'Station' }), setmetatable({}, { __name = 7 }))",
                  "Station\ttable\n");
    assert_prints("print(setmetatable({}, { __tostring = function() return 'mine' end }))", "mine\n");
    assert_prints(
        "print(('%s|%5s|%%|%-8s|%d|%.2f|%g|%q|%c|%x'):format({}, 'x', print, 3, 2.5, 0/0, 'a\\n', 65, 255))",
        "table|    x|%|function|3|2.50|nan|\"a\\\n\"|A|ff\n");
    assert_prints("print(pcall(string.format, '%s'), pcall(string.format, '%y', 1))",
                  "false\tfalse\tinvalid conversion '%y' to 'format'\n");
}

static void sort_is_stable(void **state) {
    (void)state;
    assert_prints(
        "local t = {} for i = 1, 500 do t[i] = { i // 1 * 7919 % 5, i } end\n"
        "table.sort(t, function(a, b) return a[1] < b[1] end)\n"
        "for i = 2, #t do assert(t[i - 1][1] < t[i][1] or t[i - 1][1] == t[i][1] and t[i - 1][2] < t[i][2]) "
        "end\n"
        "local u = { 3, 1, 2 } table.sort(u) print(table.unpack(u)) table.sort({}) table.sort { 1 }\n"
        "local w = { 'b', 'a' } table.sort(w, function() return true end) print(#w)\n"
        "print(pcall(table.sort, { 1, 'x' }))",
        "1\t2\t3\n2\nfalse\tattempt to compare string with number\n");
}

static void numbers_are_the_same_everywhere(void **state) {
    (void)state;
    assert_prints("print(('%a %a %a'):format(1.1 ^ 10, 1.1 ^ -10, 3.7 ^ 101))",
                  "0x1.4bffc0c03023dp+1 0x1.8acbdc2d2b1c5p-2 0x1.8ef25d8359a05p+190\n");
    char *const first = printed_by("for i = 1, 20 do print(math.random(), math.random(100)) end");
    assert_prints("for i = 1, 20 do print(math.random(), math.random(100)) end", first);
    assert_prints("math.randomseed(5) local a = math.random() math.randomseed(5) print(a == math.random())",
                  "true\n");
    assert_prints(
        "print(math.asin(1) * 2 == math.pi, math.acos(1), math.atan(1, -1) > 2, math.tan(0), math.cos(0))",
        "true\t0.0\ttrue\t0.0\t1.0\n");
    free(first);
}

/* The steps of a script must not depend on the hash seed or on addresses. */
static uint64_t spent_by(const char *script) {
    wh_sandbox_t *const sandbox = wh_sandbox_new(NULL);
    assert_non_null(sandbox);
    assert_true(
        wh_sandbox_evaluate_text(wh_sandbox_state(sandbox), "case.lua", script, strlen(script), NULL));
    const uint64_t spent = wh_sandbox_spent(sandbox);
    wh_sandbox_free(sandbox);
    return spent;
}

static void the_budget_is_counted_alike(void **state) {
    (void)state;
    const char *const script =
        "local t = {} for i = 1, 3000 do t['k' .. i] = tostring(i):rep(10):gsub('%d+', 'x') end\n"
        "for k, v in pairs(t) do t[k] = nil end local s = ('a'):rep(500) for i = 1, 50 do s:find('a-b') end";
    const uint64_t first = spent_by(script);
    for (int i = 0; i < 5; ++i) {
        assert_int_equal(spent_by(script), first);
    }
}

/* ---- Patterns against Lua's own ---- */

static const char compare_script[] =
    "local s, p, r = ...\n"
    "local out = {}\n"
    "local function add(...) for i = 1, select('#', ...) do out[#out + 1] = tostring((select(i, ...))) end "
    "end\n"
    "add(pcall(string.find, s, p)) add(pcall(string.match, s, p, 2)) add(pcall(string.find, s, p, -3))\n"
    "add(pcall(string.gsub, s, p, r)) add(pcall(string.gsub, s, p, function(a, b) return b end))\n"
    "add(pcall(string.gsub, s, p, { a = 'x', b = false, ab = 1 }, 2)) add(pcall(string.find, s, p, 1, "
    "true))\n"
    "add(pcall(function() local n = 0 for a, b in string.gmatch(s, p) do add(a, b) n = n + 1 if n > 9 then "
    "break end "
    "end end))\n"
    "return table.concat(out, '|')";

/* Random text over an alphabet that often gives valid patterns. */
static void random_text(char *text, size_t limit, const char *alphabet) {
    const size_t length = random_below(limit);
    for (size_t i = 0; i < length; ++i) {
        text[i] = alphabet[random_below(strlen(alphabet))];
    }
    text[length] = '\0';
}

/* Compiles the comparison in L and leaves the function on its stack. */
static void load_comparison(lua_State *L) {
    assert_int_equal(luaL_loadbuffer(L, compare_script, strlen(compare_script), "=compare"), LUA_OK);
}

static void push_case(lua_State *L, const char *subject, const char *pattern, const char *replacement) {
    lua_pushvalue(L, 1);
    lua_pushstring(L, subject);
    lua_pushstring(L, pattern);
    lua_pushstring(L, replacement);
}

static void patterns_are_those_of_lua(void **state) {
    (void)state;
    random_begin();
    lua_State *const stock = luaL_newstate();
    luaL_openlibs(stock);
    const wh_sandbox_limits_t limits = {.instructions = UINT64_C(100000000000)};
    wh_sandbox_t *const sandbox = wh_sandbox_new(&limits);
    lua_State *const own = wh_sandbox_state(sandbox);
    load_comparison(stock);
    load_comparison(own);
    for (int i = 0; i < 30000 / WH_TEST_SHARE; ++i) {
        char subject[12], pattern[14], replacement[5];
        wh_sandbox_result_t result;
        random_text(subject, sizeof subject, "aab(b) %1.");
        random_text(pattern, sizeof pattern, "aab.%%()[]^$*+-?bf1wds");
        random_text(replacement, sizeof replacement, "x%%012");
        push_case(stock, subject, pattern, replacement);
        push_case(own, subject, pattern, replacement);
        assert_int_equal(lua_pcall(stock, 3, 1, 0), LUA_OK);
        if (!wh_sandbox_call(own, 3, 1, &result)) {
            fail_msg("'%s' '%s' '%s': %s", subject, pattern, replacement, result.message);
        }
        if (strcmp(lua_tostring(stock, -1), lua_tostring(own, -1)) != 0) {
            fail_msg("'%s' '%s' '%s'\n%s\n%s", subject, pattern, replacement, lua_tostring(stock, -1),
                     lua_tostring(own, -1));
        }
        lua_settop(stock, 1);
        lua_settop(own, 1);
    }
    lua_close(stock);
    wh_sandbox_free(sandbox);
}

/* ---- Chunks that nobody wrote ---- */

static const char *const seeds[] = {
    "local t = { a = 1, b = { 2, 3 }, [4] = 'x' } for k, v in pairs(t) do print(k, v, next(t, k)) end",
    "local f = coroutine.wrap(function(a) local x <close> = setmetatable({}, { __close = print }) error(a) "
    "end) f(f)",
    "print(pcall(string.gsub, ('abc'):rep(9), '(.)(b)', function(a, b) return b .. a end), 2 ^ 3, 2 ^ 0.5)",
    "print(xpcall(load, function(m) return #m + nil end, 'return ...', 'name', 't', {})) goto a ::a:: return "
    "1 // 0",
    "table.sort({ 3, 2, 1 }, function(a, b) return a > b end) print(table.unpack({ 1, 2 }, -1, 3), #'x', -{} "
    ".. 1)",
    "print(('%5.2f %s %q %i'):format(1.5, {}, 'a', 3), tostring(nil), select('#', 1, 2), utf8.char(228), "
    "rawlen({}))",
};

/* Removes, doubles or overwrites a few bytes. */
static size_t mutate(char *text, size_t length, size_t capacity) {
    for (size_t changes = 1 + random_below(6); changes > 0 && length > 8; --changes) {
        const size_t at = random_below(length), count = 1 + random_below(8);
        const size_t taken = at + count < length ? count : length - at;
        if (random_below(3) == 0) {
            memmove(text + at, text + at + taken, length - at - taken);
            length -= taken;
        } else if (random_below(2) == 0 && length + taken < capacity) {
            memmove(text + at + taken, text + at, length - at);
            length += taken;
        } else {
            text[at] = random_below(4) != 0 ? text[random_below(length)] : (char)random_below(256);
        }
    }
    return length;
}

static void assert_ends_run(wh_sandbox_t *sandbox, const char *text, size_t size) {
    wh_sandbox_result_t result;
    lua_State *const L = wh_sandbox_state(sandbox);
    const bool ok = wh_sandbox_evaluate_text(L, "fuzz", text, size, &result);
    assert_int_equal(lua_gettop(L), ok ? 1 : 0);
    assert_true(ok == (result.message[0] == '\0'));
    lua_settop(L, 0);
    wh_sandbox_renew(sandbox);
}

static wh_sandbox_t *new_for_fuzzing(FILE *nowhere) {
    const wh_sandbox_limits_t limits = {
        .memory_bytes = (size_t)4 << 20, .instructions = 50000, .print_to = nowhere};
    return wh_sandbox_new(&limits);
}

static void no_text_crashes(void **state) {
    (void)state;
    random_begin();
    FILE *const nowhere = fopen("/dev/null", "w");
    wh_sandbox_t *sandbox = new_for_fuzzing(nowhere);
    for (int i = 0; i < 6000 / WH_TEST_SHARE; ++i) {
        char text[400];
        size_t length = random_below(60);
        for (size_t k = 0; k < length; ++k) {
            text[k] = (char)random_below(256);
        }
        if (i % 4 != 0) {
            const char *const seed = seeds[random_below(sizeof seeds / sizeof *seeds)];
            length = strlen(seed);
            memcpy(text, seed, length);
            length = mutate(text, length, sizeof text);
        }
        assert_ends_run(sandbox, text, length);
        if (i % 200 == 0) { /* a text may have overwritten these globals */
            wh_sandbox_free(sandbox);
            sandbox = new_for_fuzzing(nowhere);
        }
    }
    wh_sandbox_free(sandbox);
    fclose(nowhere);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scripts_end_with_reason_and_line),
        cmocka_unit_test(one_sandbox_survives_them_all),
        cmocka_unit_test(a_runaway_recursion_ends),
        cmocka_unit_test(too_little_memory_is_no_sandbox),
        cmocka_unit_test(memory_may_end_anywhere),
        cmocka_unit_test(pairs_and_next_are_sorted),
        cmocka_unit_test(texts_show_no_address),
        cmocka_unit_test(sort_is_stable),
        cmocka_unit_test(numbers_are_the_same_everywhere),
        cmocka_unit_test(the_budget_is_counted_alike),
        cmocka_unit_test(patterns_are_those_of_lua),
        cmocka_unit_test(no_text_crashes),
    };
    const struct CMUnitTest in_folder[] = {
        cmocka_unit_test(files_are_read_or_refused),
        cmocka_unit_test(layouts_are_evaluated_within_scripts),
        cmocka_unit_test(other_files_are_not_quoted),
        cmocka_unit_test(a_key_that_stands_twice_is_found),
        cmocka_unit_test(modules_stand_beside_their_file),
        cmocka_unit_test(who_reads_a_parameter_is_known),
        cmocka_unit_test(slices_cost),
        cmocka_unit_test(a_numbered_error_can_be_inspected),
        cmocka_unit_test(a_spent_budget_stays_spent),
        cmocka_unit_test(a_stop_ends_the_script),
        cmocka_unit_test(parameters_take_their_type),
        cmocka_unit_test(trust_opens_the_libraries),
    };
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    return failed + cmocka_run_group_tests(in_folder, make_folder, remove_folder);
}
