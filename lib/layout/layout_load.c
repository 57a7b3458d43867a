#include "layout_load.h"

#include <lauxlib.h>

typedef struct {
    const char *path;
    const wh_layout_t *layout;
} load_t;

/* Runs protected, with a load_t as its argument. */
static int load(lua_State *L) {
    load_t *job = lua_touserdata(L, 1);
    wh_sandbox_result_t result;
    if (!wh_sandbox_evaluate(L, job->path, &result)) {
        lua_pushstring(L, result.message);
        return lua_error(L);
    }
    job->layout = wh_layout_read(L, job->path);
    return 0;
}

const wh_layout_t *wh_layout_load(wh_sandbox_t *sandbox, const char *path, wh_sandbox_result_t *result) {
    lua_State *L = wh_sandbox_state(sandbox);
    load_t job = {path, NULL};
    lua_pushcfunction(L, load);
    lua_pushlightuserdata(L, &job);
    return wh_sandbox_call(L, 1, 0, result) ? job.layout : NULL;
}
