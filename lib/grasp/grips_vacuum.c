/* Vacuum among other grips: the table's own pick and watch, with the faces towards the gripper. */
#include "encounter_internal.h"
#include "grasp_internal.h"
#include "grips_internal.h"

static wh_face_t face_of(const wh_turn_t *turn, const wh_pose_t *base_from_wafer) {
    return wh_face_seen(base_from_wafer, turn->grips->parts.thickness, &turn->input->base_from_gripper);
}

static bool shows_any_front(const wh_turn_t *turn) {
    const wh_wafer_t *wafers = wh_turn_wafers(turn);
    bool any = false;
    for (size_t w = 0; w < turn->grips->table->storage.wafer_count && !any; ++w) {
        any = face_of(turn, &wafers[w].base_from_wafer) == WH_FACE_FRONT;
    }
    return any;
}

/* During this the table's wafers are replaced by their faces towards this gripper. Returns the wafers
 * themselves; null if each shows its back, and nothing was changed. */
static wh_wafer_t *look(const wh_turn_t *turn) {
    wh_wafer_t *own = wh_turn_wafers(turn);
    wh_wafer_t *seen = turn->grips->parts.seen;
    if (!shows_any_front(turn)) {
        return NULL;
    }
    for (size_t w = 0; w < turn->grips->table->storage.wafer_count; ++w) {
        seen[w] = own[w];
        (void)wh_turn_face(turn, w, &seen[w].base_from_wafer);
    }
    turn->grips->table->storage.wafers = seen;
    return own;
}

static size_t count_events(const wh_turn_t *turn) {
    return turn->list ? turn->list->count : 0;
}

/* Sets the face for values measured in this slice; older values keep their face. */
static void name_face(const wh_turn_t *turn, const wh_wafer_t *own, int32_t wafer, uint64_t measured,
                      wh_face_t *face) {
    const wh_grasp_t *table = turn->grips->table;
    if (measured == table->slice && wh_is_index(wafer, table->storage.wafer_count)) {
        *face = face_of(turn, &own[wafer].base_from_wafer);
    }
}

static void look_away(const wh_turn_t *turn, wh_wafer_t *own, size_t first_event) {
    wh_encounter_t *approach = &turn->gripper->approach;
    wh_encounter_t *contest = &turn->gripper->contest;
    turn->grips->table->storage.wafers = own;
    name_face(turn, own, approach->wafer, approach->slice, &approach->face);
    name_face(turn, own, contest->wafer, contest->slice, &contest->face);
    for (size_t i = first_event; i < count_events(turn); ++i) {
        wh_event_t *event = &turn->list->events[i];
        name_face(turn, own, event->wafer, event->measured_slice, &event->face);
    }
}

/* A wafer that was taken by its face's frame is then held by its own frame. */
static void take_over(const wh_turn_t *turn, wh_wafer_t *own) {
    wh_gripper_t *gripper = turn->gripper;
    const wh_pose_t *pose = &turn->input->base_from_gripper;
    wh_wafer_t *wafer = &own[gripper->wafer];
    const bool front = face_of(turn, &wafer->base_from_wafer) == WH_FACE_FRONT;
    wafer->holder = (int32_t)turn->index;
    if (front) {
        const wh_pose_t gripper_from_face = gripper->gripper_from_wafer;
        wh_face_frame(&gripper_from_face, turn->grips->parts.thickness, WH_FACE_FRONT,
                      &gripper->gripper_from_wafer);
    } else {
        wafer->base_from_wafer = turn->grips->parts.seen[gripper->wafer].base_from_wafer;
    }
    if (front && (turn->grips->table->config.seat || wh_grasp_is_swept(turn->grips->table, turn->index))) {
        wh_grasp_carry(wafer, pose, &gripper->gripper_from_wafer);
    }
}

static void pick_sampled(const wh_turn_t *turn) {
    wh_grasp_t *table = turn->grips->table;
    const wh_pose_t *pose = &turn->input->base_from_gripper;
    const int32_t w = wh_grasp_find_ready(table, turn->index, pose);
    if (w == WH_NONE) {
        return;
    }
    wh_grasp_take(table, turn->index, w, pose, turn->list);
    if (table->config.seat) {
        wh_grasp_carry(&table->storage.wafers[w], pose, &turn->gripper->gripper_from_wafer);
    }
}

void wh_vacuum_turn_pick(const wh_turn_t *turn) {
    wh_grasp_t *table = turn->grips->table;
    if (turn->input->valve == WH_VALVE_CLOSED) {
        return;
    }
    const size_t first_event = count_events(turn);
    wh_wafer_t *own = look(turn);
    if (!wh_grasp_is_swept(table, turn->index) ||
        !wh_grasp_pick_swept(table, turn->index, turn->input, turn->list)) {
        pick_sampled(turn);
    }
    if (own && turn->gripper->wafer != WH_NONE) {
        take_over(turn, own);
    }
    if (own) {
        look_away(turn, own, first_event);
    }
}

void wh_vacuum_turn_watch(const wh_turn_t *turn) {
    const size_t first_event = count_events(turn);
    wh_wafer_t *own = look(turn);
    wh_encounter_update(turn->grips->table, turn->index, turn->input, turn->list);
    if (own) {
        look_away(turn, own, first_event);
    }
}

void wh_vacuum_turn_move(const wh_turn_t *turn) {
    if (turn->gripper->wafer == WH_NONE) {
        return;
    }
    wh_grasp_carry(&wh_turn_wafers(turn)[turn->gripper->wafer], &turn->input->base_from_gripper,
                   &turn->gripper->gripper_from_wafer);
    if (turn->input->valve == WH_VALVE_CLOSED) {
        wh_turn_let_go(turn);
    }
}
