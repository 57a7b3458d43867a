/* The edge grip within a step: the plunger's motion, and the wafer that it meets. */
#include "grasp_internal.h"
#include "grips_internal.h"

static wh_grip_state_t *state_of(const wh_turn_t *turn) {
    return &turn->grips->parts.states[turn->index];
}

static const wh_edge_t *edge_of(const wh_turn_t *turn) {
    return &turn->grips->parts.grips[turn->index].edge;
}

/* The way of the plunger in this slice. */
static wh_real_t way_of(const wh_turn_t *turn) {
    const double *speeds = turn->grips->parts.speeds;
    const wh_real_t speed = (wh_real_t)edge_of(turn)->speed;
    const wh_real_t slow = speeds ? (wh_real_t)speeds[turn->index] : speed;
    return (slow < speed ? slow : speed) * (wh_real_t)turn->grips->parts.dt;
}

static void go_back(const wh_turn_t *turn) {
    wh_grip_state_t *state = state_of(turn);
    const wh_real_t back = (wh_real_t)state->s - way_of(turn);
    const double retracted = edge_of(turn)->retracted;
    state->s = (double)back;
    state->phase = WH_GRIP_OPENING;
    state->wafer = WH_NONE;
    state->excess = 0;
    if (back <= (wh_real_t)retracted) {
        state->s = retracted;
        state->phase = WH_GRIP_OPEN;
    }
}

/* Without a wafer the place gives only the window. */
static wh_edge_place_t place_at(const wh_turn_t *turn, wh_real_t at) {
    const double s = (double)at;
    const wh_grip_state_t *state = state_of(turn);
    wh_edge_place_t place = {WH_EDGE_FREE, WH_EDGE_SHORT, false, s, 0, 0, 0};
    (void)wh_edge_at(edge_of(turn), state->wafer == WH_NONE ? NULL : &state->lying, s, &place);
    return place;
}

/* The phase of a plunger that stands, or CLOSING. */
static wh_grip_phase_t phase_at(const wh_turn_t *turn, const wh_edge_place_t *place) {
    const bool stands = place->phase == WH_EDGE_SEATED || place->phase == WH_EDGE_JAMMED ||
                        (wh_real_t)place->s >= (wh_real_t)edge_of(turn)->end;
    if (!stands) {
        return WH_GRIP_CLOSING;
    }
    if (place->held) {
        return WH_GRIP_CLOSED;
    }
    return place->window == WH_EDGE_OVERTRAVEL ? WH_GRIP_MISSED : WH_GRIP_JAMMED;
}

static void go_on(const wh_turn_t *turn) {
    wh_grip_state_t *state = state_of(turn);
    const wh_edge_place_t place = place_at(turn, (wh_real_t)state->s + way_of(turn));
    state->s = place.s;
    state->phase = phase_at(turn, &place);
    state->excess = place.excess;
    if (turn->gripper->wafer != WH_NONE) {
        turn->gripper->gripper_from_wafer.r.x = state->x + ((wh_real_t)place.x - (wh_real_t)state->lying.x);
        turn->gripper->gripper_from_wafer.r.y = state->y + ((wh_real_t)place.y - (wh_real_t)state->lying.y);
    }
}

void wh_edge_turn_move(const wh_turn_t *turn) {
    const wh_grip_state_t *state = state_of(turn);
    const bool is_stuck = state->phase == WH_GRIP_CLOSED && !(way_of(turn) > 0);
    const bool back = !is_stuck && (turn->input->valve == WH_VALVE_CLOSED || state->phase == WH_GRIP_OPENING);
    const bool on = !back && state->phase == WH_GRIP_CLOSING;
    if (back) {
        go_back(turn);
    }
    if (on) {
        go_on(turn);
    }
    if (turn->gripper->wafer == WH_NONE) {
        return;
    }
    wh_grasp_carry(&wh_turn_wafers(turn)[turn->gripper->wafer], &turn->input->base_from_gripper,
                   &turn->gripper->gripper_from_wafer);
    if (state->phase != WH_GRIP_CLOSING && state->phase != WH_GRIP_CLOSED) {
        wh_turn_let_go(turn);
    }
}

