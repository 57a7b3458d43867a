/* Whether wafers could block each other: rules leave out transfers after which one of them could not go
 * on. */
#ifndef WH_FLOW_SAFE_H
#define WH_FLOW_SAFE_H

#include "state.h"

/* A wafer that is to go into a place of its next step. */
typedef struct {
    int32_t wafer, place;
} wh_flow_into_t;

/* Working memory for the questions below, which the state holds. */
struct wh_flow_safety *wh_flow_safety_open(const wh_flow_tool_t *tool);
void wh_flow_safety_close(struct wh_flow_safety *safety);

/* True if after these transfers each wafer inside could still go to its end, one after another, alone,
 * through places with room. Inside are all that have left their first place, those under way where they
 * go. Wafers that are kept on an arm without a place to go to are left out. Cost: the square of the wafers
 * inside times the places of their routes; no memory beyond a few words for each wafer inside. */
bool wh_flow_is_safe(const wh_flow_state_t *state, const wh_flow_into_t into[], size_t count);

/* The first wafer that could not come to its end then, or WH_FLOW_NONE: the tool is safe. */
int32_t wh_flow_find_blocked(const wh_flow_state_t *state, const wh_flow_into_t into[], size_t count);

#endif
