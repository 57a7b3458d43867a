/* The history of a flow's wafers, kept in the figures: their visits, and what stations and real doors did
 * beside them. */
#ifndef WH_FLOW_HISTORY_H
#define WH_FLOW_HISTORY_H

#include "figures.h"

/* Zero: nothing is kept, and no function below does anything. */
typedef struct {
    wh_flow_figures_t *figures;
    int32_t *visits;       /* by wafer: the index of its last one, or WH_FLOW_NONE */
    wh_flow_visit_t *open; /* by wafer: the transfer that runs */
    bool keeps_ways;
} wh_flow_history_t;

void wh_flow_history_open(wh_flow_history_t *history, wh_flow_figures_t *figures, size_t wafers,
                          bool keeps_ways);
void wh_flow_history_close(wh_flow_history_t *history);

/* A wafer is taken: its stay has ended. */
void wh_flow_history_take(wh_flow_history_t *history, const wh_flow_state_t *state,
                          const wh_flow_event_t *stay);

/* A placing, or a swap, has brought this wafer into its place; `is_end`: at the end of its route. */
void wh_flow_history_place(wh_flow_history_t *history, const wh_flow_state_t *state,
                           const wh_flow_event_t *event, int32_t wafer, bool is_end);

/* The wafer's route ends where it lies. */
void wh_flow_history_shorten(wh_flow_history_t *history, int32_t wafer);

/* Any event: what else it tells of a visit, and what happened beside those. */
void wh_flow_history_hear(wh_flow_history_t *history, const wh_flow_event_t *event);

/* The flow ends. */
void wh_flow_history_end(wh_flow_history_t *history, const wh_flow_state_t *state);

#endif
