/* Figures that a customer asks of a layout, computed from a run's record: wafers per hour.
 *
 * A put is a wafer set down well: let go during a command that succeeded and of which the cell had no
 * complaint, and at the command's end lying in a slot, or held by the chuck that it lies on.
 *
 * Which puts count as a wafer done depends on where wafers end up. The record's puts are ranked by their
 * station: a FOUP before another station with several slots, that before one with a single slot, that before
 * a prealigner. Of the highest rank that the run has puts of, those count; what is put elsewhere is on its
 * way. So a wafer that goes over the prealigner, or into a process station and back, counts once, when it
 * comes to rest.
 *
 * cycle() in a script marks where a cycle begins; it lasts to the next mark, the last one to the run's end.
 * Within a marked cycle a wafer counts once however often it is put. The first cycle is left out, since it
 * starts from home and with empty stations, unless it is the only one; cycles without a slice, such as a mark
 * at the end, are none. The figure is the wafers of the others over their time. Without marks every put of
 * that rank counts, over the whole run.
 */
#ifndef WH_RECORD_THROUGHPUT_H
#define WH_RECORD_THROUGHPUT_H

#include "record.h"

/* Where wafers end up, in rising order. */
typedef enum {
    WH_RANK_NONE, /* nothing was put anywhere */
    WH_RANK_PREALIGNER,
    WH_RANK_SINGLE,
    WH_RANK_SEVERAL,
    WH_RANK_FOUP
} wh_rank_t;

typedef struct {
    wh_rank_t rank;
    size_t puts;            /* of the run, of every rank */
    size_t wafers;          /* that count */
    int64_t slices;         /* over which they count */
    double seconds;         /* the same */
    double wafers_per_hour; /* 0 if there is no time */
    size_t first, last;     /* the marked cycles over which they count, from 1; 0: the whole run */
} wh_throughput_t;

/* All zero for a record without a layout. Cost: linear in puts, cycles and wafers. */
wh_throughput_t wh_throughput(const wh_record_t *record);

/* How many wafers are done in each marked cycle, for puts of this rank: an array of record->cycle_count, to
 * be freed. Cost and memory as above. */
size_t *wh_throughput_cycle_wafers(const wh_record_t *record, wh_rank_t rank);

/* The slice with which a marked cycle (index from 0) ends. */
int64_t wh_throughput_cycle_end(const wh_record_t *record, size_t cycle);

/* Seconds that so many slices take; 0 for a record without a layout. */
double wh_throughput_seconds(const wh_record_t *record, int64_t slices);

/* Which puts count as wafers, in words; null for WH_RANK_NONE. */
const char *wh_throughput_rule(wh_rank_t rank);

#endif
