#include "grips.h"

#include "../math/hash.h"
#include "grasp_internal.h"
#include "grips_internal.h"

/* --------------------------------------------------------------------------------------------- setting up */

static wh_status_t validate_arrays(const wh_grips_parts_t *parts, const wh_grasp_storage_t *storage) {
    const bool per_gripper = storage->gripper_count == 0 || (parts->grips && parts->states);
    const bool per_wafer = storage->wafer_count == 0 || parts->seen;
    if (!per_gripper || !per_wafer || (!parts->supports && parts->support_count > 0)) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    return storage->bucket_count == 0 && parts->support_count <= INT32_MAX ? WH_OK : WH_STATUS_BAD_CAPACITY;
}

static wh_status_t validate_numbers(const wh_grips_parts_t *parts) {
    if (!wh_real_is_finite(parts->thickness) || !(parts->dt - parts->dt == 0)) {
        return WH_STATUS_NOT_FINITE;
    }
    const bool good =
        parts->thickness >= 0 && parts->thickness <= WH_FACE_THICKEST && parts->dt > 0 && parts->dt <= 3600;
    return good ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}

/* Validates an edge grip with every wafer that it may meet. */
static wh_status_t validate_edge(const wh_edge_t *edge, const wh_grips_parts_t *parts, size_t wafer_count) {
    wh_status_t status = wh_edge_validate(edge);
    if (status == WH_OK && !parts->shapes && wafer_count > 0) {
        status = WH_STATUS_NULL_ARGUMENT;
    }
    for (size_t w = 0; w < wafer_count && status == WH_OK; ++w) {
        status = wh_edge_wafer_validate(edge, &parts->shapes[w]);
    }
    return status;
}

static wh_status_t validate_grip(const wh_grip_t *grip, const wh_grips_parts_t *parts, size_t wafer_count) {
    switch (grip->kind) {
    case WH_GRIP_VACUUM:
    case WH_GRIP_PASSIVE:
        return WH_OK;
    case WH_GRIP_EDGE:
        return validate_edge(&grip->edge, parts, wafer_count);
    default:
        return WH_STATUS_OUT_OF_RANGE;
    }
}

static wh_status_t validate_parts(const wh_grips_parts_t *parts, const wh_grasp_storage_t *storage) {
    wh_status_t status = validate_arrays(parts, storage);
    if (status == WH_OK) {
        status = validate_numbers(parts);
    }
    for (size_t g = 0; g < storage->gripper_count && status == WH_OK; ++g) {
        status = storage->grippers[g].wafer == WH_NONE
                     ? validate_grip(&parts->grips[g], parts, storage->wafer_count)
                     : WH_STATUS_HELD;
    }
    for (size_t s = 0; s < parts->support_count && status == WH_OK; ++s) {
        status = wh_pose_validate(&parts->supports[s]);
    }
    return status;
}

/* True if the memory that a step writes shares no byte with other memory. */
static bool are_apart(const wh_grips_t *grips, const wh_grips_parts_t *parts, const wh_grasp_t *table) {
    const wh_grasp_storage_t *of = &table->storage;
    const size_t wafers = of->wafer_count;
    const size_t grippers = of->gripper_count;
    const wh_extent_t all[] = {{parts->states, grippers * sizeof *parts->states},
                               {parts->seen, wafers * sizeof *parts->seen},
                               {grips, sizeof *grips},
                               {table, sizeof *table},
                               {of->wafers, wafers * sizeof *of->wafers},
                               {of->grippers, grippers * sizeof *of->grippers},
                               {parts->grips, grippers * sizeof *parts->grips},
                               {parts->shapes, parts->shapes ? wafers * sizeof *parts->shapes : 0},
                               {parts->supports, parts->support_count * sizeof *parts->supports},
                               {parts->speeds, parts->speeds ? grippers * sizeof *parts->speeds : 0}};
    /* The first six are written; the two of the table are apart already. */
    bool apart = true;
    for (size_t i = 0; i < 6; ++i) {
        for (size_t k = i + 1; k < sizeof all / sizeof all[0]; ++k) {
            apart = apart && !wh_extents_overlap(all[i], all[k]);
        }
    }
    return apart;
}

static void clear_state(const wh_grip_t *grip, wh_grip_state_t *state) {
    static const wh_grip_state_t zero = {0};
    *state = zero;
    state->wafer = WH_NONE;
    state->s = grip->kind == WH_GRIP_EDGE ? grip->edge.retracted : 0;
}

wh_status_t wh_grips_init(wh_grips_t *grips, const wh_grips_parts_t *parts, wh_grasp_t *table) {
    if (!grips || !parts || !table) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (table->mark != WH_GRASP_MARK) {
        return WH_STATUS_NOT_INITIALISED;
    }
    wh_status_t status = validate_parts(parts, &table->storage);
    if (status == WH_OK && !are_apart(grips, parts, table)) {
        status = WH_STATUS_OVERLAP;
    }
    if (status == WH_OK) {
        grips->parts = *parts;
        grips->table = table;
        table->grips = table->grips < UINT32_MAX ? table->grips + 1 : 1;
        grips->number = table->grips;
        grips->mark = WH_GRIPS_MARK;
        for (size_t g = 0; g < table->storage.gripper_count; ++g) {
            clear_state(&parts->grips[g], &parts->states[g]);
        }
    }
    return status;
}

