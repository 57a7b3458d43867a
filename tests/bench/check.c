/* Measures the check of one pair of wafer and gripper against Eigen, libccd and FCL. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "batch/batch.h"
#include "bench/harness.h"
#include "bench/peers.h"
#include "bench/scene.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

enum { POSES = 256 };

/* One side of a race: all wafers against the next grippers. */
typedef struct {
    const bench_check_variant_t *variant;
    void *built;
    const wh_pose_t *grippers;
    size_t gripper_count, next;
    char name[48];
} side_t;

/* --------------------------------------------------------------------------------------------------- ours */
typedef struct {
    wh_pose_t *wafers;
    size_t count;
    wh_tolerance_t tolerance;
} plain_t;

static void *build_plain(const wh_pose_t *wafers, size_t count, const wh_tolerance_t *tolerance) {
    plain_t *plain = malloc(sizeof *plain);
    *plain = (plain_t){malloc(count * sizeof *wafers), count, *tolerance};
    memcpy(plain->wafers, wafers, count * sizeof *wafers);
    return plain;
}

static uint64_t count_plain(void *built, const wh_pose_t *grippers, size_t gripper_count) {
    const plain_t *plain = built;
    uint64_t ready = 0;
    for (size_t g = 0; g < gripper_count; ++g) {
        for (size_t w = 0; w < plain->count; ++w) {
            ready += wh_proximity_ready(&plain->wafers[w], &grippers[g], &plain->tolerance);
        }
    }
    return ready;
}

static void drop_plain(void *built) {
    plain_t *plain = built;
    free(plain->wafers);
    free(plain);
}

typedef struct {
    wh_batch_t batch;
    wh_pose_t *wafers;
    float *numbers;
    uint32_t *bits;
    wh_tolerance_t tolerance;
} batch_t;

static void *build_batch(const wh_pose_t *wafers, size_t count, const wh_tolerance_t *tolerance) {
    batch_t *made = malloc(sizeof *made);
    const size_t numbers = WH_BATCH_NUMBERS(count);
    made->tolerance = *tolerance;
    made->wafers = malloc(count * sizeof *wafers);
    memcpy(made->wafers, wafers, count * sizeof *wafers);
    made->numbers = aligned_alloc(64, numbers * sizeof *made->numbers);
    made->bits = malloc(POSES * WH_BATCH_WORDS(count) * sizeof *made->bits);
    if (wh_batch_init(&made->batch, made->wafers, count, made->numbers, numbers) != WH_OK) {
        exit(1);
    }
    return made;
}

static void *build_portable(const wh_pose_t *wafers, size_t count, const wh_tolerance_t *tolerance) {
    batch_t *made = build_batch(wafers, count, tolerance);
    (void)wh_batch_use(&made->batch, WH_BATCH_PORTABLE);
    return made;
}

static uint64_t count_batch(void *built, const wh_pose_t *grippers, size_t gripper_count) {
    const batch_t *made = built;
    return wh_batch_ready(&made->batch, grippers, gripper_count, &made->tolerance, made->bits);
}

static void drop_batch(void *built) {
    batch_t *made = built;
    free(made->wafers);
    free(made->numbers);
    free(made->bits);
    free(made);
}

static const bench_check_variant_t plain = {"plain loop", build_plain, count_plain, drop_plain};
static const bench_check_variant_t batch = {"batch", build_batch, count_batch, drop_batch};
static const bench_check_variant_t portable = {"batch, portable C", build_portable, count_batch, drop_batch};

/* ------------------------------------------------------------------------------------------------- racing */
static uint64_t run(void *user, size_t repeats) {
    side_t *side = user;
    uint64_t ready = 0;
    for (size_t done = 0; done < repeats; ++done) {
        ready += side->variant->count(side->built, side->grippers, side->gripper_count);
    }
    return ready;
}

typedef struct {
    size_t wafer_count, gripper_count, count, first_contact;
    wh_pose_t *wafers;
    wh_pose_t grippers[POSES];
    side_t sides[BENCH_CONTENDERS];
    bench_contender_t contenders[BENCH_CONTENDERS];
} race_t;

static void enter(race_t *race, const char *prefix, const bench_check_variant_t *variant) {
    const wh_tolerance_t tolerance = wh_tolerance_paper();
    side_t *side = &race->sides[race->count];
    *side = (side_t){.variant = variant, .grippers = race->grippers, .gripper_count = race->gripper_count};
    side->built = variant->build(race->wafers, race->wafer_count, &tolerance);
    (void)snprintf(side->name, sizeof side->name, "%s%s", prefix, variant->name);
    const double pairs = (double)race->gripper_count * (double)race->wafer_count;
    race->contenders[race->count++] = (bench_contender_t){side->name, run, side, pairs};
}

