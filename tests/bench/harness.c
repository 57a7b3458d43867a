#include "bench/harness.h"

#include <dlfcn.h>
#include <sched.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

/* A race takes 61 rounds, or as many as fit into its time, and at least 9. */
enum { ROUNDS = 61, ROUNDS_AT_LEAST = 9, BLOCK_NS = 500000 };
static const double race_ns = 3e9;

static const char *subject;
static const char *unit;
static const char *only;
static bool json;
static bool strict;
static bool headed;
static unsigned missed;
static volatile uint64_t sink;

static double now_ns(void) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return 1e9 * (double)now.tv_sec + (double)now.tv_nsec;
}

/* ------------------------------------------------------------------------------------------------- racing */
static double timed(const bench_contender_t *contender, size_t repeats) {
    const double begin = now_ns();
    sink = sink + contender->run(contender->user, repeats);
    return now_ns() - begin;
}

/* The number of repeats that last a block. */
static size_t calibrate(const bench_contender_t *contender) {
    size_t repeats = 1;
    while (timed(contender, repeats) < BLOCK_NS / 2.0) {
        repeats *= 2;
    }
    return repeats;
}

static int by_size(const void *a, const void *b) {
    const double *x = a;
    const double *y = b;
    return (*x > *y) - (*x < *y);
}

bench_spread_t bench_spread(double *values, size_t count) {
    qsort(values, count, sizeof *values, by_size);
    return (bench_spread_t){values[count / 4], values[count / 2], values[count - 1 - count / 4]};
}

void bench_race(const bench_contender_t *contenders, size_t count, bench_result_t *results) {
    static double ns[BENCH_CONTENDERS][ROUNDS];
    static double faster[BENCH_CONTENDERS][ROUNDS];
    size_t repeats[BENCH_CONTENDERS];
    for (size_t c = 0; c < count; ++c) {
        repeats[c] = calibrate(&contenders[c]);
    }
    size_t round = 0;
    for (const double begin = now_ns();
         round < ROUNDS && (round < ROUNDS_AT_LEAST || now_ns() - begin < race_ns); ++round) {
        for (size_t turn = 0; turn < count; ++turn) {
            const size_t c = (round + turn) % count;
            (void)timed(&contenders[c], repeats[c] / 4);
            ns[c][round] = timed(&contenders[c], repeats[c]) / ((double)repeats[c] * contenders[c].units);
        }
        for (size_t c = 0; c < count; ++c) {
            faster[c][round] = ns[c][round] / ns[0][round];
        }
    }
    for (size_t c = 0; c < count; ++c) {
        results[c] = (bench_result_t){bench_spread(ns[c], round), bench_spread(faster[c], round)};
    }
}

size_t bench_best(const bench_result_t *results, size_t first, size_t end) {
    size_t best = first;
    for (size_t c = first; c < end; ++c) {
        best = results[c].ns.median < results[best].ns.median ? c : best;
    }
    return best;
}

/* ------------------------------------------------------------------------------------------------ printing */
/* Three digits, whatever the size. */
static const char *number(char text[16], double value) {
    const double size = value < 0 ? -value : value;
    const int digits = size >= 99.95 ? 0 : size >= 9.995 ? 1 : 2;
    (void)snprintf(text, 16, "%.*f", digits, value);
    return text;
}

static const char *verdict(bool met, double goal) {
    missed += goal > 0 && !met;
    return goal <= 0 ? "" : met ? "met" : "MISSED";
}

static void print_head(void) {
    if (!json && !headed) {
        (void)printf("\n%-25s %7s %-23s %7s %7s %-11s %s\n", subject, "ours", "peer", unit, "faster",
                     "quartiles", "goal");
    }
    headed = true;
}

static void print_row(const char *row, const char *ours, const char *peer, const char *theirs,
                      const bench_spread_t *value, const char *sign, double goal, const char *verdict_) {
    char median[16];
    char low[16];
    char high[16];
    char limit[16] = "";
    char quartiles[34];
    (void)snprintf(quartiles, sizeof quartiles, "%s-%s", number(low, value->low), number(high, value->high));
    if (goal > 0) {
        (void)snprintf(limit, sizeof limit, goal < 1000 ? "%s %.3g" : "%s %.0f", sign, goal);
    }
    print_head();
    (void)printf("%-25s %7s %-23s %7s %7s %-11s %-7s %s\n", row, ours, peer, theirs,
                 number(median, value->median), quartiles, limit, verdict_);
    (void)fflush(stdout);
}

