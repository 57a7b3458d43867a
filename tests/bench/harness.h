/* How the benches measure: contenders take turns in one process, on one core.
 *
 * A race has rounds. In each, every contender works once for about half a millisecond after a short
 * warm-up. The one that begins changes from round to round. Ratios are taken within a round, so
 * that other work of the machine affects both sides. Printed are medians, and the lower and upper
 * quartile as the spread. */
#ifndef WH_TESTS_BENCH_HARNESS_H
#define WH_TESTS_BENCH_HARNESS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { BENCH_CONTENDERS = 24 };

/* The first contender of a race is ours. */
typedef struct {
    const char *name;
    /* Does the work `repeats` times; the returned value depends on all of it, so that the compiler
     * can leave out none of it. */
    uint64_t (*run)(void *user, size_t repeats);
    void *user;
    double units; /* the counted units (for example pairs) in one repeat */
} bench_contender_t;

typedef struct {
    double low, median, high; /* quartiles */
} bench_spread_t;

/* ns per unit, and how many times faster than each contender the first one is. */
typedef struct {
    bench_spread_t ns, faster;
} bench_result_t;

/* Pins the process to a core, reads --json and $BENCH, and prints the table's head. `unit`: the
 * unit of all numbers but the ratios. */
void bench_begin(const char *subject, const char *unit, int argc, char **argv);

/* 0, or 1 if a row missed its goal and --strict was given. */
int bench_end(void);

/* True if $BENCH, which names a subject or a part of a row's name, selects this row. */
bool bench_wanted(const char *row);

/* Sorts the values. */
bench_spread_t bench_spread(double *values, size_t count);

void bench_race(const bench_contender_t *contenders, size_t count, bench_result_t *results);

/* A row for the race of contenders[0] against contenders[peer]; `goal`: how many times faster it
 * must be, 0: no goal. */
void bench_row(const char *row, const bench_contender_t *contenders, const bench_result_t *results,
               size_t peer, double goal);

/* The index of the fastest of contenders[first] to contenders[end - 1]. */
size_t bench_best(const bench_result_t *results, size_t first, size_t end);

/* A row for a single figure with its own unit; `goal` 0: no goal. `at_most`: the kind of goal. */
void bench_figure(const char *row, const char *unit, const bench_spread_t *value, bool at_most, double goal);

/* A line below the table's head with facts that the reader needs. Not printed with --json. */
void bench_note(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Ends the process: the two sides do not give the same answer. */
void bench_differ(const char *who, const char *what);

/* The object that peer_NAME.so beside the program exports as `bench_peer`, or as `symbol`. Null if
 * it was not built; the peer is then skipped by name. */
const void *bench_peer(const char *name, const char *needs);
const void *bench_peer_symbol(const char *name, const char *symbol, const char *needs);

#ifdef __cplusplus
}
#endif

#endif