/* ----------------------------------------------------------------------------------------------- refusing */

static wh_status_t validate_call(const wh_grasp_t *table, const wh_gripper_input_t *inputs,
                                 const wh_event_list_t *list) {
    const size_t count = table->storage.gripper_count;
    if ((!inputs && count > 0) || (list && !list->events && list->capacity > 0)) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    return !list || list->capacity / WH_EVENTS_PER_GRIPPER >= count ? WH_OK : WH_STATUS_BAD_CAPACITY;
}

static wh_status_t validate_speed(const double *speeds, size_t g) {
    if (!speeds) {
        return WH_OK;
    }
    if (!(speeds[g] - speeds[g] == 0)) {
        return WH_STATUS_NOT_FINITE;
    }
    return speeds[g] >= 0 ? WH_OK : WH_STATUS_OUT_OF_RANGE;
}

static wh_status_t validate_input(const wh_grips_t *grips, const wh_gripper_input_t *input, size_t g) {
    const wh_status_t status = wh_pose_validate(&input->base_from_gripper);
    if (status != WH_OK) {
        return status;
    }
    const bool good = input->valve == WH_VALVE_OPEN || input->valve == WH_VALVE_CLOSED;
    return good ? validate_speed(grips->parts.speeds, g) : WH_STATUS_BAD_VALVE;
}

static wh_status_t refuse_input(const wh_grasp_t *table, size_t g, wh_status_t status,
                                wh_event_list_t *list) {
    if (list) {
        wh_event_t *event = wh_event_append(table, list, WH_EVENT_BAD_INPUT);
        event->slice = table->slice + 1;
        event->measured_slice = table->slice + 1;
        event->gripper = (int32_t)g;
        event->status = status;
    }
    return status;
}

static wh_status_t validate(const wh_grips_t *grips, const wh_gripper_input_t *inputs,
                            wh_event_list_t *list) {
    const wh_grasp_t *table = grips->table;
    wh_status_t status = validate_call(table, inputs, list);
    for (size_t g = 0; g < table->storage.gripper_count && status == WH_OK; ++g) {
        status = validate_input(grips, &inputs[g], g);
        if (status != WH_OK) {
            return refuse_input(table, g, status, list);
        }
    }
    return status;
}

/* ----------------------------------------------------------------------------------------------- one turn */

wh_face_t wh_turn_face(const wh_turn_t *turn, size_t wafer, wh_pose_t *base_from_face) {
    const wh_pose_t *base_from_wafer = &wh_turn_wafers(turn)[wafer].base_from_wafer;
    const wh_real_t thickness = turn->grips->parts.thickness;
    const wh_face_t face = wh_face_seen(base_from_wafer, thickness, &turn->input->base_from_gripper);
    wh_face_frame(base_from_wafer, thickness, face, base_from_face);
    return face;
}

static void report(const wh_turn_t *turn, wh_event_kind_t kind, size_t w, int32_t other) {
    const wh_grasp_t *table = turn->grips->table;
    if (turn->list) {
        wh_pose_t base_from_face;
        wh_event_t *event = wh_event_append(table, turn->list, kind);
        event->wafer = (int32_t)w;
        event->gripper = (int32_t)turn->index;
        event->other = other;
        event->face = wh_turn_face(turn, w, &base_from_face);
        wh_proximity_values(&base_from_face, &turn->input->base_from_gripper, &table->config.tolerance,
                            &event->measured);
    }
}

void wh_turn_take(const wh_turn_t *turn, size_t w) {
    wh_wafer_t *wafer = &wh_turn_wafers(turn)[w];
    wh_grasp_counters_t *counters = &turn->grips->table->counters;
    const bool handed_over = wafer->released_by != WH_NONE;
    *(handed_over ? &counters->handed_over : &counters->picked) += 1;
    report(turn, handed_over ? WH_EVENT_HANDED_OVER : WH_EVENT_PICKED, w, wafer->released_by);
    wafer->holder = (int32_t)turn->index;
    turn->gripper->wafer = (int32_t)w;
}

void wh_turn_let_go(const wh_turn_t *turn) {
    wh_wafer_t *wafer = &wh_turn_wafers(turn)[turn->gripper->wafer];
    wafer->holder = WH_NONE;
    wafer->released_by = (int32_t)turn->index;
}

static bool has_let_go(const wh_turn_t *turn) {
    const int32_t w = turn->gripper->wafer;
    return w != WH_NONE && wh_turn_wafers(turn)[w].released_by == (int32_t)turn->index;
}

