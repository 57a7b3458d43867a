#include "carrier.h"

static void to_chain(const wh_carrier_t *carrier, const wh_real_t axes[], wh_real_t q[WH_CHAIN_AXES]) {
    for (size_t i = 0; i < WH_CHAIN_AXES; ++i) {
        q[i] = 0;
    }
    for (size_t i = 0; i < carrier->axis_count; ++i) {
        if (carrier->axes[i] != WH_CARRIER_OTHERS) {
            q[carrier->axes[i]] = axes[i];
        }
    }
}

static void from_chain(const wh_carrier_t *carrier, const wh_real_t q[WH_CHAIN_AXES], wh_real_t axes[]) {
    for (size_t i = 0; i < carrier->axis_count; ++i) {
        if (carrier->axes[i] != WH_CARRIER_OTHERS) {
            axes[i] = q[carrier->axes[i]];
        }
    }
}

wh_status_t wh_carrier_check_travel(const wh_carrier_t *carrier, const wh_real_t axes[]) {
    wh_real_t q[WH_CHAIN_AXES];
    to_chain(carrier, axes, q);
    const wh_status_t status = wh_chain_check_travel(&carrier->chain, q);
    if (status != WH_OK || !carrier->second) {
        return status;
    }
    to_chain(carrier->second, axes, q);
    return wh_chain_check_travel(&carrier->second->chain, q);
}

void wh_carrier_forward(const wh_carrier_t *carrier, const wh_real_t axes[], wh_pose_t *base_from_effector) {
    wh_real_t q[WH_CHAIN_AXES];
    to_chain(carrier, axes, q);
    wh_chain_forward(&carrier->chain, q, base_from_effector);
}

wh_status_t wh_carrier_inverse(const wh_carrier_t *carrier, const wh_pose_t *base_from_effector,
                               const wh_chain_choice_t *choice, const wh_real_t near_axes[],
                               wh_real_t axes[]) {
    wh_real_t q[WH_CHAIN_AXES];
    to_chain(carrier, near_axes, q);
    const wh_status_t status = wh_chain_inverse(&carrier->chain, base_from_effector, choice, q, q);
    for (size_t i = 0; status == WH_OK && i < carrier->axis_count; ++i) {
        axes[i] = near_axes[i];
    }
    if (status == WH_OK) {
        from_chain(carrier, q, axes);
    }
    return status;
}

wh_status_t wh_carrier_plan_line(const wh_carrier_t *carrier, wh_chain_line_t *line, const wh_real_t from[],
                                 const wh_vec3_t *travel, const wh_line_caps_t *caps) {
    wh_real_t q[WH_CHAIN_AXES];
    to_chain(carrier, from, q);
    return wh_chain_line_plan(line, &carrier->chain, q, travel, caps);
}

void wh_carrier_line_at(const wh_carrier_t *carrier, const wh_chain_line_t *line, wh_real_t t,
                        wh_real_t axes[]) {
    wh_real_t q[WH_CHAIN_AXES];
    wh_chain_line_at(line, t, q);
    from_chain(carrier, q, axes);
}

static void list_axes(wh_carrier_t *carrier) {
    static const uint8_t always[] = {WH_CHAIN_THETA, WH_CHAIN_REACH, WH_CHAIN_Z, WH_CHAIN_YAW};
    static const uint8_t others[] = {WH_CHAIN_RAIL, WH_CHAIN_TILT_X, WH_CHAIN_TILT_Y, WH_CHAIN_FLIP};
    for (size_t i = 0; i < sizeof always; ++i) {
        carrier->axes[i] = always[i];
    }
    carrier->axis_count = sizeof always;
    for (size_t i = 0; i < sizeof others; ++i) {
        if (wh_chain_has(&carrier->chain, others[i])) {
            carrier->axes[carrier->axis_count] = others[i];
            ++carrier->axis_count;
        }
    }
}

wh_status_t wh_carrier_init(wh_carrier_t *carrier, const wh_chain_t *chain) {
    if (carrier == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    const wh_status_t status = wh_chain_validate(chain);
    if (status != WH_OK) {
        return status;
    }
    static const wh_carrier_t calls = {.check_travel = wh_carrier_check_travel,
                                       .forward = wh_carrier_forward,
                                       .inverse = wh_carrier_inverse,
                                       .plan_line = wh_carrier_plan_line,
                                       .line_at = wh_carrier_line_at};
    *carrier = calls;
    carrier->chain = *chain;
    list_axes(carrier);
    if (chain->kind == WH_CHAIN_TRZ) { /* a move requires sound limits of all axes, moved or not */
        carrier->chain.limits[WH_CHAIN_YAW] = chain->limits[WH_CHAIN_THETA];
    }
    return WH_OK;
}

wh_status_t wh_carrier_add(wh_carrier_t *first, wh_carrier_t *second, wh_real_t heading, wh_real_t height) {
    if (first == NULL || second == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (first->chain.kind == WH_CHAIN_TRZY || first->second) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    const bool is_wrist = first->chain.kind == WH_CHAIN_SCARA;
    wh_chain_t chain = first->chain;
    chain.height = height;
    if (is_wrist) {
        chain.home[WH_CHAIN_YAW] += heading;
    } else {
        chain.arm_heading = heading;
    }
    const wh_status_t status = wh_chain_validate(&chain);
    if (status != WH_OK) {
        return status;
    }
    size_t own = 1;
    if (is_wrist) {
        own = 3;
    }
    *second = *first;
    second->chain = chain;
    second->next = NULL;
    second->axes[first->axis_count] = second->axes[own];
    second->axes[own] = WH_CARRIER_OTHERS;
    first->axes[first->axis_count] = WH_CARRIER_OTHERS;
    ++first->axis_count;
    ++second->axis_count;
    first->second = second;
    return WH_OK;
}