static void enter_all(race_t *race, const char *prefix, const bench_check_peer_t *peer) {
    for (const bench_check_variant_t *variant = peer ? peer->variants : NULL; variant && variant->name;
         ++variant) {
        enter(race, prefix, variant);
    }
}

/* All contenders that answer the same question must find the same number of ready pairs. */
static void compare(race_t *race, size_t end) {
    for (size_t c = 1; c < end; ++c) {
        if (run(&race->sides[c], 1) != run(&race->sides[0], 1)) {
            bench_differ(race->sides[c].name, "how many pairs are ready");
        }
    }
}

static void shuffle(wh_pose_t *wafers, size_t count) {
    uint64_t state = 5;
    for (size_t w = count; w > 1; --w) {
        const size_t other = wh_test_splitmix(&state) % w;
        const wh_pose_t last = wafers[w - 1];
        wafers[w - 1] = wafers[other];
        wafers[other] = last;
    }
}

/* Column by column, or in any order. */
typedef enum { COLUMNS, ANY } order_t;

/* Grippers within the columns, at any height: about one in ten is at a height at which it takes a wafer. */
static void begin(race_t *race, size_t wafers, order_t order, size_t grippers) {
    uint64_t state = 2;
    *race = (race_t){
        .wafer_count = wafers, .gripper_count = grippers, .wafers = bench_wafers(wafers, BENCH_COLUMN)};
    if (order == ANY) {
        shuffle(race->wafers, wafers);
    }
    const size_t side = bench_side(wafers, BENCH_COLUMN);
    const size_t column = wafers < BENCH_COLUMN ? wafers : BENCH_COLUMN;
    for (size_t g = 0; g < grippers; ++g) {
        const double x =
            (double)(wh_test_splitmix(&state) % side * BENCH_GRID) + bench_uniform(&state, -30, 30);
        const double y =
            (double)(wh_test_splitmix(&state) % side * BENCH_GRID) + bench_uniform(&state, -30, 30);
        const double z = bench_uniform(&state, -BENCH_PITCH, (double)column * BENCH_PITCH);
        race->grippers[g] = bench_pose(&state, x, y, z, 0.1);
    }
}

static void end(race_t *race) {
    for (size_t c = 0; c < race->count; ++c) {
        race->sides[c].variant->drop(race->sides[c].built);
    }
    free(race->wafers);
}

typedef struct {
    const bench_check_peer_t *eigen_O2, *eigen_native, *ccd, *fcl;
} peers_t;

/* Returns the index at which those with other flags begin. */
static size_t enter_eigen(race_t *race, const peers_t *peers) {
    enter_all(race, "Eigen O2 ", peers->eigen_O2);
    const size_t native = race->count;
    enter_all(race, "Eigen O3n ", peers->eigen_native);
    compare(race, race->count);
    return native;
}

static void row_of_best(const char *row, const race_t *race, const bench_result_t *results, size_t first,
                        size_t end, double goal) {
    if (first < end) {
        bench_row(row, race->contenders, results, bench_best(results, first, end), goal);
    }
}

static void race_plain(const char *row, size_t wafers, const peers_t *peers) {
    static race_t race;
    bench_result_t results[BENCH_CONTENDERS];
    if (!bench_wanted(row)) {
        return;
    }
    begin(&race, wafers, COLUMNS, POSES);
    enter(&race, "", &plain);
    const size_t native = enter_eigen(&race, peers);
    const size_t contact = race.count;
    enter_all(&race, "", peers->ccd);
    enter_all(&race, "", peers->fcl);
    bench_race(race.contenders, race.count, results);
    row_of_best(row, &race, results, 1, native, 1);
    row_of_best(row, &race, results, native, contact, 0);
    for (size_t c = contact; c < race.count; ++c) {
        bench_row(row, race.contenders, results, c, strstr(race.sides[c].name, "MPR") ? 30 : 0);
    }
    end(&race);
}

static void race_batch(const char *row, size_t wafers, order_t order, size_t grippers,
                       const bench_check_variant_t *ours, double goal, const peers_t *peers) {
    static race_t race;
    bench_result_t results[BENCH_CONTENDERS];
    if (!bench_wanted(row)) {
        return;
    }
    begin(&race, wafers, order, grippers);
    enter(&race, "", ours);
    const size_t native = enter_eigen(&race, peers);
    bench_race(race.contenders, race.count, results);
    row_of_best(row, &race, results, 1, native, goal);
    row_of_best(row, &race, results, native, race.count, goal);
    end(&race);
}

