/* bench.h for cmocka: cmocka_unit_test_setup(a_test, set_up). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define BENCH_FAIL(text) fail_msg("%s", text)
#include "bench.h"

static inline int set_up(void **unused) {
    (void)unused;
    return bench_set_up();
}
