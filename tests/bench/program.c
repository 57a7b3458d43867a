/* Figures without a peer in C: how much faster than real time the program plays the transfer run and a
 * tool, what a run costs from start to end, studies and pages, the cost of its log's other readers beside a
 * replay, the instructions of a step, as callgrind counts them, the time of a scan's estimate; and a flow of
 * 10,000 wafers, also against SimPy.
 * Start it at the root, after `make all tests`. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "bench/harness.h"
#include "bench/ours.h"

enum { RUNS = 41, FEW_RUNS = 5 };

#define LOG "build/tests/bench/tool.log"
#define PAGE "build/tests/bench/week.html"
#define TOOL_PAGE "build/tests/bench/tool.html"
#define LOOP "tests/bench/loop.lua --counted --brief --set commands="

/* The first number after `key` in a command's output; the command's own complaints are shown.
 * Negative: there is none. */
static double ask(const char *command, const char *key) {
    char line[400];
    double number = -1;
    FILE *answer = popen(command, "r");
    while (answer && fgets(line, sizeof line, answer)) {
        const char *found = strstr(line, key);
        number = found && number < 0 ? strtod(found + strlen(key), NULL) : number;
    }
    if (!answer || pclose(answer) != 0) {
        (void)fprintf(stderr, "bench: %s failed\n", command);
        exit(1);
    }
    return number;
}

static void time_run(const char *row, const char *example, size_t runs, double goal) {
    char command[100];
    double times[RUNS];
    if (!bench_wanted(row)) {
        return;
    }
    (void)snprintf(command, sizeof command, "build/waferhand run lua/examples/%s.lua --json", example);
    const double simulated = ask(command, "\"simulated_s\": ");
    for (size_t i = 0; i < runs; ++i) {
        times[i] = simulated / ask(command, "\"wall_s\": ");
    }
    const bench_spread_t spread = bench_spread(times, runs);
    bench_figure(row, "x real time", &spread, false, goal);
}

static void count_step(const char *row, const char *name, double goal) {
    char command[200];
    if (!bench_wanted(row)) {
        return;
    }
    if (system("command -v valgrind >/dev/null") != 0) {
        bench_note("SKIPPED instructions: no valgrind");
        return;
    }
    (void)snprintf(command, sizeof command, "tests/bench/callgrind build | grep -F '%s '", name);
    double count = ask(command, name);
    const bench_spread_t spread = bench_spread(&count, 1);
    bench_figure(row, "instructions", &spread, true, goal);
}

static uint64_t estimate(void *user, size_t repeats) {
    bench_scan_t *made = user;
    uint64_t verdicts = 0;
    for (size_t i = 0; i < repeats; ++i) {
        verdicts += (uint64_t)bench_scan_estimate(made);
    }
    return verdicts;
}

/* Works in thousands, which turns the harness's nanoseconds into microseconds. */
static void time_estimate(const char *row, double goal) {
    static bench_scan_t made;
    bench_result_t result;
    const bench_contender_t ours = {"ours", estimate, &made, 1000};
    if (!bench_wanted(row)) {
        return;
    }
    bench_scan_make(&made);
    if (bench_scan_estimate(&made) != WH_OK) {
        bench_differ("the estimate", "a scan that it is sure of");
    }
    bench_race(&ours, 1, &result);
    bench_figure(row, "us", &result.ns, true, goal);
}

/* The processor time of a command, s. */
static double cost_of(const char *command) {
    struct rusage before;
    struct rusage after;
    (void)getrusage(RUSAGE_CHILDREN, &before);
    if (system(command) != 0) {
        (void)fprintf(stderr, "bench: %s failed\n", command);
        exit(1);
    }
    (void)getrusage(RUSAGE_CHILDREN, &after);
    return (double)(after.ru_utime.tv_sec - before.ru_utime.tv_sec + after.ru_stime.tv_sec -
                    before.ru_stime.tv_sec) +
           1e-6 * (double)(after.ru_utime.tv_usec - before.ru_utime.tv_usec + after.ru_stime.tv_usec -
                           before.ru_stime.tv_usec);
}

/* How much faster than real time a run is by its processor time, its start and its table included. */
static void time_by_processor(const char *row, const char *run, double goal) {
    char command[200];
    double times[FEW_RUNS];
    if (!bench_wanted(row)) {
        return;
    }
    (void)snprintf(command, sizeof command, "build/waferhand run %s --json", run);
    const double simulated = ask(command, "\"simulated_s\": ");
    (void)snprintf(command, sizeof command, "build/waferhand run %s >/dev/null", run);
    for (size_t i = 0; i < FEW_RUNS; ++i) {
        times[i] = simulated / cost_of(command);
    }
    const bench_spread_t spread = bench_spread(times, FEW_RUNS);
    bench_figure(row, "x real time", &spread, false, goal);
}

