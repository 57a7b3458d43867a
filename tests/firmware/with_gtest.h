/* bench.h for GoogleTest: TEST_F(Bench, a_test). */
#include <gtest/gtest.h>

#include <stdexcept>

#define BENCH_FAIL(text) throw std::runtime_error(text)
#include "bench.h"

struct Bench : testing::Test {
    Bench() {
        BENCH_CHECK(bench_set_up() == 0);
    }
};
