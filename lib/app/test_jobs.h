/* Scripts played side by side, each in a process of its own: one that crashes, or that never ends, is one
 * result among the others. */
#ifndef WH_APP_TEST_JOBS_H
#define WH_APP_TEST_JOBS_H

#include "../mcs/script_run.h"
#include "../print/tests_print.h"

/* The most output of a script. If it prints more, SIGXFSZ ends it, and the rest is not shown. */
#define WH_TEST_OUTPUT_BYTES ((size_t)16 << 20)

/* A script to play. */
typedef struct {
    const char *path;
    bool was_found; /* found in a folder: a file that is no script is passed over */
} wh_test_job_t;

#define WH_TEST_OUTPUTS 2

typedef struct {
    wh_script_run_options_t run;          /* of each; its script is set here */
    size_t processes;                     /* at a time, at least 1 */
    double timeout_s;                     /* of each */
    const char *outputs[WH_TEST_OUTPUTS]; /* files that no script may read, because they will be written;
                                           * null: none */
    bool needs_expectations;              /* a script that expects nothing has failed */
    /* Called with each result in the order of the jobs, as soon as it and all before it are there. */
    void (*listener)(void *user, const wh_test_result_t *result);
    void *user;
} wh_test_options_t;

/* Plays them all. `results` has `count` places, which wh_test_results_free empties. The output of a script is
 * kept with its result. False, and standard error says why, if the system gives no process or no temporary
 * file, or if a job reads one of `outputs`; results until then have been told. No other child of this process
 * may end meanwhile. */
bool wh_test_play(const wh_test_job_t jobs[], size_t count, const wh_test_options_t *options,
                  wh_test_result_t results[]);

void wh_test_results_free(wh_test_result_t results[], size_t count);

#endif
