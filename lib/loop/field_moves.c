#include "field_moves.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../layout/axes.h"
#include "../math/trig.h"
#include "../motion/profile.h"
#include "../text/array.h"

/* Logs with rows farther apart tell no time to a millisecond, s. */
#define FINE_S 0.0015
#define ALIKE_S 0.001

static double number_of(const wh_layout_t *layout, size_t axis, wh_real_t q) {
    return wh_layout_axis_turns(layout, axis) ? wh_deg_from_rad(q) : q;
}

static void keep_move(wh_field_moves_t *moves, size_t axis) {
    const wh_field_axis_t *state = &moves->axes[axis];
    if (state->is_odd) {
        ++moves->odd;
        return;
    }
    moves->moves = wh_array_grow(moves->moves, moves->count, &moves->capacity, sizeof *moves->moves);
    moves->moves[moves->count++] =
        (wh_field_move_t){axis, state->from, state->last, state->last_s - state->from_s};
}

static void go_on(wh_field_axis_t *state, double by, double now, double now_s) {
    if (!state->moves) {
        state->moves = state->has_moved = true;
        state->is_odd = false;
        state->direction = by;
    }
    state->is_odd = state->is_odd || by * state->direction < 0;
    state->last = now;
    state->last_s = now_s;
}

static void take_axis(wh_field_moves_t *moves, size_t axis, double now_s, double before, double now) {
    wh_field_axis_t *state = &moves->axes[axis];
    if (fabs(now - before) >= moves->rest) {
        go_on(state, now - before, now, now_s);
    } else if (state->moves && now_s - state->last_s >= WH_MOVES_REST_S) {
        keep_move(moves, axis);
        state->moves = false;
        state->has_rested = true;
    }
    if (!state->moves) {
        state->from = now;
        state->from_s = now_s;
    }
}

void wh_field_moves_take(wh_field_moves_t *moves, double time_s, const wh_real_t q[]) {
    const bool has_hole = moves->has_row && time_s - moves->before_s > moves->gap_s;
    for (size_t axis = 0; axis < moves->layout->machine.axis_count; ++axis) {
        wh_field_axis_t *state = &moves->axes[axis];
        const double now = number_of(moves->layout, axis, q[axis]);
        if (!moves->has_row) {
            *state = (wh_field_axis_t){.from = now, .from_s = time_s};
            moves->before[axis] = now;
        }
        state->is_odd = state->is_odd || (has_hole && state->moves);
        take_axis(moves, axis, time_s, moves->before[axis], now);
        moves->before[axis] = now;
    }
    if (moves->has_row && time_s - moves->before_s > moves->period_s && !has_hole) {
        moves->period_s = time_s - moves->before_s;
    }
    moves->before_s = time_s;
    moves->has_row = true;
}

const char *wh_field_moves_axis(const wh_layout_t *layout, size_t axis) {
    static const char *const names[] = {"theta", "r", "z", "yaw"};
    if (layout->robot_count > 1) {
        return NULL;
    }
    if (axis >= wh_machine_robot_axes(&layout->machine)) {
        return wh_layout_axis_turns(layout, axis) ? "chuck" : NULL;
    }
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        if (strcmp(names[i], wh_axis_name(&layout->machine, axis)) == 0) {
            return names[i];
        }
    }
    return NULL;
}

/* The time of a move by the layout's limits, s; NaN: there is none. */
static double planned_s(const wh_layout_t *layout, const wh_field_move_t *move) {
    wh_profile_t profile;
    const double way = fabs(move->to - move->from);
    const wh_limits_t *limits = wh_machine_limits(&layout->machine, move->axis);
    const bool turns = wh_layout_axis_turns(layout, move->axis);
    return wh_profile_plan(&profile, turns ? wh_rad_from_deg(way) : way, limits) == WH_OK
               ? wh_profile_duration(&profile)
               : (double)NAN;
}

size_t wh_field_moves_count(const wh_field_moves_t *moves, size_t axis, size_t *alike) {
    size_t all = 0;
    *alike = 0;
    for (size_t i = 0; i < moves->count; ++i) {
        const wh_field_move_t *move = &moves->moves[i];
        if (move->axis == axis) {
            const double off_s = fabs(move->seconds - planned_s(moves->layout, move));
            *alike += moves->period_s <= FINE_S && off_s <= ALIKE_S + moves->period_s ? 1 : 0;
            ++all;
        }
    }
    return all;
}

bool wh_field_moves_look_simulated(const wh_field_moves_t *moves, size_t axis) {
    size_t alike = 0;
    const size_t all = wh_field_moves_count(moves, axis, &alike);
    return alike >= WH_MOVES_ALIKE && 2 * alike >= all;
}

bool wh_field_moves_never_rests(const wh_field_moves_t *moves, size_t axis) {
    return moves->axes[axis].has_moved && !moves->axes[axis].has_rested;
}

void wh_field_moves_free(wh_field_moves_t *moves) {
    free(moves->moves);
    moves->moves = NULL;
}
