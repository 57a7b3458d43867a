#include "core/encounter_internal.h"
#include "core/grasp_internal.h"
#include "core/proximity_internal.h"

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

static wh_status_t validate_input(const wh_gripper_input_t *input) {
    const wh_status_t status = wh_pose_validate(&input->base_from_gripper);
    if (status != WH_OK) {
        return status;
    }
    const bool good = input->valve == WH_VALVE_OPEN || input->valve == WH_VALVE_CLOSED;
    return good ? WH_OK : WH_STATUS_BAD_VALVE;
}

static wh_status_t refuse(wh_grasp_t *table, wh_event_list_t *list, size_t gripper, wh_status_t status) {
    ++table->counters.refused;
    if (list) {
        wh_event_t *event = wh_event_append(table, list, WH_EVENT_BAD_INPUT);
        event->slice = table->slice + 1;
        event->measured_slice = table->slice + 1;
        event->gripper = (int32_t)gripper;
        event->status = status;
    }
    return status;
}

static wh_status_t validate_inputs(wh_grasp_t *table, const wh_gripper_input_t *inputs,
                                   wh_event_list_t *list) {
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        const wh_status_t status = validate_input(&inputs[g]);
        if (status != WH_OK) {
            return refuse(table, list, g, status);
        }
    }
    return WH_OK;
}

/* A gripper's pose that just passes wh_pose_validate can turn the wafer's into one that does not, and that the table's
 * owner could not hand back to any call: such a one is mended. */
void wh_grasp_carry(wh_wafer_t *wafer, const wh_pose_t *base_from_gripper,
                    const wh_pose_t *gripper_from_wafer) {
    wh_pose_compose_to(base_from_gripper, gripper_from_wafer, &wafer->base_from_wafer);
    if (wh_pose_validate(&wafer->base_from_wafer) != WH_OK) {
        wh_mat3_orthonormalise(&wafer->base_from_wafer.R);
    }
}

/* Parts 2 and 3: held wafers go where their grippers carry them; a closed valve lets go of them there. */
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
        }
    }
}

static void pick_sampled(wh_grasp_t *table, size_t g, const wh_gripper_input_t *input,
                         wh_event_list_t *list) {
    const int32_t w = wh_grasp_find_ready(table, &input->base_from_gripper, false);
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
    const bool swept = table->config.check == WH_CHECK_SWEPT && gripper->valve == WH_VALVE_OPEN;
    if (!swept || !wh_grasp_pick_swept(table, g, input, list)) {
        pick_sampled(table, g, input, list);
    }
}

/* A wafer that was let go and that nobody took. */
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

/* A gripper that let go still names its wafer up to here. */
static void remember(wh_grasp_t *table, size_t g, const wh_gripper_input_t *input) {
    wh_gripper_t *gripper = &table->storage.grippers[g];
    if (input->valve == WH_VALVE_CLOSED && gripper->wafer != WH_NONE) {
        table->storage.wafers[gripper->wafer].released_by = WH_NONE;
        gripper->wafer = WH_NONE;
    }
    gripper->base_from_gripper = input->base_from_gripper;
    gripper->valve = input->valve;
}

static wh_status_t validate_call(const wh_grasp_t *table, const wh_gripper_input_t *inputs,
                                 const wh_event_list_t *list) {
    if (!inputs && table->storage.gripper_count > 0) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (list && !list->events && list->capacity > 0) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    const bool room = !list || list->capacity / WH_EVENTS_PER_GRIPPER >= table->storage.gripper_count;
    return room ? WH_OK : WH_STATUS_BAD_CAPACITY;
}

wh_status_t wh_grasp_step(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    if (list) {
        list->count = 0;
    }
    if (!table) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    wh_status_t status = validate_call(table, inputs, list);
    if (status != WH_OK) {
        ++table->counters.refused;
        return status;
    }
    status = validate_inputs(table, inputs, list);
    if (status != WH_OK) {
        return status;
    }
    ++table->slice;
    carry_and_release(table, inputs);
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        pick(table, g, &inputs[g], list);
    }
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        report_release(table, g, &inputs[g], list);
    }
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        wh_encounter_update(table, g, &inputs[g], list);
    }
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        remember(table, g, &inputs[g]);
    }
    return WH_OK;
}
