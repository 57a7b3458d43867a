#include "grasp_internal.h"
#include "horizon_internal.h"

wh_real_t wh_grasp_distance(const wh_wafer_t *wafer, const wh_pose_t *base_from_gripper) {
    const wh_vec3_t dr = wh_vec3_subtract(&wafer->base_from_wafer.r, &base_from_gripper->r);
    const wh_vec3_t n1 = wh_mat3_column(&wafer->base_from_wafer.R, 2);
    return wh_real_abs(wh_vec3_dot(&dr, &n1));
}

/* The best wafer so far. */
typedef struct {
    int32_t wafer; /* WH_NONE: none */
    wh_real_t distance;
} nearest_t;

static void keep_better(nearest_t *best, size_t w, wh_real_t distance) {
    const nearest_t here = {(int32_t)w, distance};
    if (best->wafer == WH_NONE || here.distance < best->distance ||
        (here.distance == best->distance && here.wafer < best->wafer)) {
        *best = here;
    }
}

/* Checks the wafers around, and measures the gripper's horizon at the same time. */
WH_OUT_OF_LINE static int32_t find_around(wh_grasp_t *table, size_t g, const wh_pose_t *base_from_gripper) {
    const wh_vec3_t *place = &base_from_gripper->r;
    const wh_real_t margin = wh_horizon_margin(table, g, place);
    const wh_found_t near = wh_grasp_is_swept(table, g) ? wh_index_again(table, g, place, place)
                                                        : wh_index_near(table, g, place, place, margin);
    wh_horizon_t horizon = wh_horizon_begin(table, g, &near, margin);
    nearest_t best = {.wafer = WH_NONE};
    for (size_t i = 0; i < near.count; ++i) {
        const size_t w = wh_index_wafer(table, &near, i);
        const wh_wafer_t *wafer = &table->storage.wafers[w];
        if (wafer->holder == WH_NONE && !wh_horizon_measure(&horizon, &wafer->base_from_wafer, place) &&
            wh_proximity_is_ready_fast(&wafer->base_from_wafer, base_from_gripper,
                                       &table->config.tolerance)) {
            keep_better(&best, w, wh_grasp_distance(wafer, base_from_gripper));
        }
    }
    wh_horizon_store(table, g, place, &horizon);
    wh_horizon_note(table, g, horizon.gap > 0);
    return best.wafer;
}

/* A wafer within both limits is no farther away along any axis of base, even if its rotation is orthonormal
 * to WH_ROTATION_TOLERANCE only. */
static wh_real_t side_of(const wh_near_limits_t *limits) {
    return (1 + 8 * WH_ROTATION_TOLERANCE) * (limits->projz + limits->projxy);
}

static bool is_aside(const wh_wafer_t *wafer, const wh_pose_t *base_from_gripper, wh_real_t side) {
    const wh_vec3_t dr = wh_vec3_subtract(&wafer->base_from_wafer.r, &base_from_gripper->r);
    return wh_real_abs(dr.x) > side || wh_real_abs(dr.y) > side;
}

/* Checks all wafers. If none is near, no second search of this step needs to check them again. */
WH_OUT_OF_LINE static int32_t find_among_all(wh_grasp_t *table, size_t g,
                                             const wh_pose_t *base_from_gripper) {
    const wh_near_limits_t limits = wh_horizon_limits(table, g);
    const wh_real_t side = side_of(&limits);
    nearest_t best = {.wafer = WH_NONE};
    bool clear = true;
    for (size_t w = 0; w < table->storage.wafer_count; ++w) {
        const wh_wafer_t *wafer = &table->storage.wafers[w];
        if (wafer->holder != WH_NONE || (WH_REAL_IS_SLOW && is_aside(wafer, base_from_gripper, side))) {
            continue;
        }
        const wh_real_t distance = wh_grasp_distance(wafer, base_from_gripper);
        if (distance >= limits.projz) {
            continue;
        }
        if (wh_proximity_is_ready_fast(&wafer->base_from_wafer, base_from_gripper,
                                       &table->config.tolerance)) {
            keep_better(&best, w, distance);
        } else {
            clear = clear && is_aside(wafer, base_from_gripper, side);
        }
    }
    wh_horizon_note(table, g, clear);
    return best.wafer;
}

