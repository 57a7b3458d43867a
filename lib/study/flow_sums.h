/* How the figures of a flow spread over trials: makespan, cycle, wafers per hour; how long robots waited, all
 * together, and done wafers; and how many stays were longer than their stations' windows.
 *
 * Times that are drawn seldom repeat: where there is no steady cycle it is the mean time between two wafers'
 * ends, over their middle third.
 *
 * Sums are of how far a trial's figure is from that of the run without errors, divided by 1024: so they are
 * exact to a microsecond, and a percentile is within 1/128 of that difference. Adding is commutative to the
 * last bit, as in sum.h. */
#ifndef WH_STUDY_FLOW_SUMS_H
#define WH_STUDY_FLOW_SUMS_H

#include "../flow/figures.h"
#include "sum.h"

typedef enum {
    WH_FLOW_SUM_MAKESPAN,
    WH_FLOW_SUM_CYCLE,
    WH_FLOW_SUM_PER_HOUR,
    WH_FLOW_SUM_ROBOTS_WAIT,
    WH_FLOW_SUM_WAFERS_WAIT,
    WH_FLOW_SUM_LATE
} wh_flow_sum_t;
#define WH_FLOW_SUM_FIGURES 6

/* Those at the beginning that are related with what is drawn. */
#define WH_FLOW_SUM_RELATED 3

/* "makespan_s", "cycle_s", "per_hour", "robots_wait_s", "wafers_wait_s", "late_stays" */
extern const char *const wh_flow_sum_names[];

/* To be zeroed. */
typedef struct {
    uint64_t trials;     /* whose flow was read */
    uint64_t unfinished; /* of them: the flow was stuck, broken or cut, or lost wafers; without a makespan */
    uint64_t unsteady;   /* of them: the cycle is a mean, for ends do not repeat */
    uint64_t no_cycle;   /* of them: too few wafers, or no good end; without cycle and rate */
    uint64_t clipped;    /* of them: a process was drawn shorter than 0 s, and took 1 us */
    wh_sum_t of[WH_FLOW_SUM_FIGURES];
} wh_flow_sums_t;

/* The sums' unit, in a figure's own. */
#define WH_FLOW_SUM_SCALE 1024.0

/* Fills in the figures: s, s, wafers per hour, s, s, a number; NaN for one that the flow does not have. Null:
 * no flow was played, and all are NaN. True if the cycle is a steady one. */
bool wh_flow_sums_read(const wh_flow_t *flow, double figures[WH_FLOW_SUM_FIGURES]);

/* True if a wafer of the flow may meet a process of the station that would be shorter than 0 s, by what the
 * trial has drawn. */
bool wh_flow_sums_clips(const wh_flow_t *flow, size_t station, double drawn_s);

/* How far a trial's figure is from that of the run without errors, as it is summed. */
double wh_flow_sums_aside(const double figures[], const double without[], wh_flow_sum_t figure);

/* Adds a trial's figures; `without` are those of the run without errors, of which a NaN counts as 0. */
void wh_flow_sums_add(wh_flow_sums_t *sums, const double figures[], const double without[], bool is_steady,
                      bool is_clipped_once);
void wh_flow_sums_merge(wh_flow_sums_t *sums, const wh_flow_sums_t *other);

/* The figures of sum.h, in the figure's own unit. */
typedef struct {
    double mean, deviation, least, most;
} wh_flow_spread_t;
wh_flow_spread_t wh_flow_sums_spread(const wh_flow_sums_t *sums, wh_flow_sum_t figure,
                                     const double without[]);
double wh_flow_sums_quantile(const wh_flow_sums_t *sums, wh_flow_sum_t figure, const double without[],
                             uint32_t permille);

#endif