/* How many times less a counted run costs than the full one. */
static void time_counted(const char *row, const char *full, double goal) {
    double times[FEW_RUNS];
    char line[200];
    if (!bench_wanted(row)) {
        return;
    }
    (void)snprintf(line, sizeof line, "%s --counted", full);
    for (size_t i = 0; i < FEW_RUNS; ++i) {
        const double whole = cost_of(full);
        times[i] = whole / cost_of(line);
    }
    const bench_spread_t spread = bench_spread(times, FEW_RUNS);
    bench_figure(row, "x the full run", &spread, false, goal);
}

/* The number behind "refs:" in valgrind's line, which has commas in it; 0 without one. */
static double count_in(const char *line) {
    char digits[40];
    size_t length = 0;
    for (const char *c = strstr(line, "refs:"); c && *c && length + 1 < sizeof digits; ++c) {
        if (*c >= '0' && *c <= '9') {
            digits[length++] = *c;
        }
    }
    digits[length] = '\0';
    return strtod(digits, NULL);
}

/* All instructions of a run, as valgrind counts them. */
static double count_run(const char *run) {
    char command[300], line[400];
    double count = 0;
    (void)snprintf(command, sizeof command,
                   "valgrind --tool=callgrind --callgrind-out-file=/dev/null build/waferhand run %s 2>&1 "
                   ">/dev/null | grep refs:",
                   run);
    FILE *answer = popen(command, "r");
    while (answer && fgets(line, sizeof line, answer)) {
        count = count_in(line);
    }
    if (!answer || pclose(answer) != 0 || !(count > 0)) {
        bench_differ(run, "a count of instructions");
    }
    return count;
}

/* The instructions that one more of them takes: `run` ends before their number. */
static void count_each(const char *row, const char *run, int few, int many, double goal) {
    char runs[2][200];
    if (!bench_wanted(row)) {
        return;
    }
    if (system("command -v valgrind >/dev/null") != 0) {
        bench_note("SKIPPED instructions: no valgrind");
        return;
    }
    (void)snprintf(runs[0], sizeof runs[0], "%s%d", run, few);
    (void)snprintf(runs[1], sizeof runs[1], "%s%d", run, many);
    double each = (count_run(runs[1]) - count_run(runs[0])) / (many - few);
    const bench_spread_t spread = bench_spread(&each, 1);
    bench_figure(row, "instructions", &spread, true, goal);
}

/* The instructions of a whole run. */
static void count_whole(const char *row, const char *run, double goal) {
    if (!bench_wanted(row)) {
        return;
    }
    if (system("command -v valgrind >/dev/null") != 0) {
        bench_note("SKIPPED instructions: no valgrind");
        return;
    }
    double count = count_run(run);
    const bench_spread_t spread = bench_spread(&count, 1);
    bench_figure(row, "instructions", &spread, true, goal);
}

#define REAL_FLOW "build/waferhand run tests/bench/real_flow.lua --counted --brief --set lots=40"
#define FLOW "build/waferhand run tests/bench/flow.lua --set wafers=10000"
#define SIMPY "PYTHONPATH=build/pypi python3 tests/bench/peer_simpy.py 10000"

/* The whole program, its table or page included. */
static void time_run_of(const char *row, const char *command, double goal) {
    double times[FEW_RUNS];
    if (!bench_wanted(row)) {
        return;
    }
    for (size_t i = 0; i < FEW_RUNS; ++i) {
        times[i] = cost_of(command);
    }
    const bench_spread_t spread = bench_spread(times, FEW_RUNS);
    bench_figure(row, "s", &spread, true, goal);
}

/* A page's cost beside its run: the signals over time are recorded for it, and it is written. */
static void time_page(const char *row, const char *run, double goal) {
    double times[FEW_RUNS];
    char line[200];
    if (!bench_wanted(row)) {
        return;
    }
    (void)snprintf(line, sizeof line, "%s --report " TOOL_PAGE, run);
    for (size_t i = 0; i < FEW_RUNS; ++i) {
        const double whole = cost_of(line);
        times[i] = whole - cost_of(run);
    }
    const bench_spread_t spread = bench_spread(times, FEW_RUNS);
    bench_figure(row, "s", &spread, true, goal);
}

static void race_simpy(const char *row, double goal) {
    double times[FEW_RUNS];
    if (!bench_wanted(row)) {
        return;
    }
    if (system("PYTHONPATH=build/pypi python3 -c 'import simpy' 2>/dev/null") != 0) {
        bench_note("SKIPPED SimPy: the wheel of tests/bench/requirements.txt");
        return;
    }
    const double ours = ask(FLOW, "makespan_s "), peers = ask(SIMPY, "makespan_s ");
    if (!(ours > 0) || ours < peers || ours > peers) {
        bench_differ("SimPy", "the makespan");
    }
    for (size_t i = 0; i < FEW_RUNS; ++i) {
        const double whole = cost_of(SIMPY " >/dev/null");
        times[i] = whole / cost_of(FLOW " >/dev/null");
    }
    const bench_spread_t spread = bench_spread(times, FEW_RUNS);
    bench_figure(row, "x SimPy", &spread, false, goal);
}

