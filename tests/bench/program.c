/* What needs no peer: how much faster than real time the program plays the transfer run and a tool, how many instructions a step
 * takes, as callgrind counts them, and how long the estimate of a scan does. To be started at the root, after
 * `make all tests`. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/harness.h"
#include "bench/ours.h"

enum { RUNS = 41, FEW_RUNS = 5 };

/* The first number after `key` in what a command prints; the command's own complaints are shown. Negative: there is none. */
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

/* By the thousand, which makes of the harness's nanoseconds microseconds. */
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

int main(int argc, char **argv) {
    bench_begin("program", "", argc, argv);
    bench_note(
        "`waferhand run` on the transfer run and on the tool of example 27 with 1 ms slices, by its own "
        "clock; a step counted by callgrind");
    time_run("run, real time", "01_transfer", RUNS, 5000);
    /* Two robots, with collisions looked for between all parts, and the smallest gaps. */
    time_run("tool, real time", "27_tool", FEW_RUNS, 300);
    count_step("step, 2 wafers", "step indexed 2 idle", 400);
    count_step("step, 2, turning", "step indexed 2 turning", 400);
    count_step("step, 2, carrying", "step indexed 2 carry", 400);
    count_step("step, 100 wafers", "step indexed 100 idle", 400);
    count_step("step, 100, turning", "step indexed 100 turning", 400);
    count_step("step, 100, carrying", "step indexed 100 carry", 400);
    time_estimate("estimate, 3600 samples", 300);
    return bench_end();
}
