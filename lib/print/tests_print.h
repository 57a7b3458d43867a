/* The results of many scripts: a line for each, the sum, TAP and JUnit's XML.
 *
 *     ok           cell.lua: 2 expectations, 8.283 s simulated
 *     failed       tilt.lua: line 7: Wafer 1 held by EE: nobody holds it
 *     passed over  paper.lua: a layout: waferhand layout paper.lua
 *
 * A script's output follows, indented, if its verdict is a bad one. If a script is ok, the errors that it
 * caught are counted in its line, in a comment of TAP, and in JUnit's system-out. Faults and errors on
 * purpose that did not come are named below its line, in a comment of TAP, and in JUnit's system-out. Text is
 * adapted to its target: control characters stand as \xNN, and in XML each byte that is no UTF-8, and each
 * character that XML cannot hold, is U+FFFD.
 */
#ifndef WH_PRINT_TESTS_PRINT_H
#define WH_PRINT_TESTS_PRINT_H

#include <stdint.h>

#include "../text/style.h"

typedef enum {
    WH_TEST_OK,         /* as of `run`; and it moved or expected something */
    WH_TEST_FAILED,     /* as of `run`; or nothing moves in it and it expects nothing */
    WH_TEST_BAD,        /* script, layout or parameter cannot be used */
    WH_TEST_ENDLESS,    /* it did not end in its time, and was ended */
    WH_TEST_KILLED,     /* a signal ended it */
    WH_TEST_PASSED_OVER /* found in a folder, and no script */
} wh_test_verdict_t;

#define WH_TEST_VERDICTS 6

typedef struct {
    const char *path;
    wh_test_verdict_t verdict;
    char *reason; /* null if it is ok */
    char *output; /* its output, with standard error; null: nothing */
    uint64_t expectations;
    uint64_t errors; /* of commands; a script that is ok caught them all */
    double simulated_s, wall_s;
    uint64_t hash;    /* of the run */
    bool is_unlooked; /* it was played, and nobody looked for collisions */
    bool is_timed;    /* nor at places and ways: its robots are times alone */
    bool has_timed;   /* some of them are, beside robots with axes */
    bool is_cut;      /* its flow was cut with wafers not at their ends */
    char *never_came; /* the faults and errors on purpose that did not come; null: none */
} wh_test_result_t;

/* In words: "ok", "failed", "bad", "no end", "killed", "passed over". */
const char *wh_test_word(wh_test_verdict_t verdict);

/* True for those that make a test fail. */
bool wh_test_is_bad(wh_test_verdict_t verdict);

/* A result's line, and the script's output. */
void wh_test_print(const wh_test_result_t *result, FILE *out, const wh_style_t *style);

/* A result as TAP 13: `number` counts up from 1; a file that was passed over is a comment and has no number.
 * Then the plan, which TAP allows at the end. */
void wh_test_print_tap(const wh_test_result_t *result, size_t number, FILE *out);
void wh_test_print_plan(const wh_test_result_t results[], size_t count, size_t scripts, FILE *out);

/* The sum: "3 scripts: 2 ok, 1 failed; 1 file passed over"; before it, in how many of them collisions were
 * not looked for. In TAP that is a comment before the plan. */
void wh_test_print_sum(const wh_test_result_t results[], size_t count, FILE *out, const wh_style_t *style);

/* All of them as one suite of JUnit's XML: FAILED is a failure; BAD, ENDLESS and KILLED are errors;
 * PASSED_OVER is skipped. False if `out` does not take it. */
bool wh_test_print_junit(const wh_test_result_t results[], size_t count, FILE *out);

#endif
