/* What a match has captured, as Lua values. */
#include "pattern.h"

#include <lauxlib.h>

void wh_pattern_push_capture(wh_pattern_t *m, int index, const char *begin, const char *end) {
    if (index >= m->captures) {
        if (index != 0) {
            luaL_error(m->L, "invalid capture index %%%d", index + 1);
        }
        lua_pushlstring(m->L, begin, (size_t)(end - begin));
        return;
    }
    const ptrdiff_t length = m->capture[index].length;
    if (length == WH_CAPTURE_OPEN) {
        luaL_error(m->L, "unfinished capture");
    }
    if (length == WH_CAPTURE_POSITION) {
        lua_pushinteger(m->L, m->capture[index].begin - m->subject + 1);
    } else {
        lua_pushlstring(m->L, m->capture[index].begin, (size_t)length);
    }
}

int wh_pattern_push_captures(wh_pattern_t *m, const char *begin, const char *end) {
    const int count = m->captures == 0 && begin != NULL ? 1 : m->captures;
    luaL_checkstack(m->L, count, "too many captures");
    for (int i = 0; i < count; ++i) {
        wh_pattern_push_capture(m, i, begin, end);
    }
    return count;
}
