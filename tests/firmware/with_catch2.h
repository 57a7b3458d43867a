/* bench.h for Catch2: TEST_CASE_METHOD(Bench, "a test"). */
#include <catch2/catch.hpp>

#define BENCH_FAIL(text) FAIL(text)
#include "bench.h"

struct Bench {
    Bench() {
        BENCH_CHECK(bench_set_up() == 0);
    }
};
