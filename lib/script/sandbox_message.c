/* From an error value to the line that a person reads. */
#include <ctype.h>
#include <string.h>

#include "../text/utf8.h"
#include "sandbox_internal.h"

/* Where a person's text goes that Lua code may yet have to make. */
typedef struct {
    char text[WH_SANDBOX_MESSAGE_BYTES];
} described_t;

int wh_sandbox_handler(lua_State *L) {
    wh_sandbox_job_t *const job = wh_sandbox_of(L)->job;
    if (job->path != NULL && !job->line_is_final) {
        job->line = wh_sandbox_line(L, job->path);
    }
    return 1;
}

/* A table without __tostring but with a text in `message` is read by it: the numbered errors are such. */
static const char *text_of(lua_State *L, size_t *length) {
    const int type = lua_type(L, 1);
    if (type == LUA_TSTRING || type == LUA_TNUMBER) {
        return wh_library_tostring(L, 1, length);
    }
    if (luaL_getmetafield(L, 1, "__tostring") != LUA_TNIL) {
        return wh_library_tostring(L, 1, length);
    }
    if (type == LUA_TTABLE) {
        lua_pushliteral(L, "message");
        if (lua_rawget(L, 1) == LUA_TSTRING) {
            return lua_tolstring(L, -1, length);
        }
    }
    lua_pushfstring(L, "(error object is a %s value)", luaL_typename(L, 1));
    return lua_tolstring(L, -1, length);
}

/* One line, and none that a terminal would obey. */
static int describe(lua_State *L) {
    described_t *const described = lua_touserdata(L, 2);
    size_t length = 0;
    const char *const text = text_of(L, &length);
    char whole[WH_SANDBOX_MESSAGE_BYTES + 1];
    const size_t kept = length < sizeof whole ? length : sizeof whole - 1;
    for (size_t i = 0; i < kept; ++i) {
        whole[i] = iscntrl((unsigned char)text[i]) ? ' ' : text[i];
    }
    whole[kept] = '\0';
    wh_utf8_clip(described->text, sizeof described->text, whole);
    return 0;
}

static void make_text(lua_State *L, described_t *described) {
    const wh_sandbox_t *const sandbox = wh_sandbox_of(L);
    if (sandbox->fatal == WH_SANDBOX_OK) {
        wh_utf8_clip(described->text, sizeof described->text, "(error object whose __tostring failed)");
        lua_pushcfunction(L, describe);
        lua_pushvalue(L, -2);
        lua_pushlightuserdata(L, described);
        if (lua_pcall(L, 2, 0, 0) != LUA_OK) {
            (void)wh_sandbox_is_fatal(L, LUA_ERRRUN);
            lua_pop(L, 1);
        }
    }
    if (sandbox->fatal != WH_SANDBOX_OK) {
        wh_sandbox_fatal_text(sandbox, described->text, sizeof described->text);
    }
}

/* Lua's own "short_source:line:" in front. */
static bool has_position(const char *text, const char *short_source) {
    const size_t length = strlen(short_source);
    return strncmp(text, short_source, length) == 0 && text[length] == ':' &&
           isdigit((unsigned char)text[length + 1]);
}

void wh_sandbox_report(lua_State *L, const wh_sandbox_job_t *job, char message[WH_SANDBOX_MESSAGE_BYTES]) {
    described_t described;
    char whole[WH_SANDBOX_MESSAGE_BYTES * 3];
    make_text(L, &described);
    lua_pop(L, 1);
    if (job->path == NULL) {
        snprintf(whole, sizeof whole, "%s", described.text);
    } else if (has_position(described.text, job->short_source)) {
        snprintf(whole, sizeof whole, "%.1023s%s", job->path, described.text + strlen(job->short_source));
    } else if (job->line > 0) {
        snprintf(whole, sizeof whole, "%.1023s:%d: %s", job->path, job->line, described.text);
    } else {
        snprintf(whole, sizeof whole, "%.1023s: %s", job->path, described.text);
    }
    wh_utf8_clip(message, WH_SANDBOX_MESSAGE_BYTES, whole);
}
