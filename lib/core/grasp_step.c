#include "core/encounter_internal.h"
#include "core/proximity_internal.h"
#include "core/sweep_internal.h"

/* The best wafer so far that a gripper may take. */
typedef struct {
    int32_t wafer; /* WH_NONE: none */
    wh_real_t t;   /* the instant within the slice, 1 being its end */
    wh_real_t distance;
} candidate_t;

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

/* Where a gripper carries its wafer. A gripper's pose that just passes wh_pose_validate can turn the wafer's
 * into one that does not, and that the table's owner could not hand back to any call: such a one is mended.
 */
static wh_pose_t carried(const wh_pose_t *base_from_gripper, const wh_pose_t *gripper_from_wafer) {
    wh_pose_t base_from_wafer = wh_pose_compose(base_from_gripper, gripper_from_wafer);
    if (wh_pose_validate(&base_from_wafer) != WH_OK) {
        base_from_wafer.R = wh_mat3_orthonormalise(&base_from_wafer.R);
    }
    return base_from_wafer;
}

/* Parts 2 and 3: held wafers go where their grippers carry them; a closed valve lets go of them there. */
static void carry_and_release(wh_grasp_t *table, const wh_gripper_input_t *inputs) {
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        wh_gripper_t *gripper = &table->storage.grippers[g];
        if (gripper->wafer == WH_NONE) {
            continue;
        }
        wh_wafer_t *wafer = &table->storage.wafers[gripper->wafer];
        wafer->base_from_wafer = carried(&inputs[g].base_from_gripper, &gripper->gripper_from_wafer);
        if (inputs[g].valve == WH_VALVE_CLOSED) {
            wafer->holder = WH_NONE;
            wafer->released_by = (int32_t)g;
        }
    }
}

static wh_real_t distance(const wh_wafer_t *wafer, const wh_pose_t *base_from_gripper) {
    const wh_vec3_t dr = wh_vec3_subtract(&wafer->base_from_wafer.r, &base_from_gripper->r);
    const wh_vec3_t n1 = wh_mat3_column(&wafer->base_from_wafer.R, 2);
    return wh_real_abs(wh_vec3_dot(&dr, &n1));
}

/* Earliest instant, then smallest |dr_proj_z|; of equal ones the first, which has the lowest index. */
static void keep_better(candidate_t *best, size_t wafer, wh_real_t t, wh_real_t dr_proj_z) {
    if (best->wafer == WH_NONE || t < best->t || (t == best->t && dr_proj_z < best->distance)) {
        best->wafer = (int32_t)wafer;
        best->t = t;
        best->distance = dr_proj_z;
    }
}

static void find_sampled(const wh_grasp_t *table, const wh_pose_t *base_from_gripper, candidate_t *best) {
    for (size_t w = 0; w < table->storage.wafer_count; ++w) {
        const wh_wafer_t *wafer = &table->storage.wafers[w];
        if (wafer->holder == WH_NONE &&
            wh_proximity_ready(&wafer->base_from_wafer, base_from_gripper, &table->config.tolerance)) {
            keep_better(best, w, 1, distance(wafer, base_from_gripper));
        }
    }
}

static void find_swept(const wh_grasp_t *table, const wh_sweep_t *sweep, candidate_t *best) {
    for (size_t w = 0; w < table->storage.wafer_count; ++w) {
        const wh_wafer_t *wafer = &table->storage.wafers[w];
        wh_real_t t;
        if (wafer->holder == WH_NONE && wafer->released_by == WH_NONE &&
            wh_sweep_first_ready(sweep, &wafer->base_from_wafer, &table->config.tolerance, &t)) {
            const wh_pose_t then = wh_sweep_pose_at(sweep, t);
            keep_better(best, w, t, distance(wafer, &then));
        }
    }
}

/* The smallest turn of the wafer, in the gripper's frame, that takes n1 to n2 = e3. c > 0 at every pick. */
static void seat(wh_pose_t *gripper_from_wafer) {
    const wh_vec3_t n1 = wh_mat3_column(&gripper_from_wafer->R, 2);
    const wh_real_t a = n1.x;
    const wh_real_t b = n1.y;
    const wh_real_t c = n1.z;
    const wh_real_t f = 1 / (1 + c);
    const wh_mat3_t turn = {{{1 - f * a * a, -f * a * b, -a}, {-f * a * b, 1 - f * b * b, -b}, {a, b, c}}};
    const wh_mat3_t turned = wh_mat3_multiply(&turn, &gripper_from_wafer->R);
    gripper_from_wafer->R = wh_mat3_orthonormalise(&turned);
    gripper_from_wafer->r.z = 0;
}