static void print_spread(const char *name, const bench_spread_t *value) {
    (void)printf(",\"%s\":[%.6g,%.6g,%.6g]", name, value->low, value->median, value->high);
}

static void print_json_end(bool at_most, double goal, const char *verdict_) {
    if (goal > 0) {
        (void)printf(",\"%s\":%g,\"met\":%s", at_most ? "at_most" : "at_least", goal,
                     strcmp(verdict_, "met") == 0 ? "true" : "false");
    }
    (void)printf("}\n");
    (void)fflush(stdout);
}

void bench_row(const char *row, const bench_contender_t *contenders, const bench_result_t *results,
               size_t peer, double goal) {
    const bench_result_t *theirs = &results[peer];
    const char *met = verdict(theirs->faster.median >= goal, goal);
    if (json) {
        (void)printf("{\"subject\":\"%s\",\"row\":\"%s\",\"unit\":\"%s\",\"peer\":\"%s\"", subject, row, unit,
                     contenders[peer].name);
        print_spread("ours", &results[0].ns);
        print_spread("theirs", &theirs->ns);
        print_spread("faster", &theirs->faster);
        print_json_end(false, goal, met);
        return;
    }
    char a[16];
    char b[16];
    print_row(row, number(a, results[0].ns.median), contenders[peer].name, number(b, theirs->ns.median),
              &theirs->faster, ">=", goal, met);
}

void bench_figure(const char *row, const char *unit_, const bench_spread_t *value, bool at_most,
                  double goal) {
    const char *met = verdict(at_most ? value->median <= goal : value->median >= goal, goal);
    if (json) {
        (void)printf("{\"subject\":\"%s\",\"row\":\"%s\",\"unit\":\"%s\"", subject, row, unit_);
        print_spread("value", value);
        print_json_end(at_most, goal, met);
        return;
    }
    print_row(row, "", unit_, "", value, at_most ? "<=" : ">=", goal, met);
}

void bench_note(const char *format, ...) {
    if (!json && headed) {
        va_list arguments;
        va_start(arguments, format);
        (void)fputs("  ", stdout);
        (void)vprintf(format, arguments);
        (void)putchar('\n');
        va_end(arguments);
    }
}

void bench_differ(const char *who, const char *what) {
    (void)fflush(stdout);
    (void)fprintf(stderr, "bench: %s and we do not give the same answer: %s\n", who, what);
    exit(1);
}

/* ------------------------------------------------------------------------------------- beginning and ending */
bool bench_wanted(const char *row) {
    return !only || !*only || strcmp(only, subject) == 0 || strstr(row, only);
}

void bench_begin(const char *subject_, const char *unit_, int argc, char **argv) {
    subject = subject_;
    unit = unit_;
    only = getenv("BENCH");
    for (int i = 1; i < argc; ++i) {
        json = json || strcmp(argv[i], "--json") == 0;
        strict = strict || strcmp(argv[i], "--strict") == 0;
    }
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET((size_t)sched_getcpu(), &one);
    (void)sched_setaffinity(0, sizeof one, &one);
    if (!only || !*only || strcmp(only, subject) == 0) {
        print_head();
    }
}

int bench_end(void) {
    return strict && missed > 0;
}

const void *bench_peer(const char *name, const char *needs) {
    return bench_peer_symbol(name, "bench_peer", needs);
}

const void *bench_peer_symbol(const char *name, const char *symbol, const char *needs) {
    char path[4096];
    const ssize_t length = readlink("/proc/self/exe", path, sizeof path - 64);
    path[length > 0 ? length : 0] = '\0';
    char *end = strrchr(path, '/');
    (void)snprintf(end ? end + 1 : path, 64, "peer_%s.so", name);
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    const void *found = library ? dlsym(library, symbol) : NULL;
    if (!found) {
        (void)fprintf(json ? stderr : stdout, "  SKIPPED %s: it needs %s%s%s\n", name, needs,
                      access(path, F_OK) == 0 ? "; " : "", access(path, F_OK) == 0 ? dlerror() : "");
    }
    return found;
}
