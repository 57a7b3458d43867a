/* A flow in a cell with axes: the engine of lib/flow decides, lua/mcs/flow.lua plays the robots' commands,
 * and stations go by their clocks. */
#ifndef WH_MCS_FLOW_PLAYED_H
#define WH_MCS_FLOW_PLAYED_H

#include "../flow/outside.h"
#include "clocks.h"

/* An event of a station's clock that the engine has not heard yet. */
typedef struct {
    int32_t station;
    wh_clock_event_t event;
    int64_t lifted_us; /* of a wafer that was taken */
} wh_flow_heard_t;

typedef struct wh_flow_played {
    wh_mcs_t *mcs;
    wh_flow_t *flow; /* the record's */
    wh_flow_tool_t *tool;
    wh_flow_measure_t *measure; /* null: it is over, and closed */
    wh_flow_engine_t *engine;   /* of that */
    wh_flow_outside_t outside;
    int32_t *numbers; /* by wafer of the layout: that of the flow, or WH_FLOW_NONE */
    bool *is_mapped;  /* by lot */
    bool *is_taken;   /* by station: its door's shutting, or its work, is carried out */
    wh_flow_heard_t *heard;
    size_t heard_count, heard_capacity;
    bool is_due; /* something was told since the last step */
} wh_flow_played_t;

/* Lots' wafers get the names of those that lie in their slots. Raises what cannot be: a slot without a
 * wafer, a wafer in the way, a wafer in two lots. */
void wh_flow_bind_wafers(lua_State *L, wh_flow_played_t *played);

/* The time of the flow, us. */
int64_t wh_flow_played_now(const wh_flow_played_t *played);

/* Each station's clock is told to the engine: a wh_flow_outside_t. */
void wh_flow_hear(void *context, wh_flow_state_t *state);
void wh_flow_look(void *context, wh_flow_state_t *state);
bool wh_flow_pump_lock(void *context, int32_t station, wh_flow_side_t side);
void wh_flow_hold_station(void *context, int32_t station, bool is_down);

/* Nobody can go on. If that is for a process that has not begun, the state's cause says why it has not. */
void wh_flow_say_unbegun(const wh_flow_played_t *played, wh_flow_state_t *state);

/* The next wafer that comes to this place is processed as its step has it. */
void wh_flow_set_process(const wh_flow_played_t *played, int32_t wafer, int32_t place);

/* A station has told something. True if a flow judges how long its wafer stayed. */
bool wh_flow_played_hear(const wh_mcs_t *mcs, const wh_clocks_telling_t *telling,
                         const wh_clock_event_t *event);

#endif
