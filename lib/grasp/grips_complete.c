/* States of grips that came from elsewhere. */
#include "../math/hash.h"
#include "grips.h"

/* An excess beyond this, mm, is impossible, because wafers lie on blades. */
#define MOST_EXCESS 1000

static bool is_finite(double value) {
    return (wh_double_bits(value) >> 52 & 0x7ff) != 0x7ff;
}

static void open_state(const wh_grip_t *grip, wh_grip_state_t *state) {
    static const wh_grip_state_t zero = {0};
    *state = zero;
    state->wafer = WH_NONE;
    state->s = grip->kind == WH_GRIP_EDGE ? grip->edge.retracted : 0;
}

/* True if the carried wafer fits the phase. A plunger that begins to move carries a wafer or none, a closed
 * one carries it, and others carry none. */
static bool carries_well(const wh_grip_state_t *state, int32_t carried) {
    if (state->phase == WH_GRIP_CLOSED) {
        return carried != WH_NONE && carried == state->wafer;
    }
    return carried == WH_NONE || (state->phase == WH_GRIP_CLOSING && carried == state->wafer);
}

static bool fits(const wh_edge_t *edge, const wh_grip_state_t *state, size_t wafer_count) {
    const bool known = state->wafer == WH_NONE || wh_is_index(state->wafer, wafer_count);
    const bool moves = (unsigned)state->phase <= WH_GRIP_OPENING;
    const bool beyond =
        state->excess >= 0 && state->excess <= (state->phase == WH_GRIP_JAMMED ? (double)MOST_EXCESS : 0);
    return known && moves && beyond && state->s >= edge->retracted && state->s <= edge->end;
}

/* The shape is the wafer's own. */
static wh_status_t complete_lying(const wh_edge_t *edge, const wh_edge_wafer_t shapes[],
                                  wh_grip_state_t *state) {
    wh_edge_wafer_t lying = shapes[state->wafer];
    lying.x = state->lying.x;
    lying.y = state->lying.y;
    lying.notch_x = state->lying.notch_x;
    lying.notch_y = state->lying.notch_y;
    state->lying = lying;
    return wh_real_is_finite(state->x) && wh_real_is_finite(state->y) ? wh_edge_wafer_validate(edge, &lying)
                                                                      : WH_STATUS_NOT_FINITE;
}

/* Completes a plunger that is not open. */
static wh_status_t complete_edge(const wh_edge_t *edge, const wh_edge_wafer_t shapes[], int32_t carried,
                                 size_t wafer_count, wh_grip_state_t *state) {
    if (!is_finite(state->s) || !is_finite(state->excess)) {
        return WH_STATUS_NOT_FINITE;
    }
    if (!fits(edge, state, wafer_count) || !carries_well(state, carried)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    const bool lies = state->phase == WH_GRIP_CLOSING && state->wafer != WH_NONE;
    return lies ? complete_lying(edge, shapes, state) : WH_OK;
}

/* Vacuum lets a wafer go once its valve is closed. */
static bool may_carry(const wh_grip_t *grip, const wh_gripper_t *gripper) {
    return grip->kind != WH_GRIP_VACUUM || gripper->wafer == WH_NONE || gripper->valve == WH_VALVE_OPEN;
}

static wh_status_t complete(const wh_grips_parts_t *parts, const wh_grip_t *grip, const wh_gripper_t *gripper,
                            size_t wafer_count, wh_grip_state_t *state) {
    const bool is_edge = grip->kind == WH_GRIP_EDGE;
    const int32_t carried = gripper->wafer;
    if (!may_carry(grip, gripper)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    if (state->phase == WH_GRIP_OPEN) {
        open_state(grip, state);
        return !is_edge || carried == WH_NONE ? WH_OK : WH_STATUS_OUT_OF_RANGE;
    }
    return is_edge ? complete_edge(&grip->edge, parts->shapes, carried, wafer_count, state)
                   : WH_STATUS_OUT_OF_RANGE;
}

wh_status_t wh_grips_complete(const wh_grips_parts_t *parts, const wh_gripper_t grippers[],
                              size_t gripper_count, size_t wafer_count, wh_grip_state_t states[]) {
    wh_status_t status = WH_OK;
    for (size_t g = 0; g < gripper_count && status == WH_OK; ++g) {
        status = complete(parts, &parts->grips[g], &grippers[g], wafer_count, &states[g]);
    }
    return status;
}
