#include "core/encounter_internal.h"

#include "core/proximity_internal.h"
#include "core/sweep_internal.h"

/* What one gripper's encounters are judged by in this step. */
typedef struct {
    wh_grasp_t *table;
    wh_gripper_t *gripper;
    const wh_pose_t *base_from_gripper;
    int32_t index;
    bool swept;
    wh_sweep_t sweep;
    wh_event_list_t *list;
} watch_t;

wh_event_t *wh_event_append(const wh_grasp_t *table, wh_event_list_t *list, wh_event_kind_t kind) {
    static const wh_event_t blank = {.wafer = WH_NONE, .gripper = WH_NONE, .other = WH_NONE};
    WH_ASSERT(list->count < list->capacity);
    wh_event_t *event = &list->events[list->count++];
    *event = blank;
    event->kind = kind;
    event->slice = table->slice;
    event->measured_slice = table->slice;
    return event;
}

static void report(const watch_t *watch, wh_encounter_t *encounter, wh_event_kind_t kind) {
    if (watch->list) {
        wh_event_t *event = wh_event_append(watch->table, watch->list, kind);
        event->wafer = encounter->wafer;
        event->gripper = watch->index;
        event->other = encounter->holder;
        event->measured = encounter->measured;
        event->measured_slice = encounter->slice;
    }
    encounter->wafer = WH_NONE;
    encounter->holder = WH_NONE;
}

static bool is_near(const watch_t *watch, const wh_proximity_t *p) {
    return wh_real_abs(p->dr_proj_z) < watch->table->config.near_projz &&
           p->dr_proj_xy_norm < watch->table->config.near_projxy;
}

/* The square that "closest" is measured by: both distances in units of their tolerance. */
static wh_real_t closeness(const wh_tolerance_t *tolerance, const wh_proximity_t *p) {
    const wh_real_t z = p->dr_proj_z / tolerance->projz;
    const wh_real_t xy = p->dr_proj_xy_norm / tolerance->projxy;
    return z * z + xy * xy;
}

static void measure_at(const watch_t *watch, const wh_wafer_t *wafer, wh_real_t t, wh_proximity_t *measured) {
    wh_tolerance_t tolerance = watch->table->config.tolerance;
    if (t < 1) {
        tolerance.projz *= WH_SWEEP_INSIDE;
    }
    const wh_pose_t then = wh_sweep_pose_at(&watch->sweep, t);
    wh_proximity_values(&wafer->base_from_wafer, &then, &tolerance, measured);
}

/* The closest that the gripper came to the wafer in this slice, judged by the limits that hold there; false
 * when it did not come near. */
static bool measure_closest(const watch_t *watch, const wh_wafer_t *wafer, wh_proximity_t *closest) {
    const wh_grasp_config_t *config = &watch->table->config;
    const wh_pose_t *base_from_wafer = &wafer->base_from_wafer;
    if (!watch->swept || wafer->released_by != WH_NONE) {
        wh_proximity_values(base_from_wafer, watch->base_from_gripper, &config->tolerance, closest);
        return is_near(watch, closest);
    }
    wh_interval_t part;
    if (!wh_sweep_within(&watch->sweep, base_from_wafer, config->near_projz, config->near_projxy, &part)) {
        return false;
    }
    measure_at(watch, wafer,
               wh_sweep_closest(&watch->sweep, base_from_wafer, &part, config->tolerance.projz,
                                config->tolerance.projxy),
               closest);
    if (is_near(watch, closest)) {
        return true;
    }
    /* The closest instant may be the one on the neighbourhood's edge; then the middle tells. */
    wh_proximity_t middle;
    measure_at(watch, wafer, (part.first + part.last) / 2, &middle);
    return is_near(watch, &middle);
}

static void begin_encounter(const watch_t *watch, wh_encounter_t *encounter, size_t wafer,
                            const wh_proximity_t *measured) {
    encounter->wafer = (int32_t)wafer;
    encounter->holder = watch->table->storage.wafers[wafer].holder;
    encounter->slice = watch->table->slice;
    encounter->measured = *measured;
}

static void follow_approach(const watch_t *watch) {
    wh_encounter_t *approach = &watch->gripper->approach;
    const wh_tolerance_t *tolerance = &watch->table->config.tolerance;
    const wh_wafer_t *wafer = &watch->table->storage.wafers[approach->wafer];
    if (wafer->holder != WH_NONE) {
        approach->wafer = WH_NONE;
        return;
    }
    wh_proximity_t measured;
    if (measure_closest(watch, wafer, &measured) &&
        closeness(tolerance, &measured) < closeness(tolerance, &approach->measured)) {
        begin_encounter(watch, approach, (size_t)approach->wafer, &measured);
    }
    wh_proximity_values(&wafer->base_from_wafer, watch->base_from_gripper, tolerance, &measured);
    if (!is_near(watch, &measured)) {
        ++watch->table->counters.near_misses;
        report(watch, approach, WH_EVENT_NEAR_MISS);
    }
}

