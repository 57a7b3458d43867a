/* The engine of a flow, instant by instant. wh_flow_play drives it by events; a cell with axes by its slices,
 * while it tells what real robots and stations have done: see outside.h. */
#ifndef WH_FLOW_ENGINE_H
#define WH_FLOW_ENGINE_H

#include "flow.h"
#include "repeat.h"
#include "rules.h"
#include "steadily.h"

/* Read `state`, `is_over` and `end`; the rest is internal. Must not be moved once it is open. */
typedef struct {
    wh_flow_state_t state;
    bool is_over;
    wh_flow_end_t end; /* once it is over */
    wh_flow_rules_t rules;
    wh_flow_repeat_t repeat;
    wh_flow_listener_t listener;
    int64_t *ends_us; /* of the last placings of wafers that count */
    size_t count, capacity;
    size_t looked;                /* how many of them there were when it was seen whether it is steady */
    wh_flow_steadily_t *steadily; /* null: nobody asks */
    int32_t period;               /* of wafers, once it is steady; 0: it is not known to be */
    int64_t cycle_us;             /* of so many */
    uint64_t asked;
} wh_flow_engine_t;

/* At time 0, before its instant. All that is given must outlive the engine; the listener, which is copied,
 * and `outside` may be null. Close it in any case. */
void wh_flow_engine_open(wh_flow_engine_t *engine, const wh_flow_tool_t *tool, const wh_flow_plan_t *plan,
                         const wh_flow_listener_t *listener, const wh_flow_outside_t *outside);

/* Plays this instant, at or after the last one. Returns the next one at which something ends or begins by
 * itself; WH_FLOW_NEVER: nothing does. Unless the flow is over then, step again at that time, and whenever
 * something has been told. */
int64_t wh_flow_engine_step(wh_flow_engine_t *engine, int64_t now_us);

/* Fills the result once it is over, and tells the listener's `end`. The caller closes the result. */
void wh_flow_engine_result(wh_flow_engine_t *engine, wh_flow_result_t *result);

void wh_flow_engine_close(wh_flow_engine_t *engine);

#endif