/* A log read by a command, against the same log replayed. */
static void time_reading(const char *row, const char *command, double goal) {
    char line[200];
    double times[FEW_RUNS];
    if (!bench_wanted(row)) {
        return;
    }
    if (system("build/waferhand run lua/examples/27_tool.lua --record " LOG " >/dev/null") != 0) {
        bench_differ("the recorded run", "a run that passes");
    }
    (void)snprintf(line, sizeof line, "build/waferhand %s /dev/null " LOG, command);
    for (size_t i = 0; i < FEW_RUNS; ++i) {
        const double replayed = cost_of("build/waferhand replay " LOG " >/dev/null");
        times[i] = cost_of(line) / replayed;
    }
    const bench_spread_t spread = bench_spread(times, FEW_RUNS);
    bench_figure(row, "x its replay", &spread, true, goal);
}

int main(int argc, char **argv) {
    bench_begin("program", "", argc, argv);
    bench_note(
        "`waferhand run` on the transfer run and on the tool of example 27 with 1 ms slices, by its own "
        "clock; a long series, counted; a log read; a step counted by callgrind");
    time_run("run, real time", "01_transfer", RUNS, 10000);
    /* One robot, and two; collisions between all parts and the smallest gaps are checked. */
    time_run("efem, real time", "35_efem_flow", FEW_RUNS, 1500);
    time_run("tool, real time", "27_tool", FEW_RUNS, 400);
    /* Collisions, doors, pumps, cleans, vacuum that builds up, wafers that settle and may slip. */
    time_by_processor("three robots, collisions", "tests/bench/three_robots.lua", 300);
    time_by_processor("three robots, look ahead", "tests/bench/three_robots.lua --set wafers=2 --set ahead=1",
                      0);
    count_each("three robots, a wafer", "tests/bench/three_robots.lua --brief --set wafers=", 2, 4, 1.1e9);
    count_whole("tool, instructions", "lua/examples/27_tool.lua", 7e9);
    time_run_of("run, start to end", "build/waferhand run lua/examples/01_transfer.lua >/dev/null", 0.01);
    count_whole("run, start to end", "lua/examples/01_transfer.lua", 42e6);
    time_page("tool, its page", "build/waferhand run lua/examples/27_tool.lua >/dev/null", 0.3);
    time_run_of("study, 10,000 trials",
                "build/waferhand study lua/examples/07_study.lua --trials 10000 >/dev/null", 0.9);
    time_run_of("study, 100 with collisions",
                "build/waferhand study tests/bench/study_efem.lua --trials 100 >/dev/null", 2);
    time_counted("counted, a long series",
                 "build/waferhand run lua/examples/20_series.lua --set p=100 --set lot=22 >/dev/null", 5);
    time_counted("counted, passive pads",
                 "build/waferhand run tests/bench/hour.lua --set seconds=900 --brief >/dev/null", 1.5);
    count_each("counted, a command", LOOP, 100, 300, 0.7e6);
    /* Robots with axes: 40 carriers of 25 wafers come and go. */
    time_run_of("real flow, 1,000, seat", REAL_FLOW " --set seat=true >/dev/null", 5);
    time_run_of("real flow, 1,000 wafers", REAL_FLOW " >/dev/null", 5);
    /* Two robots, two locks, six modules, all by times alone. */
    time_run_of("flow, 10,000 wafers", FLOW " >/dev/null", 0.2);
    count_each("flow, a wafer", "tests/bench/flow.lua --brief --set wafers=", 1000, 3000, 60e3);
    race_simpy("flow, against SimPy", 8);
    time_run_of("a week, its page", "build/waferhand run tests/bench/week.lua --report " PAGE " >/dev/null",
                10);
    time_reading("csv, of the tool's log", "csv -o", 4);
    time_reading("report, of the tool's log", "report -o", 0);
    count_step("step, 2 wafers", "step indexed 2 idle", 400);
    count_step("step, 2, turning", "step indexed 2 turning", 400);
    count_step("step, 2, carrying", "step indexed 2 carry", 400);
    count_step("step, 100 wafers", "step indexed 100 idle", 400);
    count_step("step, 100, turning", "step indexed 100 turning", 400);
    count_step("step, 100, carrying", "step indexed 100 carry", 400);
    time_estimate("estimate, 3600 samples", 300);
    return bench_end();
}
