/* The parts of a step that only swept checking needs: picks and near misses between two slices. It is a
 * separate file, so that its memory is never on the stack of a sampled step. */
#include "encounter_internal.h"
#include "grasp_internal.h"
#include "horizon_internal.h"

/* The best wafer so far. */
typedef struct {
    int32_t wafer; /* WH_NONE: none */
    wh_real_t t;   /* the instant within the slice; 1 is its end */
    wh_real_t distance;
} candidate_t;

static bool is_better(const candidate_t *best, const candidate_t *other) {
    if (other->t != best->t) {
        return other->t < best->t;
    }
    return other->distance < best->distance ||
           (other->distance == best->distance && other->wafer < best->wafer);
}

/* The order is: earliest instant, then smallest |dr_proj_z|, then lowest index. */
static void keep_better(candidate_t *best, const candidate_t *other) {
    if (best->wafer == WH_NONE || is_better(best, other)) {
        *best = *other;
    }
}

static candidate_t find_ready(wh_grasp_t *table, size_t g, const wh_sweep_t *sweep) {
    const wh_vec3_t *place = &sweep->end->r;
    const bool indexed = wh_index_is_used(table);
    const wh_real_t margin = indexed ? wh_horizon_margin(table, g, place) : 0;
    const wh_found_t near = wh_index_near(table, g, &sweep->begin->r, place, margin);
    wh_horizon_t horizon = {{0, 0}, 0};
    if (indexed) {
        horizon = wh_horizon_begin(table, g, &near, margin);
    }
    candidate_t best = {.wafer = WH_NONE};
    for (size_t i = 0; i < near.count; ++i) {
        const size_t w = wh_index_wafer(table, &near, i);
        const wh_wafer_t *wafer = &table->storage.wafers[w];
        if (wafer->holder != WH_NONE) {
            continue;
        }
        candidate_t here = {.wafer = (int32_t)w};
        if (indexed) {
            (void)wh_horizon_measure(&horizon, &wafer->base_from_wafer, place);
        }
        if (wafer->released_by == WH_NONE &&
            wh_sweep_first_ready(sweep, &wafer->base_from_wafer, &table->config.tolerance, &here.t)) {
            wh_pose_t then;
            wh_sweep_pose_at(sweep, here.t, &then);
            here.distance = wh_grasp_distance(wafer, &then);
            keep_better(&best, &here);
        }
    }
    if (indexed) {
        wh_horizon_store(table, g, place, &horizon);
    }
    return best;
}

static void carry_on(wh_grasp_t *table, size_t g, int32_t w, const wh_pose_t *base_from_gripper) {
    wh_grasp_carry(&table->storage.wafers[w], base_from_gripper,
                   &table->storage.grippers[g].gripper_from_wafer);
}

/* The wafer is taken at t and carried to the slice's end. */
static void take_at(wh_grasp_t *table, size_t g, int32_t w, const wh_sweep_t *sweep, wh_real_t t,
                    wh_event_list_t *list) {
    wh_pose_t then;
    wh_sweep_pose_at(sweep, t, &then);
    wh_grasp_take(table, g, w, &then, list);
    if (table->config.seat || t < 1) {
        carry_on(table, g, w, sweep->end);
    }
}

bool wh_grasp_pick_swept(wh_grasp_t *table, size_t g, const wh_gripper_input_t *input,
                         wh_event_list_t *list) {
    const wh_pose_t *begin = &table->storage.grippers[g].base_from_gripper;
    if (wh_horizon_is_clear_at(table, g, &begin->r) &&
        wh_horizon_is_clear_at(table, g, &input->base_from_gripper.r)) {
        return false;
    }
    wh_sweep_t sweep;
    wh_sweep_between(begin, &input->base_from_gripper, &sweep);
    const candidate_t best = find_ready(table, g, &sweep);
    if (best.wafer == WH_NONE) {
        return false;
    }
    take_at(table, g, best.wafer, &sweep, best.t, list);
    return true;
}

void wh_encounter_track_swept(wh_watch_t *watch) {
    wh_sweep_t sweep;
    wh_sweep_between(&watch->gripper->base_from_gripper, watch->base_from_gripper, &sweep);
    watch->sweep = &sweep;
    wh_encounter_track(watch);
    watch->sweep = NULL;
}

static bool is_near_at(const wh_watch_t *watch, const wh_pose_t *base_from_wafer, wh_closeness_t *reach) {
    wh_pose_t then;
    wh_sweep_pose_at(watch->sweep, reach->t, &then);
    return wh_closeness_measure(&watch->table->config, base_from_wafer, &then, reach);
}

bool wh_closeness_swept(const wh_watch_t *watch, const wh_pose_t *base_from_wafer, wh_closeness_t *closest) {
    const wh_grasp_config_t *config = &watch->table->config;
    wh_span_t part;
    if (!wh_sweep_within(watch->sweep, base_from_wafer, config->near_projz, config->near_projxy, &part)) {
        return false;
    }
    closest->t = wh_sweep_closest(watch->sweep, base_from_wafer, &part, config->tolerance.projz,
                                  config->tolerance.projxy);
    if (is_near_at(watch, base_from_wafer, closest)) {
        return true;
    }
    /* If the closest instant is on the neighbourhood's edge, the middle decides. */
    wh_closeness_t middle = {.t = (part.first + part.last) / 2};
    return is_near_at(watch, base_from_wafer, &middle);
}

void wh_measure_swept(const wh_watch_t *watch, const wh_pose_t *base_from_wafer, wh_real_t t,
                      wh_proximity_t *measured) {
    wh_tolerance_t tolerance = watch->table->config.tolerance;
    tolerance.projz *= WH_SWEEP_INSIDE;
    wh_pose_t then;
    wh_sweep_pose_at(watch->sweep, t, &then);
    wh_proximity_values(base_from_wafer, &then, &tolerance, measured);
}
