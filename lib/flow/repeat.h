/* A flow in which nobody makes progress though it does not stand still: robots go to and fro without a wafer,
 * or locks turn. Once its state has come again nothing else can ever happen. */
#ifndef WH_FLOW_REPEAT_H
#define WH_FLOW_REPEAT_H

#include "state.h"

/* All zero before the first instant. */
typedef struct {
    int64_t *states; /* since anything was under way, each once, relative to its instant */
    size_t length, count, capacity;
    size_t times; /* how often one of them has come again */
    bool is_anew; /* at the last instant something was under way, or to come */
} wh_flow_repeat_t;

/* To be called behind each instant. True if nothing is under way, nothing is still to come by itself, and the
 * state is that of an earlier instant with nothing between but empty ways and pumps. A function as rule may
 * change its mind, so that states must come again many times. Cost: linear in robots and stations, times the
 * instants since anything was under way. */
bool wh_flow_repeats(wh_flow_repeat_t *repeat, const wh_flow_state_t *state);

/* Forgets the states before. */
void wh_flow_repeat_anew(wh_flow_repeat_t *repeat);
void wh_flow_repeat_close(wh_flow_repeat_t *repeat);

#endif