int32_t wh_grasp_find_ready(wh_grasp_t *table, size_t g, const wh_pose_t *base_from_gripper) {
    if (wh_horizon_is_clear_at(table, g, &base_from_gripper->r)) {
        wh_horizon_note(table, g, true);
        return WH_NONE;
    }
    return wh_index_is_used(table) ? find_around(table, g, base_from_gripper)
                                   : find_among_all(table, g, base_from_gripper);
}

/* The smallest turn of the wafer, in the gripper's frame, that takes n1 to n2 = e3. c > 0 at every pick. */
static void turn_onto_pads(wh_mat3_t *R) {
    const wh_vec3_t n1 = wh_mat3_column(R, 2);
    const wh_real_t a = n1.x;
    const wh_real_t b = n1.y;
    const wh_real_t c = n1.z;
    const wh_real_t f = 1 / (1 + c);
    const wh_mat3_t turn = {{{1 - f * a * a, -f * a * b, -a}, {-f * a * b, 1 - f * b * b, -b}, {a, b, c}}};
    for (size_t column = 0; column < 3; ++column) {
        const wh_vec3_t axis = wh_mat3_column(R, column);
        const wh_vec3_t turned = wh_mat3_transform(&turn, &axis);
        R->m[0][column] = turned.x;
        R->m[1][column] = turned.y;
        R->m[2][column] = turned.z;
    }
}

static void append(const wh_grasp_t *table, wh_event_list_t *list, size_t g, int32_t w,
                   const wh_pose_t *then) {
    const wh_wafer_t *wafer = &table->storage.wafers[w];
    const bool handed_over = wafer->released_by != WH_NONE;
    wh_event_t *event = wh_event_append(table, list, handed_over ? WH_EVENT_HANDED_OVER : WH_EVENT_PICKED);
    event->wafer = w;
    event->gripper = (int32_t)g;
    event->other = wafer->released_by;
    wh_proximity_values(&wafer->base_from_wafer, then, &table->config.tolerance, &event->measured);
}

/* It runs before the wafer is taken: a seated wafer would no longer show the values that made it ready. */
static void report(wh_grasp_t *table, wh_event_list_t *list, size_t g, int32_t w, const wh_pose_t *then) {
    const bool handed_over = table->storage.wafers[w].released_by != WH_NONE;
    *(handed_over ? &table->counters.handed_over : &table->counters.picked) += 1;
    if (list) {
        append(table, list, g, w, then);
    }
}

static void pair(wh_grasp_t *table, size_t g, int32_t w) {
    table->storage.wafers[w].holder = (int32_t)g;
    table->storage.grippers[g].wafer = w;
}

/* The rotation is made orthonormal again, so that deviations within WH_ROTATION_TOLERANCE do not add up
 * over many picks. */
static void measure_grip(wh_pose_t *gripper_from_wafer, const wh_pose_t *then,
                         const wh_pose_t *base_from_wafer, bool seat) {
    wh_pose_relative_to(then, base_from_wafer, gripper_from_wafer);
    wh_mat3_orthonormalise(&gripper_from_wafer->R);
    if (seat) {
        turn_onto_pads(&gripper_from_wafer->R);
        wh_mat3_orthonormalise(&gripper_from_wafer->R);
        gripper_from_wafer->r.z = 0;
    }
}

static void grip(wh_grasp_t *table, size_t g, int32_t w, const wh_pose_t *then) {
    measure_grip(&table->storage.grippers[g].gripper_from_wafer, then,
                 &table->storage.wafers[w].base_from_wafer, table->config.seat);
}

void wh_grasp_take(wh_grasp_t *table, size_t g, int32_t w, const wh_pose_t *then, wh_event_list_t *list) {
    report(table, list, g, w, then);
    pair(table, g, w);
    grip(table, g, w, then);
}