/* ------------------------------------------------------------------------------ as fast as memory can be read */
#if defined(__x86_64__)
/* There are four sums, so that none waits for another. */
__attribute__((target("avx2"))) static uint64_t bench_read_avx2(const void *memory, size_t bytes) {
    const __m256i *words = (const __m256i *)memory;
    __m256i a = _mm256_setzero_si256();
    __m256i b = a;
    __m256i c = a;
    __m256i d = a;
    for (size_t i = 0; i + 4 <= bytes / sizeof *words; i += 4) {
        a = _mm256_add_epi64(a, _mm256_loadu_si256(&words[i]));
        b = _mm256_add_epi64(b, _mm256_loadu_si256(&words[i + 1]));
        c = _mm256_add_epi64(c, _mm256_loadu_si256(&words[i + 2]));
        d = _mm256_add_epi64(d, _mm256_loadu_si256(&words[i + 3]));
    }
    const __m256i all = _mm256_add_epi64(_mm256_add_epi64(a, b), _mm256_add_epi64(c, d));
    return (uint64_t)_mm256_extract_epi64(all, 0) + (uint64_t)_mm256_extract_epi64(all, 1) +
           (uint64_t)_mm256_extract_epi64(all, 2) + (uint64_t)_mm256_extract_epi64(all, 3);
}
#endif

static uint64_t bench_read_memory(const void *memory, size_t bytes) {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) {
        return bench_read_avx2(memory, bytes);
    }
#endif
    const uint64_t *words = (const uint64_t *)memory;
    uint64_t sum[4] = {0, 0, 0, 0};
    for (size_t i = 0; i + 4 <= bytes / sizeof *words; i += 4) {
        for (size_t k = 0; k < 4; ++k) {
            sum[k] += words[i + k];
        }
    }
    return sum[0] + sum[1] + sum[2] + sum[3];
}

typedef struct {
    const float *numbers;
    size_t bytes;
} memory_t;

static uint64_t run_read(void *user, size_t repeats) {
    const memory_t *memory = user;
    uint64_t sum = 0;
    for (size_t done = 0; done < repeats; ++done) {
        sum += bench_read_memory(memory->numbers, memory->bytes);
    }
    return sum;
}

/* A batch's data begin with its spheres, and then all origins follow. It reads a part of them, or
 * in any order nearly all. */
static void race_memory(const char *row, size_t wafers, order_t order) {
    static race_t race;
    bench_result_t results[3];
    if (!bench_wanted(row)) {
        return;
    }
    begin(&race, wafers, order, 1);
    enter(&race, "", &batch);
    const float *numbers = ((const batch_t *)race.sides[0].built)->numbers;
    const size_t spheres = (wafers + 1023) / 1024 * 128 * sizeof *numbers;
    memory_t all = {numbers, spheres + WH_BATCH_WORDS(wafers) * 96 * sizeof *numbers};
    memory_t least = {numbers, spheres};
    race.contenders[1] = (bench_contender_t){"reading 12.5 B of each", run_read, &all, (double)wafers};
    race.contenders[2] = (bench_contender_t){"reading 0.5 B of each", run_read, &least, (double)wafers};
    bench_race(race.contenders, 3, results);
    bench_row(row, race.contenders, results, 1, 0.8);
    if (order == COLUMNS) {
        bench_row(row, race.contenders, results, 2, 0);
        bench_note("of wafers in columns it reads little more than these 0.5 B, which stay in a cache");
    }
    end(&race);
}

int main(int argc, char **argv) {
    bench_begin("check", "ns/pair", argc, argv);
    bench_note(
        "same verdicts as Eigen, compared first; O2: -O2, O3n: -O3 -march=native; the best of 5 forms each");
    bench_note(
        "batches sieve in float, 32 at a time where the order of wafers allows it: no form with Eigen does");
    bench_note("libccd and FCL do more: contact of a disc and a blade, another question than readiness");
    const peers_t peers = {bench_peer("eigen_O2", "libeigen3-dev"),
                           bench_peer("eigen_native", "libeigen3-dev"), bench_peer("ccd", "libccd-dev"),
                           bench_peer("fcl", "libfcl-dev")};
    race_plain("plain loop, 2 wafers", 2, &peers);
    race_plain("plain loop, 25 wafers", 25, &peers);
    race_batch("batch, 1000 wafers", 1000, COLUMNS, 16, &batch, 3, &peers);
    race_batch("batch, 1000 in any order", 1000, ANY, 16, &batch, 0, &peers);
    race_batch("portable batch, 1000", 1000, COLUMNS, 16, &portable, 0, &peers);
    race_batch("batch, 1,000,000 wafers", 1000000, COLUMNS, 1, &batch, 0, &peers);
    race_batch("1,000,000 in any order", 1000000, ANY, 1, &batch, 0, &peers);
    race_memory("batch, 1,000,000 wafers", 1000000, COLUMNS);
    race_memory("1,000,000 in any order", 1000000, ANY);
    return bench_end();
}
