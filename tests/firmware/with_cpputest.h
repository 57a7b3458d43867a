/* bench.h for CppUTest: TEST(Bench, a_test). */
#include <CppUTest/TestHarness.h>

#define BENCH_FAIL(text) FAIL(text)
#include "bench.h"

TEST_GROUP(Bench){void setup(){BENCH_CHECK(bench_set_up() == 0);
}
}
;
