/* Scans of wafers' edges: collects them from the states and estimates each.
 *
 * Each state carries the samples of its own slice (sim/scanning.h). States that come twice add nothing;
 * missing states leave samples WH_NONE, which are counted. A scan that goes on at the run's end has the
 * samples up to there.
 */
#ifndef WH_RECORD_SCANS_H
#define WH_RECORD_SCANS_H

#include "../align/align.h"
#include "../layout/layout.h"
#include "../sim/scanning.h"
#include "record.h"

/* The most samples of all scans that a run keeps; scans that begin later are only counted. */
#define WH_SCANS_SAMPLES 500000

typedef struct {
    int64_t first_slice, last_slice; /* slice of its arming, slice of its last sample so far */
    uint32_t number;                 /* within the run, from 1 */
    int32_t gripper;                 /* the chuck's */
    int32_t count;                   /* ordered; below 0 the chuck turned clockwise */
    int64_t first;                   /* number of the first sample */
    int32_t taken;                   /* so far */
    int32_t missed;                  /* the missing ones, whose states never came: they are WH_NONE */
    int32_t *samples;                /* `taken` of them: dark pixels */
} wh_edge_scan_t;

/* Zero it at the beginning. Read only. */
typedef struct {
    wh_edge_scan_t *list;
    size_t count, capacity;
    size_t samples;  /* the room for them */
    size_t left_out; /* scans beyond the limit */
    uint32_t number; /* of the last scan heard of */
} wh_edge_scans_t;

/* Adds the samples in the state of a later slice. Cost: none for a slice without a scan. */
void wh_edge_scans_hear(wh_edge_scans_t *scans, int64_t slice, const wh_scan_t *scan);

/* Frees all scans and zeroes it. */
void wh_edge_scans_close(wh_edge_scans_t *scans);

/* A sample as the estimate uses it. */
typedef struct {
    double angle;    /* the sensor's direction, chuck's frame, 0 to 2 pi */
    double radius;   /* from the axis to the rim, mm; NaN where it is not seen or the sample is missing */
    double residual; /* distance of the rim outside of the fitted circle, mm; NaN without one */
    bool counts;     /* true if it counts for the circle: false in notches, flats, chips */
} wh_edge_point_t;

/* The scan's command says this about the wafer. All zero: it says nothing. */
typedef struct {
    bool without_mark; /* the mark is not searched */
    double glass;      /* the part of the light that passes the wafer */
} wh_edge_wish_t;

/* Reads a command's text, such as "ALIGN P mark=none glass=0.3"; null: nothing. */
wh_edge_wish_t wh_edge_wish_of(const char *command);

/* Reads the record's last command that began at or before this time, s. */
wh_edge_wish_t wh_edge_wish_at(const wh_record_t *record, double begin_s);

/* The nominal rim, changed as the command says. */
wh_rim_t wh_edge_wish_rim(const wh_rim_t *nominal, wh_edge_wish_t wish);

/* Estimates a scan by `wh_align_estimate`. It uses the layout's sensor without its errors, and the nominal
 * wafer as the command changes it. In a scan of more than one turn the first turn counts. Missing samples,
 * and the missing part of a turn, count as hidden. Fills `samples`, scan->taken of them. Returns the status
 * of wh_align_estimate, or WH_STATUS_OUT_OF_RANGE if the layout has no such sensor; then `result` is all
 * zero. The circle's radius is 0 without a fit. */
wh_status_t wh_edge_scan_estimate(const wh_edge_scan_t *scan, const wh_layout_t *layout, wh_edge_wish_t wish,
                                  wh_edge_point_t samples[], wh_align_result_t *result);

/* The direction in which the axis sees the notch, or the middle of the flat, that gave the turn: chuck's
 * frame, 0 to 2 pi; NaN without one. */
double wh_edge_scan_mark_at(const wh_align_result_t *result);

/* The number of lines that give the result in words, for readers of its plot. */
#define WH_SCAN_LINES 5
#define WH_SCAN_LINE_BYTES 200

typedef struct {
    bool is_sure; /* everything is sure */
    /* The verdict, "sure" or "not sure: ..." with the reason; centre; notch or flat; radius; samples. */
    char lines[WH_SCAN_LINES][WH_SCAN_LINE_BYTES];
} wh_scan_words_t;

/* `status` and `result` are the results of wh_edge_scan_estimate. */
void wh_edge_scan_words(const wh_edge_scan_t *scan, wh_status_t status, const wh_align_result_t *result,
                        wh_scan_words_t *words);

#endif
