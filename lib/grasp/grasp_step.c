/* One step of the grasp table, in the four parts of grasp.h; one loop does 2 and 3. Most slices have no
 * pick, no release and no event: for them move_all does everything. It is one file, so that the compiler
 * inlines. If split, a slice costs 50 instructions more, and a sampled step takes 32 bytes of stack more
 * than its limit. */
#include "encounter_internal.h"
#include "grasp_internal.h"
#include "horizon_internal.h"

/* Returns false if a number is not finite. */
static bool is_same(const wh_mat3_t *a, const wh_mat3_t *b) {
    return a->m[0][0] == b->m[0][0] && a->m[0][1] == b->m[0][1] && a->m[0][2] == b->m[0][2] &&
           a->m[1][0] == b->m[1][0] && a->m[1][1] == b->m[1][1] && a->m[1][2] == b->m[1][2] &&
           a->m[2][0] == b->m[2][0] && a->m[2][1] == b->m[2][1] && a->m[2][2] == b->m[2][2];
}

/* A gripper that has not turned since the last slice needs no second check of its rotation. */
static wh_status_t validate_input(const wh_gripper_t *gripper, const wh_gripper_input_t *input) {
    const wh_pose_t *pose = &input->base_from_gripper;
    if (!is_same(&gripper->base_from_gripper.R, &pose->R) || !wh_vec3_is_finite(&pose->r)) {
        const wh_status_t status = wh_pose_validate(pose);
        if (status != WH_OK) {
            return status;
        }
    }
    const bool good = input->valve == WH_VALVE_OPEN || input->valve == WH_VALVE_CLOSED;
    return good ? WH_OK : WH_STATUS_BAD_VALVE;
}

wh_event_t *wh_event_append(const wh_grasp_t *table, wh_event_list_t *list, wh_event_kind_t kind) {
    static const wh_event_t blank = {
        .wafer = WH_NONE, .gripper = WH_NONE, .other = WH_NONE, .parts = {WH_NONE, WH_NONE}};
    WH_ASSERT(list->count < list->capacity);
    wh_event_t *event = &list->events[list->count++];
    *event = blank;
    event->kind = kind;
    event->slice = table->slice;
    event->measured_slice = table->slice;
    return event;
}

static void report_refusal(const wh_grasp_t *table, wh_event_list_t *list, size_t gripper,
                           wh_status_t status) {
    wh_event_t *event = wh_event_append(table, list, WH_EVENT_BAD_INPUT);
    event->slice = table->slice + 1;
    event->measured_slice = table->slice + 1;
    event->gripper = (int32_t)gripper;
    event->status = status;
}

static void refuse(wh_grasp_t *table, wh_event_list_t *list, size_t gripper, wh_status_t status) {
    if (list) {
        report_refusal(table, list, gripper, status);
    }
    ++table->counters.refused;
}

static wh_status_t validate_call(const wh_grasp_t *table, const wh_gripper_input_t *inputs,
                                 const wh_event_list_t *list) {
    if (table->grips != 0) {
        return WH_STATUS_HAS_GRIPS;
    }
    if (!inputs && table->storage.gripper_count > 0) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (list && !list->events && list->capacity > 0) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    const bool room = !list || list->capacity / WH_EVENTS_PER_GRIPPER >= table->storage.gripper_count;
    return room ? WH_OK : WH_STATUS_BAD_CAPACITY;
}

/* Part 1. A refused call changes nothing but counters and the list. */
static wh_status_t validate(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    if (table->mark != WH_GRASP_MARK) {
        return WH_STATUS_NOT_INITIALISED;
    }
    const wh_status_t refusal = validate_call(table, inputs, list);
    if (refusal != WH_OK) {
        ++table->counters.refused;
        return refusal;
    }
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        const wh_status_t status = validate_input(&table->storage.grippers[g], &inputs[g]);
        if (status != WH_OK) {
            refuse(table, list, g, status);
            return status;
        }
    }
    return WH_OK;
}

