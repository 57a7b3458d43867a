#include "encounter_internal.h"

#include "grasp_internal.h"
#include "horizon_internal.h"

static void report(const wh_watch_t *watch, wh_encounter_t *encounter, wh_event_kind_t kind) {
    if (watch->list) {
        wh_event_t *event = wh_event_append(watch->table, watch->list, kind);
        event->wafer = encounter->wafer;
        event->gripper = watch->index;
        event->other = encounter->holder;
        event->measured = encounter->measured;
        event->measured_slice = encounter->slice;
        event->face = encounter->face;
    }
    encounter->wafer = WH_NONE;
    encounter->holder = WH_NONE;
}

bool wh_closeness_measure(const wh_grasp_config_t *config, const wh_pose_t *base_from_wafer,
                          const wh_pose_t *base_from_gripper, wh_closeness_t *reach) {
    const wh_vec3_t dr = wh_vec3_subtract(&base_from_wafer->r, &base_from_gripper->r);
    const wh_vec3_t p = wh_mat3_transform_back(&base_from_wafer->R, &dr);
    reach->z = wh_real_abs(p.z);
    reach->xy = 0;
    if (reach->z < config->near_projz) {
        reach->xy = wh_real_sqrt(p.x * p.x + p.y * p.y);
        if (reach->xy < config->near_projxy) {
            return true;
        }
    }
    return false;
}

static bool is_near_now(const wh_watch_t *watch, const wh_wafer_t *wafer, wh_closeness_t *reach) {
    reach->t = 1;
    return wh_closeness_measure(&watch->table->config, &wafer->base_from_wafer, watch->base_from_gripper,
                                reach);
}

/* Measures the gripper's approach to the wafer in this slice; false if it did not come near. */
static bool came_near(const wh_watch_t *watch, const wh_wafer_t *wafer, wh_closeness_t *closest) {
    if (wh_watch_sweep(watch) && wafer->released_by == WH_NONE) {
        return wh_closeness_swept(watch, &wafer->base_from_wafer, closest);
    }
    return is_near_now(watch, wafer, closest);
}

/* The square that defines "closest": both distances in units of their tolerance. */
static wh_real_t closeness(const wh_tolerance_t *tolerance, wh_real_t dr_proj_z, wh_real_t dr_proj_xy) {
    const wh_real_t z = dr_proj_z / tolerance->projz;
    const wh_real_t xy = dr_proj_xy / tolerance->projxy;
    return z * z + xy * xy;
}

static bool is_closer(const wh_tolerance_t *tolerance, const wh_closeness_t *reach,
                      const wh_proximity_t *measured) {
    return closeness(tolerance, reach->z, reach->xy) <
           closeness(tolerance, measured->dr_proj_z, measured->dr_proj_xy_norm);
}

static void begin_encounter(const wh_watch_t *watch, wh_encounter_t *encounter, int32_t w, wh_real_t t) {
    const wh_wafer_t *wafer = &watch->table->storage.wafers[w];
    encounter->wafer = w;
    encounter->holder = wafer->holder;
    encounter->slice = watch->table->slice;
    encounter->face = WH_FACE_BACK;
    if (WH_SWEEP_BUILT && t < 1) {
        wh_measure_swept(watch, &wafer->base_from_wafer, t, &encounter->measured);
    } else {
        wh_proximity_values(&wafer->base_from_wafer, watch->base_from_gripper,
                            &watch->table->config.tolerance, &encounter->measured);
    }
}

WH_OUT_OF_LINE static void follow_approach(const wh_watch_t *watch) {
    wh_encounter_t *approach = &watch->gripper->approach;
    const wh_wafer_t *wafer = &watch->table->storage.wafers[approach->wafer];
    if (wafer->holder != WH_NONE) {
        approach->wafer = WH_NONE;
        return;
    }
    wh_closeness_t reach;
    if (came_near(watch, wafer, &reach) &&
        is_closer(&watch->table->config.tolerance, &reach, &approach->measured)) {
        begin_encounter(watch, approach, approach->wafer, reach.t);
    }
    if (!is_near_now(watch, wafer, &reach)) {
        ++watch->table->counters.near_misses;
        report(watch, approach, WH_EVENT_NEAR_MISS);
    }
}

/* True if no wafer at rest came near in this slice. */
static bool is_within_horizon(const wh_grasp_t *table, size_t g) {
    return wh_horizon_is_clear(table, g) &&
           (!wh_grasp_is_swept(table, g) ||
            wh_horizon_is_clear_at(table, g, &table->storage.grippers[g].base_from_gripper.r));
}

/* Begins an approach if the gripper follows no wafer yet: the nearest free wafer in the neighbourhood, then
 * the lowest index. */
WH_OUT_OF_LINE static void begin_approach(const wh_watch_t *watch) {
    const wh_sweep_t *sweep = wh_watch_sweep(watch);
    const wh_vec3_t *end = &watch->base_from_gripper->r;
    const wh_found_t near =
        wh_index_again(watch->table, (size_t)watch->index, sweep ? &sweep->begin->r : end, end);
    int32_t nearest = WH_NONE;
    wh_real_t least = 0;
    wh_real_t when = 0;
    for (size_t i = 0; i < near.count; ++i) {
        const size_t w = wh_index_wafer(watch->table, &near, i);
        const wh_wafer_t *wafer = &watch->table->storage.wafers[w];
        wh_closeness_t reach;
        if (wafer->holder == WH_NONE && came_near(watch, wafer, &reach) &&
            (nearest == WH_NONE || reach.z < least || (reach.z == least && (int32_t)w < nearest))) {
            nearest = (int32_t)w;
            least = reach.z;
            when = reach.t;
        }
    }
    if (nearest != WH_NONE) {
        begin_encounter(watch, &watch->gripper->approach, nearest, when);
    }
}

