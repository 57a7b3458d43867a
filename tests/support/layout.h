/* Layouts from their text, for one test file: a sandbox as fixture, the layout that is read in it,
 * and the refusals. */
#ifndef WH_TESTS_SUPPORT_LAYOUT_H
#define WH_TESTS_SUPPORT_LAYOUT_H

#include "support/support.h"

#include "layout/layout.h"
#include "reading/layout_read.h"
#include "script/sandbox.h"

static wh_sandbox_t *sandbox;
static wh_sandbox_result_t result;

static inline int open_sandbox(void **state) {
    (void)state;
    sandbox = wh_sandbox_new(NULL);
    return sandbox ? 0 : -1;
}

static inline int close_sandbox(void **state) {
    (void)state;
    wh_sandbox_free(sandbox);
    return 0;
}

static inline int read_here(lua_State *L) {
    lua_pushlightuserdata(L, (void *)(uintptr_t)wh_layout_read(L, "cell.lua"));
    return 1;
}

/* The layout that the table describes; null if it is refused, then `result.message` holds the reason. */
static inline const wh_layout_t *read_layout(const char *fields) {
    lua_State *L = wh_sandbox_state(sandbox);
    char text[4096];
    lua_settop(L, 0);
    const int length = snprintf(text, sizeof text, "return { %s }", fields);
    lua_pushcfunction(L, read_here);
    assert_true(wh_sandbox_evaluate_text(L, "cell.lua", text, (size_t)length, &result));
    return wh_sandbox_call(L, 1, 1, &result) ? lua_touserdata(L, -1) : NULL;
}

/* A layout that must not be refused. */
static inline const wh_layout_t *read_sound(const char *fields) {
    const wh_layout_t *layout = read_layout(fields);
    if (!layout) {
        fail_msg("%s", result.message);
    }
    return layout;
}

/* Asserts that it is refused, with this in the message. */
static inline void expect_refused(const char *fields, const char *message) {
    if (read_layout(fields)) {
        fail_msg("accepted: %s", fields);
    }
    if (!strstr(result.message, message)) {
        fail_msg("\"%s\" is not in \"%s\"", message, result.message);
    }
}

#endif