/* A gripper's pose that just passes wh_pose_validate can turn the wafer's pose into one that does not. The
 * table's owner could then pass that pose to no call, so it is mended here. It is never mirrored, since
 * neither factor is. */
void wh_grasp_carry(wh_wafer_t *wafer, const wh_pose_t *base_from_gripper,
                    const wh_pose_t *gripper_from_wafer) {
    wh_pose_compose_to(base_from_gripper, gripper_from_wafer, &wafer->base_from_wafer);
    if (!wh_mat3_is_orthonormal(&wafer->base_from_wafer.R)) {
        wh_mat3_orthonormalise(&wafer->base_from_wafer.R);
    }
}

/* Parts 2 and 3: held wafers move with their grippers; a closed valve releases them there. */
static void carry_and_release(wh_grasp_t *table, const wh_gripper_input_t *inputs) {
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        wh_gripper_t *gripper = &table->storage.grippers[g];
        if (gripper->wafer == WH_NONE) {
            continue;
        }
        wh_wafer_t *wafer = &table->storage.wafers[gripper->wafer];
        wh_grasp_carry(wafer, &inputs[g].base_from_gripper, &gripper->gripper_from_wafer);
        if (inputs[g].valve == WH_VALVE_CLOSED) {
            wafer->holder = WH_NONE;
            wafer->released_by = (int32_t)g;
            wh_index_move(table, (size_t)gripper->wafer);
        }
    }
}

static void pick_sampled(wh_grasp_t *table, size_t g, const wh_gripper_input_t *input,
                         wh_event_list_t *list) {
    const int32_t w = wh_grasp_find_ready(table, g, &input->base_from_gripper);
    if (w == WH_NONE) {
        return;
    }
    wh_grasp_take(table, g, w, &input->base_from_gripper, list);
    if (table->config.seat) {
        wh_grasp_carry(&table->storage.wafers[w], &input->base_from_gripper,
                       &table->storage.grippers[g].gripper_from_wafer);
    }
}

/* Part 4 for one gripper. */
static void pick(wh_grasp_t *table, size_t g, const wh_gripper_input_t *input, wh_event_list_t *list) {
    const wh_gripper_t *gripper = &table->storage.grippers[g];
    if (input->valve == WH_VALVE_CLOSED || gripper->wafer != WH_NONE) {
        return;
    }
    if (!wh_grasp_is_swept(table, g) || !wh_grasp_pick_swept(table, g, input, list)) {
        pick_sampled(table, g, input, list);
    }
}

/* Reports a wafer that was released and that no gripper took. */
static void report_release(wh_grasp_t *table, size_t g, const wh_gripper_input_t *input,
                           wh_event_list_t *list) {
    const int32_t w = table->storage.grippers[g].wafer;
    if (input->valve == WH_VALVE_OPEN || w == WH_NONE || table->storage.wafers[w].holder != WH_NONE) {
        return;
    }
    ++table->counters.released;
    if (list) {
        wh_event_t *event = wh_event_append(table, list, WH_EVENT_RELEASED);
        event->wafer = w;
        event->gripper = (int32_t)g;
        wh_proximity_values(&table->storage.wafers[w].base_from_wafer, &input->base_from_gripper,
                            &table->config.tolerance, &event->measured);
    }
}

/* Keeps the slice's pose and valve. A gripper that released its wafer has named it until now; the pick's
 * note is no longer needed. */
static void remember(wh_grasp_t *table, size_t g, const wh_gripper_input_t *inputs) {
    wh_gripper_t *gripper = &table->storage.grippers[g];
    gripper->base_from_gripper = inputs[g].base_from_gripper;
    if (inputs[g].valve == WH_VALVE_CLOSED && gripper->wafer != WH_NONE) {
        table->storage.wafers[gripper->wafer].released_by = WH_NONE;
        gripper->wafer = WH_NONE;
    }
    gripper->valve = inputs[g].valve;
    gripper->approach.holder = WH_NONE;
}

