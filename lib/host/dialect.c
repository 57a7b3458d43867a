/* Opens a dialect's file in a sandbox of its own, and closes it. */
#include "dialect.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <lauxlib.h>

#include "../script/embedded.h"
#include "../script/wh_module.h"
#include "../text/utf8.h"
#include "dialect_internal.h"

char wh_dialect_key;
char wh_dialect_layout_key;
char wh_dialect_self_key;

/* Runs protected: the modules and `host`. */
static int open_libraries(lua_State *L) {
    wh_dialect_t *dialect = lua_touserdata(L, 1);
    lua_pushlightuserdata(L, dialect);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &wh_dialect_self_key);
    luaopen_wh(L);
    lua_setglobal(L, "wh");
    if (wh_dialect_is_testers(dialect->path)) {
        wh_dialect_open_tester(L);
    }
    return wh_dialect_open_host(L);
}

/* Runs protected. */
static int run_file(lua_State *L) {
    wh_sandbox_result_t result;
    const wh_dialect_t *dialect = lua_touserdata(L, 1);
    const wh_embedded_t *file = wh_dialect_find_embedded(dialect->path);
    if (file ? !wh_sandbox_evaluate_code(L, file->name, file->text, file->size, &result)
             : !wh_sandbox_evaluate(L, dialect->path, &result)) {
        return luaL_error(L, "%s", result.message);
    }
    lua_rawsetp(L, LUA_REGISTRYINDEX, &wh_dialect_key);
    return 0;
}

bool wh_dialect_open(wh_dialect_t *dialect, const char *path, const char *unit) {
    const wh_sandbox_limits_t limits = {
        .memory_bytes = WH_DIALECT_MEMORY_BYTES, .instructions = WH_DIALECT_INSTRUCTIONS, .print_to = stderr};
    wh_sandbox_result_t result = {.status = WH_SANDBOX_OK};
    memset(dialect, 0, sizeof *dialect);
    dialect->path = path;
    dialect->place.unit = unit;
    dialect->sandbox = wh_sandbox_new(&limits);
    lua_State *L = dialect->sandbox ? wh_sandbox_state(dialect->sandbox) : NULL;
    const bool opened = L && wh_sandbox_protect(L, open_libraries, dialect, &result) &&
                        wh_sandbox_protect(L, run_file, dialect, &result);
    if (opened) {
        wh_sandbox_renew(dialect->sandbox);
    }
    if (opened && wh_sandbox_protect(L, wh_dialect_read, dialect, &result)) {
        return true;
    }
    wh_dialect_note(dialect, L ? result.message : "no memory for a sandbox");
    return false;
}

void wh_dialect_note(wh_dialect_t *dialect, const char *text) {
    char whole[2 * WH_SANDBOX_MESSAGE_BYTES];
    const size_t length = strlen(dialect->path);
    const bool is_named = strncmp(text, dialect->path, length) == 0 && text[length] == ':';
    (void)snprintf(whole, sizeof whole, "%.300s%s%.1023s", is_named ? "" : dialect->path,
                   is_named ? "" : ": ", text);
    wh_utf8_visible(dialect->message, sizeof dialect->message, whole);
}

void wh_dialect_close(wh_dialect_t *dialect) {
    wh_sandbox_free(dialect->sandbox);
    free(dialect->commands);
    free(dialect->codes);
    free(dialect->text);
    memset(dialect, 0, sizeof *dialect);
}

const char *wh_dialect_code(const wh_dialect_t *dialect, wh_status_t number) {
    for (size_t i = 0; i < dialect->code_count; ++i) {
        if (dialect->codes[i].number == number) {
            return dialect->codes[i].code;
        }
    }
    return dialect->other_code;
}

bool wh_dialect_speaks(const wh_dialect_t *dialect, wh_status_t number) {
    return wh_dialect_code(dialect, number) != dialect->other_code;
}