static void report_release(const wh_turn_t *turn) {
    const int32_t w = turn->gripper->wafer;
    if (has_let_go(turn) && wh_turn_wafers(turn)[w].holder == WH_NONE) {
        ++turn->grips->table->counters.released;
        report(turn, WH_EVENT_RELEASED, (size_t)w, WH_NONE);
    }
}

/* Does this like the table's own step. */
static void remember(const wh_turn_t *turn) {
    wh_gripper_t *gripper = turn->gripper;
    if (has_let_go(turn)) {
        wh_turn_wafers(turn)[gripper->wafer].released_by = WH_NONE;
        gripper->wafer = WH_NONE;
    }
    gripper->base_from_gripper = turn->input->base_from_gripper;
    gripper->valve = turn->input->valve;
    gripper->approach.holder = WH_NONE;
}

/* ----------------------------------------------------------------------------------------------- the step */

static void move(const wh_turn_t *turn, wh_grip_kind_t kind) {
    switch (kind) {
    case WH_GRIP_EDGE:
        wh_edge_turn_move(turn);
        break;
    case WH_GRIP_PASSIVE:
        wh_passive_turn_move(turn);
        break;
    case WH_GRIP_VACUUM:
    default:
        wh_vacuum_turn_move(turn);
        break;
    }
}

static void pick(const wh_turn_t *turn, wh_grip_kind_t kind) {
    if (turn->gripper->wafer != WH_NONE) {
        return;
    }
    switch (kind) {
    case WH_GRIP_EDGE:
        wh_edge_turn_pick(turn);
        break;
    case WH_GRIP_PASSIVE:
        wh_passive_turn_pick(turn);
        break;
    case WH_GRIP_VACUUM:
    default:
        wh_vacuum_turn_pick(turn);
        break;
    }
}

static void watch(const wh_turn_t *turn, wh_grip_kind_t kind) {
    if (kind == WH_GRIP_VACUUM) {
        wh_vacuum_turn_watch(turn);
    }
}

/* The parts of a step; each is done for all grippers before the next one. */
typedef enum { MOVES, PICKS, RELEASES, WATCHES, ENDS, PARTS } part_t;

static void take_turn(const wh_turn_t *turn, part_t part) {
    const wh_grip_kind_t kind = turn->grips->parts.grips[turn->index].kind;
    switch (part) {
    case MOVES:
        move(turn, kind);
        break;
    case PICKS:
        pick(turn, kind);
        break;
    case RELEASES:
        report_release(turn);
        break;
    case WATCHES:
        watch(turn, kind);
        break;
    case ENDS:
    case PARTS:
    default:
        remember(turn);
        break;
    }
}

static void advance(wh_grips_t *grips, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    wh_grasp_storage_t *storage = &grips->table->storage;
    ++grips->table->slice;
    for (int part = MOVES; part < PARTS; ++part) {
        for (size_t g = 0; g < storage->gripper_count; ++g) {
            const wh_turn_t turn = {grips, &storage->grippers[g], &inputs[g], list, g};
            take_turn(&turn, (part_t)part);
        }
    }
}

wh_status_t wh_grips_step(wh_grips_t *grips, const wh_gripper_input_t *inputs, wh_event_list_t *list) {
    if (list) {
        list->count = 0;
    }
    if (!grips) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (grips->mark != WH_GRIPS_MARK || grips->table->mark != WH_GRASP_MARK ||
        grips->number != grips->table->grips) {
        return WH_STATUS_NOT_INITIALISED;
    }
    const wh_status_t status = validate(grips, inputs, list);
    if (status != WH_OK) {
        ++grips->table->counters.refused;
        return status;
    }
    advance(grips, inputs, list);
    WH_ASSERT_CONSISTENT(grips->table);
    return WH_OK;
}

static uint64_t hash_grip(uint64_t hash, wh_grip_kind_t kind, const wh_grip_state_t *state) {
    const wh_edge_wafer_t *lying = &state->lying;
    const double numbers[] = {lying->radius,  lying->x,      lying->y,       lying->depth,
                              lying->opening, lying->bottom, lying->notch_x, lying->notch_y};
    hash = wh_hash_int(hash, (int32_t)kind);
    hash = wh_hash_int(hash, (int32_t)state->phase);
    hash = wh_hash_int(hash, state->wafer);
    hash = wh_hash_doubles(hash, &state->s, 1);
    hash = wh_hash_doubles(hash, &state->excess, 1);
    if (state->phase == WH_GRIP_CLOSING) {
        hash = wh_hash_real(hash, state->x);
        hash = wh_hash_real(hash, state->y);
        hash = wh_hash_doubles(hash, numbers, sizeof numbers / sizeof numbers[0]);
    }
    return hash;
}

uint64_t wh_grips_hash(const wh_grips_t *grips) {
    uint64_t hash = wh_grasp_hash(grips->table);
    for (size_t g = 0; g < grips->table->storage.gripper_count; ++g) {
        const wh_grip_kind_t kind = grips->parts.grips[g].kind;
        if (kind != WH_GRIP_VACUUM) {
            hash = hash_grip(hash, kind, &grips->parts.states[g]);
        }
    }
    return hash;
}
