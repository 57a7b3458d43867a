/* bench.h for Unity: RUN_TEST(a_test) sets it up. */
#include <unity.h>

#define BENCH_FAIL(text) TEST_FAIL_MESSAGE(text)
#include "bench.h"

void setUp(void) {
    BENCH_CHECK(bench_set_up() == 0);
}

void tearDown(void) {
}