/* The two small functions below, pick_next and watch, keep WP's goals small enough for its prover. */
static void pick_next(wh_grasp_t *table, size_t g, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    pick(table, g, &inputs[g], list);
}

static void pick_all(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        pick_next(table, g, inputs, list);
    }
}

static void report_releases(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        report_release(table, g, &inputs[g], list);
    }
}

static void watch(wh_grasp_t *table, size_t g, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    wh_encounter_update(table, g, &inputs[g], list);
}

static void watch_all(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        watch(table, g, inputs, list);
    }
}

static void remember_all(wh_grasp_t *table, const wh_gripper_input_t *inputs) {
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        remember(table, g, inputs);
    }
}

/* True if a search would find no wafer: none at rest matters to gripper g, on its way or at its end. */
static bool is_far_from_all(const wh_grasp_t *table, size_t g, const wh_vec3_t *place) {
    const wh_vec3_t *begin = &table->storage.grippers[g].base_from_gripper.r;
    if (!wh_horizon_is_clear_at(table, g, place)) {
        return false;
    }
    return !wh_grasp_is_swept(table, g) || wh_horizon_is_clear_at(table, g, begin);
}

/* False if gripper g only moves on, with its wafer or without. It may act if it watches a wafer, releases
 * one, or is open and not far from all wafers at rest. */
static bool may_act(const wh_grasp_t *table, size_t g, const wh_gripper_input_t *input) {
    const wh_gripper_t *gripper = &table->storage.grippers[g];
    const bool open = input->valve == WH_VALVE_OPEN;
    if (gripper->approach.wafer != WH_NONE || gripper->contest.wafer != WH_NONE) {
        return true;
    }
    if (gripper->wafer != WH_NONE) {
        return !open;
    }
    return open && !is_far_from_all(table, g, &input->base_from_gripper.r);
}

/* True if this slice has no pick, no release and no event. If one gripper holds a wafer and another one is
 * open and empty, the second may contest that wafer. */
static bool is_uneventful(const wh_grasp_t *table, const wh_gripper_input_t *inputs) {
    bool holding = false;
    bool looking = false;
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        const bool holds = table->storage.grippers[g].wafer != WH_NONE;
        if (may_act(table, g, &inputs[g])) {
            return false;
        }
        holding = holding || holds;
        looking = looking || (!holds && inputs[g].valve == WH_VALVE_OPEN);
    }
    return !(holding && looking);
}

static void move(wh_grasp_t *table, size_t g, const wh_gripper_input_t *input) {
    wh_gripper_t *gripper = &table->storage.grippers[g];
    if (gripper->wafer != WH_NONE) {
        wh_grasp_carry(&table->storage.wafers[gripper->wafer], &input->base_from_gripper,
                       &gripper->gripper_from_wafer);
    }
    gripper->base_from_gripper = input->base_from_gripper;
    gripper->valve = input->valve;
}

/* An uneventful slice: the grippers move, and their wafers move with them. */
static void move_all(wh_grasp_t *table, const wh_gripper_input_t *inputs) {
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        move(table, g, &inputs[g]);
    }
}

/* Parts 2 to 4, and their consequences. */
static void advance(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    const bool uneventful = is_uneventful(table, inputs);
    ++table->slice;
    if (uneventful) {
        move_all(table, inputs);
        return;
    }
    carry_and_release(table, inputs);
    pick_all(table, inputs, list);
    report_releases(table, inputs, list);
    watch_all(table, inputs, list);
    remember_all(table, inputs);
}

wh_status_t wh_grasp_step(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    if (list) {
        list->count = 0;
    }
    if (!table) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    const wh_status_t status = validate(table, inputs, list);
    if (status == WH_OK) {
        advance(table, inputs, list);
        WH_ASSERT_CONSISTENT(table);
    }
    return status;
}
