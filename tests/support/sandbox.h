/* Sandboxes for one test file: small ones that do not print, and a check that one is still usable. */
#ifndef WH_TESTS_SUPPORT_SANDBOX_H
#define WH_TESTS_SUPPORT_SANDBOX_H

#include "support/support.h"

#include <lauxlib.h>

#include "script/sandbox.h"

static inline wh_sandbox_t *new_with(uint64_t instructions) {
    static FILE *nowhere = NULL;
    if (nowhere == NULL) {
        nowhere = fopen("/dev/null", "w");
    }
    const wh_sandbox_limits_t limits = {
        .memory_bytes = (size_t)16 << 20, .instructions = instructions, .print_to = nowhere};
    wh_sandbox_t *const sandbox = wh_sandbox_new(&limits);
    assert_non_null(sandbox);
    return sandbox;
}

static inline wh_sandbox_t *new_small(void) {
    return new_with(1000000);
}

static inline bool evaluate(wh_sandbox_t *sandbox, const char *text, wh_sandbox_result_t *result) {
    return wh_sandbox_evaluate_text(wh_sandbox_state(sandbox), "case.lua", text, strlen(text), result);
}

/* A further script runs as if the one before had never run. */
static inline void assert_usable(wh_sandbox_t *sandbox) {
    wh_sandbox_result_t result;
    wh_sandbox_renew(sandbox);
    assert_int_equal(lua_gettop(wh_sandbox_state(sandbox)), 0);
    if (!evaluate(sandbox, "local t = {} for i = 1, 1000 do t[i] = 'x' .. i end return #table.concat(t)",
                  &result)) {
        fail_msg("not usable: %s", result.message);
    }
    assert_int_equal(lua_tointeger(wh_sandbox_state(sandbox), -1), 3893);
    lua_pop(wh_sandbox_state(sandbox), 1);
}

#endif
