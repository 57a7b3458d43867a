/* Wafers per hour, which customers ask of a layout, computed from a run's record.
 *
 * A put is a wafer that was placed well. It was let go during a command that succeeded without complaint of
 * the cell. At the command's end it lies in a slot, or the chuck that it lies on holds it.
 *
 * A put counts as a wafer done if its station counts (wh_layout_station_t.counts); wafers put elsewhere are
 * on their way. So a wafer that goes over the prealigner, or into a process station and back, counts once,
 * at its final place.
 *
 * cycle() in a script marks where a cycle begins; it lasts to the next mark, the last one to the run's end.
 * Within a marked cycle a wafer counts once however often it is put. The first cycle is left out, because
 * it starts from home and with empty stations, unless it is the only one. Cycles without a slice, such as a
 * mark at the end, do not count. The figure is the wafers of the other cycles divided by their time.
 * Without marks every put that counts is a wafer, over the whole run.
 *
 * There is no figure where it would not mean wafers per hour: see wh_figure_t.
 */
#ifndef WH_RECORD_THROUGHPUT_H
#define WH_RECORD_THROUGHPUT_H

#include "record.h"

/* Given, or the first reason against it, in this order. */
typedef enum {
    WH_FIGURE_GIVEN,
    WH_FIGURE_NO_CELL,
    WH_FIGURE_PARTIAL, /* a log that does not have the complete run */
    WH_FIGURE_UNTOLD,  /* a log that does not tell whether the run passed */
    WH_FIGURE_FAILED,  /* the run failed, for any reason */
    WH_FIGURE_ALONE,   /* robots that are times alone carry wafers, too, in a flow, of which a log
                          does not tell */
    WH_FIGURE_NO_TIME, /* no slice was played */
    WH_FIGURE_NOWHERE, /* no station counts, or a log does not tell which ones do */
    WH_FIGURE_NO_WAFER,
    WH_FIGURE_TWICE /* without marks: a wafer was put twice where puts count (one wafer or two?) */
} wh_figure_t;

typedef struct {
    wh_figure_t figure;
    size_t puts;            /* of the run, at any place */
    size_t wafers;          /* puts that count */
    int64_t slices;         /* the time over which they count */
    double seconds;         /* that time */
    double wafers_per_hour; /* 0 if there is no figure */
    size_t first, last;     /* the marked cycles that count, from 1; 0: the whole run */
} wh_throughput_t;

/* For a record without a layout everything but the figure is zero. Cost: linear in puts, cycles, stations
 * and wafers. */
wh_throughput_t wh_throughput(const wh_record_t *record);

/* The reason why there is no figure, in a few words; null for WH_FIGURE_GIVEN. */
const char *wh_throughput_reason(wh_figure_t figure);

/* The number of wafers done in each marked cycle: an array of record->cycle_count, which the caller frees.
 * Cost as above. */
size_t *wh_throughput_cycle_wafers(const wh_record_t *record);

/* The slice with which a marked cycle (index from 0) ends. */
int64_t wh_throughput_cycle_end(const wh_record_t *record, size_t cycle);

/* The time of `slices` slices, s; 0 for a record without a layout. */
double wh_throughput_seconds(const wh_record_t *record, int64_t slices);

#endif
