/* A figure that a customer asks of a layout, computed from a run's record: wafers per hour.
 *
 * A put is a wafer set down well: let go during a command that succeeded and of which the cell had no
 * complaint, and at the command's end lying in a slot, or held by the chuck that it lies on.
 *
 * A put counts as a wafer done if its station counts (wh_layout_station_t.counts): what is put elsewhere is
 * on its way. So a wafer that goes over the prealigner, or into a process station and back, counts once, when
 * it comes to rest.
 *
 * cycle() in a script marks where a cycle begins; it lasts to the next mark, the last one to the run's end.
 * Within a marked cycle a wafer counts once however often it is put. The first cycle is left out, since it
 * starts from home and with empty stations, unless it is the only one; cycles without a slice, such as a mark
 * at the end, are none. The figure is the wafers of the others over their time. Without marks every put that
 * counts is a wafer, over the whole run.
 *
 * There is no figure where it would not be wafers per hour: see wh_figure_t.
 */
#ifndef WH_RECORD_THROUGHPUT_H
#define WH_RECORD_THROUGHPUT_H

#include "record.h"

/* If there is a figure; else the first reason, in this order. */
typedef enum {
    WH_FIGURE_GIVEN,
    WH_FIGURE_NO_CELL,
    WH_FIGURE_PARTIAL, /* a log that has not the whole run as it was */
    WH_FIGURE_UNTOLD,  /* a log that does not tell if the run passed */
    WH_FIGURE_FAILED,  /* the run failed, for whatever reason */
    WH_FIGURE_NO_TIME, /* no slice was played */
    WH_FIGURE_NOWHERE, /* no station counts, or a log does not tell which ones do */
    WH_FIGURE_NO_WAFER,
    WH_FIGURE_TWICE /* without marks: a wafer was put twice where puts count; is it one wafer, or two? */
} wh_figure_t;

typedef struct {
    wh_figure_t figure;
    size_t puts;            /* of the run, wherever to */
    size_t wafers;          /* that count */
    int64_t slices;         /* over which they count */
    double seconds;         /* the same */
    double wafers_per_hour; /* 0 if there is no figure */
    size_t first, last;     /* the marked cycles over which they count, from 1; 0: the whole run */
} wh_throughput_t;

/* All zero but the figure for a record without a layout. Cost: linear in puts, cycles, stations and
 * wafers. */
wh_throughput_t wh_throughput(const wh_record_t *record);

/* Why there is no figure, in a few words; null for WH_FIGURE_GIVEN. */
const char *wh_throughput_reason(wh_figure_t figure);

/* How many wafers are done in each marked cycle: an array of record->cycle_count, to be freed. Cost as
 * above. */
size_t *wh_throughput_cycle_wafers(const wh_record_t *record);

/* The slice with which a marked cycle (index from 0) ends. */
int64_t wh_throughput_cycle_end(const wh_record_t *record, size_t cycle);

/* Seconds that so many slices take; 0 for a record without a layout. */
double wh_throughput_seconds(const wh_record_t *record, int64_t slices);

#endif