/* The nearest free wafer in the neighbourhood, if the gripper follows none yet. */
static void begin_approach(const watch_t *watch) {
    wh_encounter_t *approach = &watch->gripper->approach;
    const wh_grasp_storage_t *storage = &watch->table->storage;
    for (size_t w = 0; w < storage->wafer_count; ++w) {
        if (storage->wafers[w].holder != WH_NONE) {
            continue;
        }
        wh_proximity_t p;
        if (measure_closest(watch, &storage->wafers[w], &p) &&
            (approach->wafer == WH_NONE ||
             wh_real_abs(p.dr_proj_z) < wh_real_abs(approach->measured.dr_proj_z))) {
            begin_encounter(watch, approach, w, &p);
        }
    }
}

/* The wafer that the gripper would take if nobody held it: smallest |dr_proj_z|, then lowest index. */
static void find_contest(const watch_t *watch, wh_encounter_t *found) {
    const wh_grasp_storage_t *storage = &watch->table->storage;
    const wh_tolerance_t *tolerance = &watch->table->config.tolerance;
    found->wafer = WH_NONE;
    for (size_t w = 0; w < storage->wafer_count; ++w) {
        const wh_wafer_t *wafer = &storage->wafers[w];
        if (wafer->holder == WH_NONE ||
            !wh_proximity_ready(&wafer->base_from_wafer, watch->base_from_gripper, tolerance)) {
            continue;
        }
        wh_proximity_t p;
        wh_proximity_values(&wafer->base_from_wafer, watch->base_from_gripper, tolerance, &p);
        if (found->wafer == WH_NONE || wh_real_abs(p.dr_proj_z) < wh_real_abs(found->measured.dr_proj_z)) {
            begin_encounter(watch, found, w, &p);
        }
    }
}

/* A contest that is over is reported unless the wafer went on to another holder. */
static void end_contest(const watch_t *watch) {
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

static bool contest_goes_on(const watch_t *watch) {
    const wh_encounter_t *contest = &watch->gripper->contest;
    if (contest->wafer == WH_NONE) {
        return false;
    }
    const wh_wafer_t *wafer = &watch->table->storage.wafers[contest->wafer];
    return wafer->holder == contest->holder &&
           wh_proximity_ready(&wafer->base_from_wafer, watch->base_from_gripper,
                              &watch->table->config.tolerance);
}

/* A contest that goes on is kept even when another held wafer has come nearer: it would be reported each time
 * that the two change places, and before its own hand-over. */
static void follow_contest(const watch_t *watch) {
    if (contest_goes_on(watch)) {
        return;
    }
    wh_encounter_t *contest = &watch->gripper->contest;
    wh_encounter_t found;
    end_contest(watch);
    find_contest(watch, &found);
    if (found.wafer != WH_NONE) {
        *contest = found;
    }
}

/* The gripper closed or took a wafer: what it was watching is over. */
static void end_encounters(const watch_t *watch, bool closed) {
    wh_encounter_t *approach = &watch->gripper->approach;
    if (approach->wafer != WH_NONE && closed &&
        watch->table->storage.wafers[approach->wafer].holder == WH_NONE) {
        ++watch->table->counters.near_misses;
        report(watch, approach, WH_EVENT_NEAR_MISS);
    }
    approach->wafer = WH_NONE;
    end_contest(watch);
}

void wh_encounter_update(wh_grasp_t *table, size_t gripper, const wh_gripper_input_t *input,
                         wh_event_list_t *list) {
    watch_t watch;
    watch.table = table;
    watch.gripper = &table->storage.grippers[gripper];
    watch.base_from_gripper = &input->base_from_gripper;
    watch.index = (int32_t)gripper;
    watch.list = list;
    const bool closed = input->valve == WH_VALVE_CLOSED;
    if (closed || watch.gripper->wafer != WH_NONE) {
        end_encounters(&watch, closed);
        return;
    }
    watch.swept = table->config.check == WH_CHECK_SWEPT && watch.gripper->valve == WH_VALVE_OPEN;
    if (watch.swept) {
        watch.sweep = wh_sweep_between(&watch.gripper->base_from_gripper, &input->base_from_gripper);
    }
    if (watch.gripper->approach.wafer == WH_NONE) {
        begin_approach(&watch);
    }
    if (watch.gripper->approach.wafer != WH_NONE) {
        follow_approach(&watch);
    }
    follow_contest(&watch);
}
