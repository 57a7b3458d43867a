/* The host's side of the sandbox: files, layouts, charges, parameters, and what is left when a script has
 * ended. */
#include <ctype.h>
#include <sys/stat.h>
#include <unistd.h>

#include "support/sandbox.h"

#include "script/sandbox.h"

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

/* What stands in a file that is no Lua: nothing of it is told to a script. */
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
        assert_true(i != 4 || strstr(result.message, "near '3s'")); /* its owner reads what Lua says */
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
        bool asks; /* by a name */
    } cases_of[] = {
        {"local x = params.rate, params.name", "", true},
        {"local x = params.rate, params.nmae",
         "--set name: nobody read params.name (did you mean nmae? read: nmae, rate)", true},
        {"", "--set name: nobody read params.name (read: none)", false},
        {"params.name = 5 local x = params.rate + params.name",
         "--set name: nobody read params.name (read: rate)", true},
        {"local n = 0 for k, v in pairs(params) do n = n + 1 end assert(n == 2)", "", false},
        {"assert(next(params) == 'name' and rawget(params, 'rate') == 5)", "", false},
        {"setmetatable(params, { __index = { z = 1 } }) assert(params.rate == 5 and params.z == 1)", "",
         false},
        {"local p = params assert(p.rate == 5 and p.rate == 5 and p.name == 'x' and p.other == nil)", "",
         true},
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
        assert_int_equal(wh_sandbox_reads_parameters(sandbox), cases_of[i].asks);
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

int main(void) {
    const struct CMUnitTest tests[] = {
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
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
