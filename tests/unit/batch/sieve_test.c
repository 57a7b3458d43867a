/* The sieve of a batch holds back wafers farther than its reach, even by one number, and nothing
 * else: lane by lane, block by block, in each code path that the processor has. */
#include "batch/batch_internal.h"
#include "support/pose.h"

enum { BLOCKS = 32, LANES = 32, SPHERES = 4 * LANES, BLOCK = 3 * LANES };

static float spheres[SPHERES], origins[BLOCKS * BLOCK], normals[BLOCKS * BLOCK];
static uint32_t words[BLOCKS + 1];
static const wh_batch_sieve_t sieve = {100, 200, 300, 50, 5};

typedef uint32_t code_t(const wh_batch_sieve_t *sieve, const wh_batch_tile_t *tile, uint32_t *words);
static code_t *code;

/* All blocks' spheres about the sieve's centre; all wafers there too, level. */
static void begin(void) {
    const float centre[] = {sieve.x, sieve.y, sieve.z, 0};
    for (size_t i = 0; i < SPHERES; ++i) {
        spheres[i] = centre[i / LANES];
    }
    for (size_t i = 0; i < BLOCKS * BLOCK; ++i) {
        origins[i] = centre[i / LANES % 3];
        normals[i] = i / LANES % 3 == 2 ? 1 : 0;
    }
}

static float *origin(size_t block, size_t lane, size_t axis) {
    return &origins[block * BLOCK + axis * LANES + lane];
}

static float *normal(size_t block, size_t lane, size_t axis) {
    return &normals[block * BLOCK + axis * LANES + lane];
}

/* Asks about the first `count` blocks; nothing is written beyond them. */
static uint32_t ask(size_t count) {
    const wh_batch_tile_t tile = {spheres, origins, normals, count};
    for (size_t b = 0; b <= BLOCKS; ++b) {
        words[b] = 0xabcdef01U;
    }
    const uint32_t near = code(&sieve, &tile, words);
    for (size_t b = count; b <= BLOCKS; ++b) {
        assert_int_equal(words[b], 0xabcdef01U);
        assert_int_equal((uint64_t)near >> count, 0);
    }
    return near;
}

static void run_each(void (*test)(void)) {
    code = wh_batch_sieve_portable;
    test();
#if WH_BATCH_HAS_AVX2
    if (__builtin_cpu_supports("avx2")) {
        code = wh_batch_sieve_avx2;
        test();
    }
#endif
}

/* `exactly` passes, the number next to it does not, on either side of the centre. */
static void expect_limit(float *number, float centre, float exactly, size_t block, uint32_t others) {
    for (float side = -1; side < 2; side += 2) {
        *number = centre + side * exactly;
        (void)ask(BLOCKS);
        assert_int_equal(words[block], UINT32_MAX);
        *number = nextafterf(*number, side * 1e9F);
        (void)ask(BLOCKS);
        assert_int_equal(words[block], others);
    }
    *number = centre;
}

static void try_limits_of_wafers(void) {
    begin();
    for (size_t lane = 0; lane < LANES; ++lane) {
        const size_t block = lane * 7 % BLOCKS;
        const uint32_t others = ~(UINT32_C(1) << lane);
        expect_limit(origin(block, lane, 0), sieve.x, sieve.reach, block, others);
        expect_limit(origin(block, lane, 1), sieve.y, sieve.reach, block, others);
        expect_limit(origin(block, lane, 2), sieve.z, sieve.limit, block, others);
    }
}

static void wafers_pass_up_to_the_limits(void **state) {
    (void)state;
    run_each(try_limits_of_wafers);
}

/* Along each axis in turn, and not across it. */
static void try_normals(void) {
    for (size_t axis = 0; axis < 3; ++axis) {
        begin();
        for (size_t lane = 0; lane < LANES; ++lane) {
            for (size_t k = 0; k < 3; ++k) {
                *normal(lane, lane, k) = k == axis ? 1 : 0;
            }
            const float centre[] = {sieve.x, sieve.y, sieve.z};
            expect_limit(origin(lane, lane, axis), centre[axis], sieve.limit, lane, ~(UINT32_C(1) << lane));
            *origin(lane, lane, (axis + 1) % 3) += 30;
            *origin(lane, lane, (axis + 2) % 3) -= 30;
            (void)ask(BLOCKS);
            assert_int_equal(words[lane], UINT32_MAX);
        }
    }
}

static void planes_lie_along_the_normals(void **state) {
    (void)state;
    run_each(try_normals);
}

/* A sphere that just reaches the sieve's sphere, and one that just does not; no wafer of the second
 * is looked at. */
