/* Two recorded runs, slice by slice: the first slice and field that differ, bit for bit. */
#ifndef WH_LOG_COMPARE_H
#define WH_LOG_COMPARE_H

#include "log_run.h"
#include "slice_fields.h"

/* Of each run's slices: their numbers and digests over all fields and the state's hash. Zero it to begin
 * with. */
typedef struct {
    struct wh_log_digest {
        int64_t seq;
        uint64_t digest;
    } * slices;
    size_t count, capacity;
    double *values; /* the reader's */
} wh_log_digests_t;

#define WH_COMPARE_VALUE 96

typedef struct {
    int64_t common, differing;        /* slices that both have; of these, such as differ */
    int64_t only[2];                  /* that one of them alone has */
    int64_t slice;                    /* the first that differs, or that one alone has; 0: none */
    double time_s;                    /* its end */
    char field[WH_SLICE_FIELD_NAME];  /* "slice", if one of them has it not */
    char values[2][WH_COMPARE_VALUE]; /* in words; numbers with the digits that read back as the same */
} wh_compare_t;

/* Reads a run as wh_log_run_read does, and keeps its digests. The options' listener is set by this. */
bool wh_compare_read(wh_log_run_t *run, wh_log_run_options_t *options, wh_log_digests_t *digests);

/* Compares two runs so read; where a slice differs both logs are read up once more. False, and `message` of
 * the run that failed says why, if that did not work. Cost: linear in the slices. */
bool wh_compare_runs(wh_log_run_t *const runs[2], const wh_log_digests_t digests[2], wh_compare_t *found);

void wh_log_digests_free(wh_log_digests_t *digests);

#endif
