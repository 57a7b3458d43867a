/* Each gripper against its nearest wafer, over time: the paper's Fig. 9. */
#include "../text/array.h"
#include "counterpart.h"
#include "signals.h"

/* With more wafers than this, those near a gripper are on a list, made anew when it has gone so far, mm. */
#define FEW_WAFERS 64
#define ROOM 100.0

static double square_of(const wh_vec3_t *a, const wh_vec3_t *b) {
    const wh_vec3_t way = wh_vec3_subtract(a, b);
    return wh_vec3_dot(&way, &way);
}

/* Within the plot's range a wafer's centre is at most this far from the gripper's, mm. */
static double reach_of(const wh_signals_t *signals) {
    return WH_SIGNALS_REACH + 2 * signals->layout->grasp.near_projxy;
}

/* ----------------------------------------------------------------------------------------------- vicinity */

static void add(wh_neighbours_t *vicinity, int32_t wafer) {
    vicinity->wafers =
        wh_array_grow(vicinity->wafers, vicinity->count, &vicinity->capacity, sizeof *vicinity->wafers);
    vicinity->wafers[vicinity->count++] = wafer;
}

static void look_around(const wh_signals_t *signals, wh_neighbours_t *vicinity, const wh_state_t *state,
                        const wh_vec3_t *at) {
    const double radius = reach_of(signals) + ROOM;
    const bool few = state->wafer_count <= FEW_WAFERS;
    vicinity->count = 0;
    for (size_t w = 0; w < state->wafer_count; ++w) {
        if (few || square_of(&state->wafers[w].base_from_wafer.r, at) < radius * radius) {
            add(vicinity, (int32_t)w);
        }
    }
    vicinity->centre = *at;
    vicinity->is_known = true;
}

/* The wafer that the gripper is measured against: see counterpart.h. Wafers that other grippers carry may
 * come near without being on the list. */
static int32_t find(wh_neighbours_t *vicinity, const wh_state_t *state, size_t g,
                    const wh_tolerance_t *tolerance) {
    const size_t listed = vicinity->count;
    for (size_t other = 0; other < state->gripper_count; ++other) {
        if (state->grippers[other].wafer != WH_NONE) {
            add(vicinity, state->grippers[other].wafer);
        }
    }
    const int32_t found = wh_counterpart(state, g, tolerance, vicinity->wafers, vicinity->count);
    vicinity->count = listed;
    return found;
}

/* ------------------------------------------------------------------------------------------------- values */

static void take(const wh_proximity_t *p, double values[WH_MEASURES]) {
    values[WH_MEASURE_PROJZ] = wh_real_abs(p->dr_proj_z);
    values[WH_MEASURE_PROJXY] = p->dr_proj_xy_norm;
    values[WH_MEASURE_PLANAR] = p->n1_proj_n2;
}

/* The nearest wafer, its values in `values`; WH_NONE if none is near. */
static int32_t measure(wh_signals_t *signals, const wh_state_t *state, size_t g, double values[WH_MEASURES]) {
    const wh_pose_t *pose = &state->grippers[g].base_from_gripper;
    wh_neighbours_t *vicinity = &signals->vicinity[g];
    wh_proximity_t p;
    if (!vicinity->is_known || square_of(&pose->r, &vicinity->centre) > ROOM * ROOM) {
        look_around(signals, vicinity, state, &pose->r);
    }
    const int32_t nearest = find(vicinity, state, g, &signals->layout->grasp.tolerance);
    if (nearest == WH_NONE || wh_proximity_measure(&state->wafers[nearest].base_from_wafer, pose,
                                                   &signals->layout->grasp.tolerance, &p) != WH_OK) {
        return WH_NONE;
    }
    take(&p, values);
    const bool near = values[WH_MEASURE_PROJZ] < WH_SIGNALS_REACH &&
                      values[WH_MEASURE_PROJXY] < 2 * signals->layout->grasp.near_projxy;
    return near ? nearest : WH_NONE;
}

static void add_gripper(wh_signals_t *signals, const wh_state_t *state, size_t g) {
    wh_steps_t *steps = &signals->nearest[g];
    double values[WH_MEASURES] = {0};
    const int32_t nearest = measure(signals, state, g, values);
    const bool is_other = steps->count > 0 && steps->steps[steps->count - 1].value != nearest;
    wh_signals_step(steps, state->seq, nearest);
    for (size_t m = 0; m < WH_MEASURES; ++m) {
        if (is_other) {
            wh_path_break(&signals->proximity[g][m]);
        }
        if (nearest != WH_NONE) {
            wh_path_add(&signals->proximity[g][m], state->seq, values[m]);
        }
    }
}

/* The wafer that the gripper was measured against at a slice. */
static int32_t nearest_at(const wh_steps_t *steps, int64_t slice) {
    size_t i = steps->count;
    while (i > 0 && steps->steps[i - 1].slice > slice) {
        --i;
    }
    return i > 0 ? steps->steps[i - 1].value : WH_NONE;
}

static void insert_past(wh_signals_t *signals, const wh_event_t *event) {
    const int64_t slice = (int64_t)event->measured_slice;
    double values[WH_MEASURES];
    take(&event->measured, values);
    if (nearest_at(&signals->nearest[event->gripper], slice) == event->wafer) {
        for (size_t m = 0; m < WH_MEASURES; ++m) {
            wh_path_insert(&signals->proximity[event->gripper][m], slice, values[m]);
        }
    }
}

void wh_signals_proximity(wh_signals_t *signals, const wh_state_t *state) {
    for (size_t g = 0; g < state->gripper_count; ++g) {
        add_gripper(signals, state, g);
    }
    for (size_t i = 0; i < state->event_count; ++i) {
        const wh_event_t *event = &state->events[i];
        const bool past = event->kind == WH_EVENT_NEAR_MISS || event->kind == WH_EVENT_CONTESTED;
        if (past && (int64_t)event->measured_slice < state->seq) {
            insert_past(signals, event);
        }
    }
}