/* The notch's axis as it lies on the blade; any direction for a wafer that stands on edge. */
static void turn_notch(const wh_mat3_t *gripper_from_wafer, wh_edge_wafer_t *lying) {
    const wh_mat3_t *m = gripper_from_wafer;
    const wh_real_t notch_x = (wh_real_t)lying->notch_x;
    const wh_real_t notch_y = (wh_real_t)lying->notch_y;
    const wh_real_t x = m->m[0][0] * notch_x + m->m[0][1] * notch_y;
    const wh_real_t y = m->m[1][0] * notch_x + m->m[1][1] * notch_y;
    const wh_real_t length = wh_real_sqrt(x * x + y * y);
    lying->notch_x = (double)(length > 0 ? x / length : 0);
    lying->notch_y = (double)(length > 0 ? y / length : 1);
}

/* Finds how this wafer lies on the blade; false if it lies where no plunger may meet it. */
static bool find_lying(const wh_turn_t *turn, size_t w, wh_edge_wafer_t *lying, wh_real_t *distance) {
    const wh_pose_t *pose = &turn->input->base_from_gripper;
    wh_pose_t face;
    wh_proximity_t p;
    (void)wh_turn_face(turn, w, &face);
    wh_proximity_values(&face, pose, &turn->grips->table->config.tolerance, &p);
    if ((p.failed & ~(unsigned)WH_FAILED_PROJXY) != 0) {
        return false;
    }
    wh_pose_t gripper_from_face;
    wh_pose_t gripper_from_wafer;
    wh_pose_relative_to(pose, &face, &gripper_from_face);
    wh_pose_relative_to(pose, &wh_turn_wafers(turn)[w].base_from_wafer, &gripper_from_wafer);
    *lying = turn->grips->parts.shapes[w];
    lying->x = (double)gripper_from_face.r.x;
    lying->y = (double)gripper_from_face.r.y;
    turn_notch(&gripper_from_wafer.R, lying);
    *distance = wh_real_abs(p.dr_proj_z);
    return wh_edge_wafer_validate(edge_of(turn), lying) == WH_OK;
}

static void find_wafer(const wh_turn_t *turn) {
    wh_grip_state_t *state = state_of(turn);
    wh_real_t least = 0;
    for (size_t w = 0; w < turn->grips->table->storage.wafer_count; ++w) {
        wh_edge_wafer_t lying;
        wh_real_t distance;
        if (wh_turn_wafers(turn)[w].holder == WH_NONE && find_lying(turn, w, &lying, &distance) &&
            (state->wafer == WH_NONE || distance < least)) {
            state->wafer = (int32_t)w;
            state->lying = lying;
            least = distance;
        }
    }
}

static void grip(const wh_turn_t *turn, size_t w) {
    wh_pose_t *gripper_from_wafer = &turn->gripper->gripper_from_wafer;
    wh_turn_take(turn, w);
    wh_pose_relative_to(&turn->input->base_from_gripper, &wh_turn_wafers(turn)[w].base_from_wafer,
                        gripper_from_wafer);
    wh_mat3_orthonormalise(&gripper_from_wafer->R);
    state_of(turn)->x = gripper_from_wafer->r.x;
    state_of(turn)->y = gripper_from_wafer->r.y;
}

void wh_edge_turn_pick(const wh_turn_t *turn) {
    wh_grip_state_t *state = state_of(turn);
    if (turn->input->valve == WH_VALVE_CLOSED || state->phase != WH_GRIP_OPEN) {
        return;
    }
    state->phase = WH_GRIP_CLOSING;
    state->x = 0;
    state->y = 0;
    find_wafer(turn);
    const wh_edge_place_t last = place_at(turn, (wh_real_t)edge_of(turn)->end);
    if (state->wafer != WH_NONE && last.phase != WH_EDGE_JAMMED && last.phase != WH_EDGE_MISSED) {
        grip(turn, (size_t)state->wafer);
    }
}
