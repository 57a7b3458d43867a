/* Scans of wafers' edges: collected from the states, and what the estimate says of each.
 *
 * Each state carries the samples of its own slice (sim/scanning.h). States that come twice add nothing; those
 * that never came leave samples WH_NONE, which are counted. A scan that is still going on when the run ends
 * has the samples up to there.
 */
#ifndef WH_RECORD_SCANS_H
#define WH_RECORD_SCANS_H

#include "../align/align.h"
#include "../layout/layout.h"
#include "../sim/scanning.h"
#include "record.h"

/* The most samples that a run keeps, of all its scans together: scans that begin later are only counted. */
#define WH_SCANS_SAMPLES 500000

typedef struct {
    int64_t first_slice, last_slice; /* in which it was armed, and which had its last sample so far */
    uint32_t number;                 /* within the run, from 1 */
    int32_t gripper;                 /* the chuck's */
    int32_t count;                   /* ordered; below 0 the chuck turned clockwise */
    int64_t first;                   /* number of the first sample */
    int32_t taken;                   /* so far */
    int32_t missed;                  /* of them, those whose states never came: they are WH_NONE */
    int32_t *samples;                /* `taken` of them: dark pixels */
} wh_edge_scan_t;

/* Zero it to begin with. Read only. */
typedef struct {
    wh_edge_scan_t *list;
    size_t count, capacity;
    size_t samples;  /* room that they take */
    size_t left_out; /* scans that were one too many */
    uint32_t number; /* of the last one that was heard of */
} wh_edge_scans_t;

/* Adds what the state of a later slice tells. Cost: of a slice without a scan nothing. */
void wh_edge_scans_hear(wh_edge_scans_t *scans, int64_t slice, const wh_scan_t *scan);

/* Frees all scans and zeroes it. */
void wh_edge_scans_close(wh_edge_scans_t *scans);

/* A sample as the estimate takes it. */
typedef struct {
    double angle;    /* in which the sensor looked, chuck's frame, 0 to 2 pi */
    double radius;   /* from the axis to the rim, mm; NaN where it is not seen or the sample is missing */
    double residual; /* how far the rim is outside of the fitted circle, mm; NaN without one */
    bool counts;     /* for the circle: false in notches, flats, chips */
} wh_edge_point_t;

/* What the command that a scan was of has said of the wafer. Zeroed: nothing. */
typedef struct {
    bool without_mark; /* the mark is not looked for */
    double glass;      /* part of the light that comes through */
} wh_edge_wish_t;

/* By a command's text, such as "ALIGN P mark=none glass=0.3"; null: nothing. */
wh_edge_wish_t wh_edge_wish_of(const char *command);

/* By the record's last command that began at or before this time, s. */
wh_edge_wish_t wh_edge_wish_at(const wh_record_t *record, double begin_s);

/* The nominal rim as the command has the wafer. */
wh_rim_t wh_edge_wish_rim(const wh_rim_t *nominal, wh_edge_wish_t wish);

/* What `wh_align_estimate` says of a scan: by the sensor as the layout draws it, without its errors, and by
 * the nominal wafer as the command has it. Of a scan of more than one turn the first turn counts; of one with
 * missing samples, or of less than a turn, the rest of the turn is hidden. Fills `samples`, scan->taken of
 * them. Returns what wh_align_estimate does, or WH_STATUS_OUT_OF_RANGE if the layout has no such sensor; then
 * `result` is all zero. Its circle's radius is 0 where there is no fit. */
wh_status_t wh_edge_scan_estimate(const wh_edge_scan_t *scan, const wh_layout_t *layout, wh_edge_wish_t wish,
                                  wh_edge_point_t samples[], wh_align_result_t *result);

/* In which direction the axis sees the notch, or the middle of the flat, that told the turn: chuck's frame, 0
 * to 2 pi; NaN without one. */
double wh_edge_scan_mark_at(const wh_align_result_t *result);

/* The same result in words, for whoever looks at a plot of it. */
#define WH_SCAN_LINES 5
#define WH_SCAN_LINE_BYTES 200

typedef struct {
    bool is_sure; /* all of it */
    /* The verdict, "sure" or "not sure: ..." with the reason; centre; notch or flat; radius; samples. */
    char lines[WH_SCAN_LINES][WH_SCAN_LINE_BYTES];
} wh_scan_words_t;

/* `status` and `result` are what wh_edge_scan_estimate gave. */
void wh_edge_scan_words(const wh_edge_scan_t *scan, wh_status_t status, const wh_align_result_t *result,
                        wh_scan_words_t *words);

#endif
