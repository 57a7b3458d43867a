/* A flow in a cell with axes: the engine of lib/flow decides, lua/mcs/flow.lua plays the robots' commands,
 * and stations go by their clocks. */
#ifndef WH_MCS_FLOW_PLAYED_H
#define WH_MCS_FLOW_PLAYED_H

#include "../flow/outside.h"
#include "clocks.h"

/* The bytes of the text of a stall. */
#define WH_FLOW_STALL_BYTES 500

/* An event of a station's clock that the engine has not heard yet. */
typedef struct {
    int32_t station;
    wh_clock_event_t event;
    int64_t lifted_us; /* of a wafer that was taken */
} wh_flow_heard_t;

/* A place that a robot which is times alone has emptied, or filled. */
typedef struct {
    int32_t place;
    bool is_filled;
} wh_flow_carried_t;

/* A wafer that a robot which is times alone may carry. */
typedef struct {
    int32_t found;             /* the layout's wafer */
    wh_pose_t slot_from_wafer; /* as it lay in the last slot, and will in the next one */
} wh_flow_aboard_t;

/* How long a station is waited for, because on_error has said so. */
typedef struct {
    int64_t until_us; /* of the flow */
    int32_t asked;    /* how often it was waited for longer */
} wh_flow_patience_t;

/* Something in a station that takes too long, or does not begin. */
typedef struct {
    int32_t station;    /* WH_FLOW_NONE: nothing does */
    const char *action; /* "process", "clean" or "pump" */
    char text[WH_FLOW_STALL_BYTES];
} wh_flow_stall_t;

typedef struct wh_flow_played {
    wh_mcs_t *mcs;
    wh_flow_t *flow; /* the record's */
    wh_flow_tool_t *tool;
    wh_flow_measure_t *measure; /* null: it is over, and closed */
    wh_flow_engine_t *engine;   /* of that */
    wh_flow_outside_t outside;
    int32_t *numbers; /* by wafer of the layout: that of the flow, or WH_FLOW_NONE */
    bool *is_mapped;  /* by lot */
    bool *is_taken;   /* by station: its door's shutting, its work, or its port's call is carried out */
    wh_flow_aboard_t *aboard; /* by wafer of the flow, as robots that are times alone carry them */
    int32_t *carriers;        /* by call: the layout's carrier that brought its lots, or WH_NONE */
    wh_flow_heard_t *heard;
    size_t heard_count, heard_capacity;
    bool is_due;                /* something was told since the last step */
    wh_flow_carried_t *carried; /* what robots that are times alone have done, and nobody has noted yet */
    size_t carried_count, carried_capacity, noted_count;
    int32_t waited;               /* slices in which the simulator had no room for a wafer's order */
    wh_flow_stall_t stall;        /* that nobody has asked on_error of yet */
    wh_flow_patience_t *patience; /* by station */
} wh_flow_played_t;

/* Lots' wafers get the names of those that lie in their slots. Raises what cannot be: a slot without a
 * wafer, a wafer in the way, a wafer in two lots. */
void wh_flow_bind_wafers(lua_State *L, wh_flow_played_t *played);

/* By place of the tool the layout's wafer that lies there, or WH_FLOW_NONE. The caller frees it. */
int32_t *wh_flow_find_lying(const wh_flow_played_t *played);

/* A carrier has come: its lot's wafer is the one that lies in its first place, if there is one. False: that
 * one is another wafer of the flow; what is wrong is pushed. */
bool wh_flow_bind_late(lua_State *L, const wh_flow_played_t *played, const int32_t lying[],
                       const wh_flow_wafer_t *wafer);

/* False if a wafer that no lot has lies in this place, where wafers of lots go: that is pushed. */
bool wh_flow_check_stranger(lua_State *L, const wh_flow_played_t *played, const int32_t lying[],
                            int32_t place);

/* The layout's carrier that stands open at the load port, or WH_NONE. */
int32_t wh_flow_carrier_at(const wh_flow_played_t *played, int32_t station);

/* Each load port is told to the engine. */
void wh_flow_look_at_ports(const wh_flow_played_t *played, wh_flow_state_t *state);

/* The time of the flow, us. */
int64_t wh_flow_played_now(const wh_flow_played_t *played);

/* Each station's clock is told to the engine: a wh_flow_outside_t. */
void wh_flow_hear(void *context, wh_flow_state_t *state);
void wh_flow_look(void *context, wh_flow_state_t *state);
bool wh_flow_pump_lock(void *context, int32_t station, wh_flow_side_t side);
void wh_flow_hold_station(void *context, int32_t station, bool is_down);

/* Nobody can go on. True if that is for a process that has not begun, and whose station is waited for: either
 * on_error has said so, or it is to be asked of the stall, which says why it has not begun. */
bool wh_flow_find_unbegun(wh_flow_played_t *played, const wh_flow_state_t *state);

/* The station is waited for as long again. False if that was so too often. */
bool wh_flow_wait_on(wh_flow_played_t *played, int32_t station);

/* The next wafer that comes to this place is processed as its step has it. */
void wh_flow_set_process(const wh_flow_played_t *played, int32_t wafer, int32_t place);

/* The flow is over: wafers that come later are processed as the layout has it. */
void wh_flow_forget_processes(const wh_flow_played_t *played);

/* Robots that are times alone: flow_timed.c. A wafer that one picks leaves the cell with the slice in which
 * that ends, and comes back with the one in which its placing ends, by orders to the simulator. */

void wh_flow_timed_open(wh_flow_played_t *played);
void wh_flow_timed_close(wh_flow_played_t *played);

/* Before the engine's step: what ends now waits a slice longer if the simulator has not carried it out. */
void wh_flow_timed_wait(wh_flow_played_t *played);

/* Behind it: stations see what has begun. */
void wh_flow_timed_begin(const wh_flow_played_t *played);

/* Adds orders to the command of the slice that goes out. If something is not as it must be, the flow ends by
 * its cause. */
void wh_flow_timed_send(wh_mcs_t *mcs);

/* The use that such a robot makes now of a station, and of its slot, from 0. */
typedef struct {
    bool is_inside; /* in any slot of the station */
    bool takes, brings;
} wh_flow_use_t;
wh_flow_use_t wh_flow_timed_use(const wh_mcs_t *mcs, int32_t station, int32_t slot);

/* A station has told something. True if a flow judges how long its wafer stayed. */
bool wh_flow_played_hear(const wh_mcs_t *mcs, const wh_clocks_telling_t *telling,
                         const wh_clock_event_t *event);

#endif