/* Reports a contest that is over, unless the wafer passed to another holder. */
static void end_contest(const wh_watch_t *watch) {
    wh_encounter_t *contest = &watch->gripper->contest;
    if (contest->wafer == WH_NONE) {
        return;
    }
    const int32_t holder = watch->table->storage.wafers[contest->wafer].holder;
    if (holder != WH_NONE && holder != contest->holder) {
        contest->wafer = WH_NONE;
        return;
    }
    ++watch->table->counters.contested;
    report(watch, contest, WH_EVENT_CONTESTED);
}

static bool contest_goes_on(const wh_watch_t *watch) {
    const wh_encounter_t *contest = &watch->gripper->contest;
    if (contest->wafer == WH_NONE) {
        return false;
    }
    const wh_wafer_t *wafer = &watch->table->storage.wafers[contest->wafer];
    return wafer->holder == contest->holder &&
           wh_proximity_is_ready(&wafer->base_from_wafer, watch->base_from_gripper,
                                 &watch->table->config.tolerance);
}

/* The held wafer that is ready and has the smallest |dr_proj_z|, then the lowest index; WH_NONE: none. */
WH_OUT_OF_LINE static int32_t find_held(const wh_watch_t *watch) {
    const wh_grasp_storage_t *storage = &watch->table->storage;
    int32_t best = WH_NONE;
    wh_real_t least = 0;
    for (size_t g = 0; g < storage->gripper_count; ++g) {
        const size_t w = (size_t)storage->grippers[g].wafer;
        if (w < storage->wafer_count && storage->wafers[w].holder == (int32_t)g &&
            wh_proximity_is_ready(&storage->wafers[w].base_from_wafer, watch->base_from_gripper,
                                  &watch->table->config.tolerance)) {
            const wh_real_t distance = wh_grasp_distance(&storage->wafers[w], watch->base_from_gripper);
            if (best == WH_NONE || distance < least || (distance == least && (int32_t)w < best)) {
                best = (int32_t)w;
                least = distance;
            }
        }
    }
    return best;
}

/* Follows the wafer that the gripper would take if no gripper held it. A contest continues even if another
 * held wafer has come nearer. Otherwise it would be reported each time that the two change order, and
 * before its own hand-over. */
WH_OUT_OF_LINE static void follow_contest(const wh_watch_t *watch) {
    if (contest_goes_on(watch)) {
        return;
    }
    end_contest(watch);
    const int32_t best = find_held(watch);
    if (best != WH_NONE) {
        begin_encounter(watch, &watch->gripper->contest, best, 1);
    }
}

/* The gripper closed or took a wafer, so its encounters are over. */
static void end_encounters(const wh_watch_t *watch, bool closed) {
    wh_encounter_t *approach = &watch->gripper->approach;
    if (approach->wafer != WH_NONE && closed &&
        watch->table->storage.wafers[approach->wafer].holder == WH_NONE) {
        ++watch->table->counters.near_misses;
        report(watch, approach, WH_EVENT_NEAR_MISS);
    }
    approach->wafer = WH_NONE;
    end_contest(watch);
}

void wh_encounter_track(const wh_watch_t *watch) {
    if (watch->gripper->approach.wafer == WH_NONE && !is_within_horizon(watch->table, (size_t)watch->index)) {
        begin_approach(watch);
    }
    if (watch->gripper->approach.wafer != WH_NONE) {
        follow_approach(watch);
    }
    follow_contest(watch);
}

/* True if an approach goes on or may begin. */
static bool is_sweep_needed(const wh_watch_t *watch) {
    return watch->gripper->approach.wafer != WH_NONE ||
           !is_within_horizon(watch->table, (size_t)watch->index);
}

static bool is_any_held(const wh_grasp_t *table) {
    bool held = false;
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        held = held || table->storage.grippers[g].wafer != WH_NONE;
    }
    return held;
}

/* True if the gripper watches nothing, no wafer at rest is near, and there is nothing to contest. */
static bool is_idle(const wh_grasp_t *table, size_t g) {
    const wh_gripper_t *gripper = &table->storage.grippers[g];
    return gripper->approach.wafer == WH_NONE && gripper->contest.wafer == WH_NONE &&
           gripper->wafer == WH_NONE && is_within_horizon(table, g) && !is_any_held(table);
}

static void update(wh_watch_t *watch, bool closed) {
    if (closed || watch->gripper->wafer != WH_NONE) {
        end_encounters(watch, closed);
    } else if (wh_grasp_is_swept(watch->table, (size_t)watch->index) && is_sweep_needed(watch)) {
        wh_encounter_track_swept(watch);
    } else {
        wh_encounter_track(watch);
    }
}

void wh_encounter_update(wh_grasp_t *table, size_t gripper, const wh_gripper_input_t *input,
                         wh_event_list_t *list) {
    if (is_idle(table, gripper)) {
        return;
    }
    wh_watch_t watch = {
        table, &table->storage.grippers[gripper], &input->base_from_gripper, NULL, list, (int32_t)gripper};
    update(&watch, input->valve == WH_VALVE_CLOSED);
}