static void try_spheres(void) {
    begin();
    for (size_t b = 0; b < BLOCKS; ++b) {
        for (size_t axis = 0; axis < 3; ++axis) {
            float *centre = &spheres[axis * LANES + b];
            const float was = *centre;
            spheres[3 * LANES + b] = 14;
            *centre = was + 64;
            assert_int_equal(ask(BLOCKS), UINT32_MAX);
            assert_int_equal(words[b], UINT32_MAX);
            *centre = nextafterf(*centre, 1e9F);
            assert_int_equal(ask(BLOCKS), ~(UINT32_C(1) << b));
            assert_int_equal(words[b], 0);
            *centre = was;
        }
    }
}

static void spheres_pass_where_they_touch(void **state) {
    (void)state;
    run_each(try_spheres);
}

static void try_counts(void) {
    begin();
    for (size_t count = 1; count <= BLOCKS; ++count) {
        assert_int_equal(ask(count), UINT32_MAX >> (BLOCKS - count));
    }
}

static void no_more_blocks_are_asked_than_there_are(void **state) {
    (void)state;
    run_each(try_counts);
}

/* A wafer that would be held back passes if one of the numbers that decide is NaN. */
static void try_nan(void) {
    for (size_t axis = 0; axis < 3; ++axis) {
        begin();
        *origin(3, 5, 0) += 1000;
        *origin(3, 5, axis) = (float)NAN;
        *origin(4, 6, 2) += 20;
        *normal(4, 6, axis) = (float)NAN;
        spheres[7] = 1e4F;
        spheres[axis * LANES + 7] = (float)NAN;
        spheres[8] = 1e4F;
        spheres[3 * LANES + 8] = (float)NAN;
        assert_int_equal(ask(BLOCKS), UINT32_MAX);
        assert_int_equal(words[3], UINT32_MAX);
        assert_int_equal(words[4], UINT32_MAX);
    }
}

static void nan_holds_nothing_back(void **state) {
    (void)state;
    run_each(try_nan);
}

/* The expected verdict on a wafer's lane; 2: so near to a limit that rounding decides. */
static int expected(size_t block, size_t lane) {
    const double centre[] = {(double)sieve.x, (double)sieve.y, (double)sieve.z};
    double squares = 0;
    double along = 0;
    for (size_t k = 0; k < 3; ++k) {
        const double d = (double)*origin(block, lane, k) - centre[k];
        squares += d * d;
        along += d * (double)*normal(block, lane, k);
    }
    const double far = sqrt(squares) / (double)sieve.reach;
    const double off = fabs(along) / (double)sieve.limit;
    if (fabs(far - 1) < 1e-5 || fabs(off - 1) < 1e-4) {
        return 2;
    }
    return far < 1 && off < 1 ? 1 : 0;
}

static void draw(void) {
    begin();
    for (size_t b = 0; b < BLOCKS; ++b) {
        const double spread = b % 4 == 0 ? 400 : 60;
        for (size_t i = 0; i < LANES; ++i) {
            const wh_mat3_t turn = wh_test_random_turn(b % 2 == 0 ? 0.1 : 3);
            for (size_t k = 0; k < 3; ++k) {
                *origin(b, i, k) +=
                    (float)wh_test_uniform(-spread, spread) * (k == 2 && b % 3 != 0 ? 0.1F : 1);
                *normal(b, i, k) = (float)turn.m[k][2];
            }
        }
    }
}

static void try_random(void) {
    size_t seen[3] = {0};
    for (int round = 0; round < 50; ++round) {
        draw();
        assert_int_equal(ask(BLOCKS), UINT32_MAX);
        for (size_t w = 0; w < BLOCKS * LANES; ++w) {
            const int wanted = expected(w / LANES, w % LANES);
            ++seen[wanted];
            if (wanted != 2) {
                assert_int_equal(words[w / LANES] >> w % LANES & 1U, wanted);
            }
        }
    }
    assert_true(seen[0] > 10000 && seen[1] > 1000 && seen[2] < 100);
}

static void random_wafers_are_sieved_as_by_hand(void **state) {
    (void)state;
    run_each(try_random);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wafers_pass_up_to_the_limits),
        cmocka_unit_test(planes_lie_along_the_normals),
        cmocka_unit_test(spheres_pass_where_they_touch),
        cmocka_unit_test(no_more_blocks_are_asked_than_there_are),
        cmocka_unit_test(nan_holds_nothing_back),
        cmocka_unit_test(random_wafers_are_sieved_as_by_hand),
    };
    (void)wh_test_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
