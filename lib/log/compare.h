/* Compares two recorded runs slice by slice, and finds the first slice and field that differ, bit
 * for bit. */
#ifndef WH_LOG_COMPARE_H
#define WH_LOG_COMPARE_H

#include "log_run.h"
#include "slice_fields.h"

/* For each slice of a run its number, and a digest over all fields and the state's hash. Zero it at
 * first. */
typedef struct {
    struct wh_log_digest {
        int64_t seq;
        uint64_t digest;
    } * slices;
    size_t count, capacity;
    wh_slice_row_t row; /* the reader's */
} wh_log_digests_t;

#define WH_COMPARE_VALUE 96

typedef struct {
    int64_t common, differing;        /* slices that both have; those of them that differ */
    int64_t only[2];                  /* slices that only one of them has */
    int64_t slice;                    /* the first that differs, or that only one has; 0: none */
    double time_s;                    /* its end */
    char field[WH_SLICE_FIELD_NAME];  /* "slice", if one of them does not have it */
    char values[2][WH_COMPARE_VALUE]; /* in words; numbers with enough digits to read back equal */
} wh_compare_t;

/* Reads a run as wh_log_run_read does, and keeps its digests. It sets the options' listener. */
bool wh_compare_read(wh_log_run_t *run, wh_log_run_options_t *options, wh_log_digests_t *digests);

/* Compares two runs read like this. If a slice differs, both logs are read once more up to it. False, and
 * the reason in `message` of the failed run, if that did not work. Cost: linear in the slices. */
bool wh_compare_runs(wh_log_run_t *const runs[2], const wh_log_digests_t digests[2], wh_compare_t *found);

/* True if slices of these layouts have the same fields, by name and in order. */
bool wh_compare_fields_fit(const wh_layout_t *a, const wh_layout_t *b);

void wh_log_digests_free(wh_log_digests_t *digests);

#endif
