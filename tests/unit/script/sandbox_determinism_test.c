/* The same script does the same in each run; patterns are Lua's own; no text whatever crashes the sandbox. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <lauxlib.h>
#include <lualib.h>

#include "script/sandbox.h"

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

/* Runs a text in a new sandbox and returns what it printed; the caller frees it. */
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

/* Steps counted for the same script must not depend on the hash seed or on addresses. */
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

/* Random text over an alphabet that makes patterns likely to mean something. */
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
    for (int i = 0; i < 30000; ++i) {
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

static void assert_ends(wh_sandbox_t *sandbox, const char *text, size_t size) {
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
    for (int i = 0; i < 6000; ++i) {
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
        assert_ends(sandbox, text, length);
        if (i % 200 == 0) { /* globals that a text has overwritten */
            wh_sandbox_free(sandbox);
            sandbox = new_for_fuzzing(nowhere);
        }
    }
    wh_sandbox_free(sandbox);
    fclose(nowhere);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pairs_and_next_are_sorted),
        cmocka_unit_test(texts_show_no_address),
        cmocka_unit_test(sort_is_stable),
        cmocka_unit_test(numbers_are_the_same_everywhere),
        cmocka_unit_test(the_budget_is_counted_alike),
        cmocka_unit_test(patterns_are_those_of_lua),
        cmocka_unit_test(no_text_crashes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