/* Takes the wafer with the gripper at `then`; the slice ends at `input`. The rotation is brought back to
 * orthonormal, so that poses which are so only to WH_ROTATION_TOLERANCE do not add up over many picks. */
static void take(wh_grasp_t *table, size_t g, const wh_gripper_input_t *input, const candidate_t *taken,
                 const wh_pose_t *then) {
    wh_gripper_t *gripper = &table->storage.grippers[g];
    wh_wafer_t *wafer = &table->storage.wafers[taken->wafer];
    wh_pose_t *gripper_from_wafer = &gripper->gripper_from_wafer;
    *gripper_from_wafer = wh_pose_relative(then, &wafer->base_from_wafer);
    gripper_from_wafer->R = wh_mat3_orthonormalise(&gripper_from_wafer->R);
    if (table->config.seat) {
        seat(gripper_from_wafer);
    }
    if (table->config.seat || taken->t < 1) {
        wafer->base_from_wafer = carried(&input->base_from_gripper, gripper_from_wafer);
    }
    wafer->holder = (int32_t)g;
    gripper->wafer = taken->wafer;
}

/* Before the wafer is taken: a seated wafer would no longer show what made it ready. */
static void report_taken(wh_grasp_t *table, wh_event_list_t *list, size_t g, int32_t w,
                         const wh_pose_t *then) {
    const wh_wafer_t *wafer = &table->storage.wafers[w];
    const bool handed_over = wafer->released_by != WH_NONE;
    *(handed_over ? &table->counters.handed_over : &table->counters.picked) += 1;
    if (list) {
        wh_event_t *event =
            wh_event_append(table, list, handed_over ? WH_EVENT_HANDED_OVER : WH_EVENT_PICKED);
        event->wafer = w;
        event->gripper = (int32_t)g;
        event->other = wafer->released_by;
        wh_proximity_values(&wafer->base_from_wafer, then, &table->config.tolerance, &event->measured);
    }
}

static void take_and_report(wh_grasp_t *table, size_t g, const wh_gripper_input_t *input,
                            const candidate_t *taken, const wh_pose_t *then, wh_event_list_t *list) {
    report_taken(table, list, g, taken->wafer, then);
    take(table, g, input, taken, then);
}

static bool pick_swept(wh_grasp_t *table, size_t g, const wh_gripper_input_t *input, wh_event_list_t *list) {
    const wh_sweep_t sweep =
        wh_sweep_between(&table->storage.grippers[g].base_from_gripper, &input->base_from_gripper);
    candidate_t best = {.wafer = WH_NONE};
    find_swept(table, &sweep, &best);
    if (best.wafer == WH_NONE) {
        return false;
    }
    const wh_pose_t then = wh_sweep_pose_at(&sweep, best.t);
    take_and_report(table, g, input, &best, &then, list);
    return true;
}

/* Part 4 for one gripper. */
static void pick(wh_grasp_t *table, size_t g, const wh_gripper_input_t *input, wh_event_list_t *list) {
    const wh_gripper_t *gripper = &table->storage.grippers[g];
    if (input->valve == WH_VALVE_CLOSED || gripper->wafer != WH_NONE) {
        return;
    }
    const bool swept = table->config.check == WH_CHECK_SWEPT && gripper->valve == WH_VALVE_OPEN;
    if (swept && pick_swept(table, g, input, list)) {
        return;
    }
    candidate_t best = {.wafer = WH_NONE};
    find_sampled(table, &input->base_from_gripper, &best);
    if (best.wafer != WH_NONE) {
        take_and_report(table, g, input, &best, &input->base_from_gripper, list);
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
    const size_t gripper_count = table->storage.gripper_count;
    ++table->slice;
    carry_and_release(table, inputs);
    for (size_t g = 0; g < gripper_count; ++g) {
        pick(table, g, &inputs[g], list);
    }
    for (size_t g = 0; g < gripper_count; ++g) {
        report_release(table, g, &inputs[g], list);
    }
    for (size_t g = 0; g < gripper_count; ++g) {
        wh_encounter_update(table, g, &inputs[g], list);
    }
    for (size_t g = 0; g < gripper_count; ++g) {
        remember(table, g, &inputs[g]);
    }
    return WH_OK;
}
