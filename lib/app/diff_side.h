/* One of the two that `waferhand diff` compares: a log, or what --json or --data made, as JSON. */
#ifndef WH_APP_DIFF_SIDE_H
#define WH_APP_DIFF_SIDE_H

#include <jansson.h>

#include "../log/compare.h"
#include "../text/options.h"

typedef struct {
    const char *path;
    const wh_option_list_t *parameters;
    bool is_log;
    json_t *root;
    wh_log_run_t *run; /* null: JSON */
    wh_log_digests_t digests;
} wh_diff_side_t;

/* The fields that do not belong to the run itself: how long it took, where files lie, which program made it,
 * and what motion control alone knows. Null ends them. */
extern const char *const wh_diff_aside[];

/* Finds out what the side's file is, and reads it if it is JSON. False, and standard error says why. */
bool wh_diff_side_open(wh_diff_side_t *side);

/* Reads this run of a log, from 1, into `run` and `root`. A log that lacks something is never equal to
 * another: false, and standard error says why. */
bool wh_diff_side_read(wh_diff_side_t *side, size_t number);

/* Forgets what was read. */
void wh_diff_side_close(wh_diff_side_t *side);

/* True for two logs, two results, or two files of --data; else false, and standard error says so. */
bool wh_diff_sides_are_alike(const wh_diff_side_t sides[2]);

#endif
