/* A tool as a script's functions see it while they are called: userdata that read the engine's state, so that
 * no question costs a copy of the tool. */
#ifndef WH_MCS_FLOW_SEEN_H
#define WH_MCS_FLOW_SEEN_H

#include <lua.h>

#include "../flow/transfer.h"

/* The most transfers that one question offers. */
#define WH_FLOW_SEEN_CHOICES 256

/* A transfer that the robot could carry out, now or later. */
typedef struct {
    wh_flow_target_t target;
    int64_t begin_us, there_us;
    int32_t wafer;
} wh_flow_choice_t;

/* It begins a userdata, and all parts that a script sees share it. The owner sets the first four. */
typedef struct {
    const wh_flow_tool_t *tool;
    const wh_flow_plan_t *plan;
    const wh_flow_state_t *state; /* null but while a function is called */
    const wh_flow_state_t *asked; /* the same while a function may wait, else null */
    int32_t robot;                /* that is asked, or WH_FLOW_NONE */
    int64_t (*now)(
        const void *); /* the time, of `clock`; null: the state's, which is that of its last event */
    const void *clock;
    size_t count;
    wh_flow_choice_t choices[WH_FLOW_SEEN_CHOICES];
} wh_flow_seen_t;

/* The user values of that userdata which are taken: the first ones. */
#define WH_FLOW_SEEN_VALUES 3

/* Prepares the userdata at this stack index. It outlives what a script keeps of it. */
void wh_flow_seen_open(lua_State *L, int index);

/* Pushes the tool. */
void wh_flow_seen_push(lua_State *L, wh_flow_seen_t *seen);

/* Pushes one of the userdata's user values, or pops a value into one. */
void wh_flow_seen_push_value(lua_State *L, const wh_flow_seen_t *seen, int which);
void wh_flow_seen_keep_value(lua_State *L, const wh_flow_seen_t *seen, int which);

/* True if the value at this stack index is a part of a tool. It is then this choice of the question, or null
 * if it is none of them. */
bool wh_flow_seen_choice(lua_State *L, const wh_flow_seen_t *seen, int index,
                         const wh_flow_choice_t **choice);

/* The number of the wafer or the station whose name is at this stack index, or WH_FLOW_NONE. */
int32_t wh_flow_seen_wafer(lua_State *L, const wh_flow_seen_t *seen, int name);
int32_t wh_flow_seen_station(lua_State *L, const wh_flow_seen_t *seen, int name);

#endif
