#include "signals.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../layout/axes.h"
#include "../layout/grips.h"
#include "../text/array.h"
#include "counterpart.h"
#include "record.h"

/* Up to this number of wafers are compared in each slice. More wafers are compared only in slices with
 * events. */
#define WATCHED_WAFERS 64

/* With more wafers than this, a list has those near a gripper. It is made again when the gripper has moved
 * this far, mm. */
#define FEW_WAFERS 64
#define ROOM 100.0

/* A gripper this near to the place given by its axes is there: another machine's sines may differ in their
 * last bits. */
#define SAME_MM 1e-9
#define SAME_ROTATION 1e-12

/* ------------------------------------------------------------------------------------------------ opening */

double wh_signals_seconds(const wh_signals_t *signals, int64_t slice) {
    return (double)(slice * signals->layout->slice_us) / 1e6;
}

static void open_curve(wh_path_t *curve, double tolerance) {
    wh_path_open(curve, WH_SIGNALS_SHARE * tolerance, WH_SIGNALS_POINTS);
}

/* An error of theta moves a shifted gripper about the base, an error of yaw moves it about the wrist. */
double wh_signals_lever(const wh_layout_t *layout) {
    double shift = 0;
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        const wh_mount_t *mount = &layout->machine.mounts[g];
        shift = fmax(mount->is_shifted ? wh_vec3_norm(&mount->effector_from_gripper.r) : 0, shift);
    }
    double reach = 0;
    for (size_t robot = 0; robot < wh_machine_robots(&layout->machine); ++robot) {
        reach = fmax(wh_axis_reach(&layout->machine, robot).max, reach);
    }
    return reach + 2 * shift;
}

static void open_tracks(wh_signals_t *signals) {
    const double rad =
        WH_SIGNALS_RAD * fmin(WH_SIGNALS_LEVER / fmax(wh_signals_lever(signals->layout), 1), 1);
    static const double measured[WH_MEASURES] = {WH_SIGNALS_PROJZ, WH_SIGNALS_PROJXY, WH_SIGNALS_PLANAR};
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        open_curve(&signals->vacuum[g], WH_SIGNALS_VACUUM);
        for (size_t m = 0; m < WH_MEASURES; ++m) {
            /* Half of the tolerance: points that are inserted later may use the other half. */
            open_curve(&signals->proximity[g][m], measured[m] / 2);
        }
        wh_thin_open(&signals->own[g], 3, WH_SIGNALS_SHARE * WH_SIGNALS_OWN_MM,
                     WH_SIGNALS_SHARE * WH_SIGNALS_OWN_RAD, WH_SIGNALS_POINTS);
    }
    for (size_t axis = 0; axis < WH_AXES; ++axis) {
        open_curve(&signals->axes[axis], wh_layout_axis_turns(signals->layout, axis) ? rad : WH_SIGNALS_MM);
    }
}

static void add_stay(wh_signals_t *signals, int64_t slice, int32_t wafer, int32_t holder,
                     const wh_pose_t *pose) {
    signals->stays =
        wh_array_grow(signals->stays, signals->stay_count, &signals->stay_capacity, sizeof *signals->stays);
    signals->stay_of[wafer] = (int32_t)signals->stay_count;
    signals->stays[signals->stay_count++] = (wh_stay_t){slice, wafer, holder, *pose};
}

/* The first sample is the state before the run, as motion control finds it: at home, all valves closed. */
static void start_at_home(wh_signals_t *signals) {
    const wh_layout_t *layout = signals->layout;
    const wh_machine_t *machine = &layout->machine;
    wh_gripper_t grippers[WH_GRIPPERS];
    wh_physics_state_t condition;
    wh_pose_t poses[WH_GRIPPERS];
    double axes[WH_AXES] = {0};
    wh_machine_home(machine, axes);
    wh_machine_grippers(machine, axes, poses);
    wh_physics_state_start(&condition, &layout->physics);
    const wh_door_set_t doors = wh_door_set(machine);
    wh_doors_start(&doors, &condition.doors);
    memset(grippers, 0, sizeof grippers);
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        grippers[g].base_from_gripper = poses[g];
        grippers[g].wafer = WH_NONE;
        condition.told[g] = WH_VALVE_CLOSED;
    }
    const wh_state_t state = {.wafers = layout->start,
                              .wafer_count = layout->wafer_count,
                              .grippers = grippers,
                              .gripper_count = machine->gripper_count,
                              .physics = &condition};
    wh_signals_slice(signals, axes, machine->axis_count, &state);
}

void wh_signals_begin(wh_signals_t *signals, const wh_layout_t *layout, bool at_home) {
    signals->layout = layout;
    signals->first = signals->last = -1;
    open_tracks(signals);
    signals->stay_of = wh_array_new(layout->wafer_count, sizeof *signals->stay_of);
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        add_stay(signals, 0, (int32_t)w, WH_NONE, &layout->start[w].base_from_wafer);
    }
    if (at_home) {
        start_at_home(signals);
    }
}

/* ------------------------------------------------------------------------------------------------- motion */

/* True if the two poses differ by at most `mm` in place and `rotation` in each number of the rotation. */
static bool is_at(const wh_pose_t *a, const wh_pose_t *b, double mm, double rotation) {
    const wh_vec3_t way = wh_vec3_subtract(&a->r, &b->r);
    bool same = wh_real_abs(way.x) <= mm && wh_real_abs(way.y) <= mm && wh_real_abs(way.z) <= mm;
    for (size_t i = 0; same && i < 9; ++i) {
        same = wh_real_abs(a->R.m[i / 3][i % 3] - b->R.m[i / 3][i % 3]) <= rotation;
    }
    return same;
}

static bool is_carried(const wh_signals_t *signals, size_t gripper) {
    const wh_machine_t *machine = &signals->layout->machine;
    const wh_mount_t *mount = &machine->mounts[gripper];
    return mount->axis == WH_NONE ? machine->carrier != NULL : mount->kind != WH_MOUNT_CHUCK;
}

/* Adds the poses of a gripper that is not where the axes put it, and from then on all its poses. A robot
 * with a carrier, pins, flippers and chucks on a stage always have poses, because a page computes only
 * usual robots and chucks. */
static void add_grippers(wh_signals_t *signals, const double axes[], const wh_state_t *state) {
    wh_pose_t expected[WH_GRIPPERS];
    bool is_expected = false;
    for (size_t g = 0; g < state->gripper_count; ++g) {
        const wh_pose_t *pose = &state->grippers[g].base_from_gripper;
        const bool has_poses = signals->own[g].of > 0 || !axes || is_carried(signals, g);
        if (!has_poses && !is_expected) {
            wh_machine_grippers(&signals->layout->machine, axes, expected);
            is_expected = true;
        }
        if (has_poses || !is_at(pose, &expected[g], SAME_MM, SAME_ROTATION)) {
            wh_thin_add_pose(&signals->own[g], state->seq, pose);
        }
    }
}

static void add_axes(wh_signals_t *signals, const double axes[], size_t axis_count, const wh_state_t *state) {
    const wh_machine_t *machine = &signals->layout->machine;
    const size_t first_door = wh_machine_door_axis(machine, 0);
    const size_t doors = state->physics ? (size_t)state->physics->doors.count : 0;
    for (size_t axis = 0; axis < axis_count; ++axis) {
        const bool is_door = axis >= first_door && axis - first_door < doors;
        wh_path_add(&signals->axes[axis], state->seq,
                    is_door ? state->physics->doors.at[axis - first_door] : axes[axis]);
    }
    signals->axis_count = axis_count > signals->axis_count ? axis_count : signals->axis_count;
}

/* -------------------------------------------------------------------------------------------------- steps */

static void step(wh_steps_t *steps, int64_t slice, int32_t value) {
    if (steps->count > 0 && steps->steps[steps->count - 1].value == value) {
        return;
    }
    steps->steps = wh_array_grow(steps->steps, steps->count, &steps->capacity, sizeof *steps->steps);
    steps->steps[steps->count++] = (wh_step_t){slice, value};
}

static void add_signals(wh_signals_t *signals, const wh_state_t *state) {
    for (size_t g = 0; g < state->gripper_count; ++g) {
        step(&signals->valves[g], state->seq, state->physics->told[g]);
        step(&signals->sensors[g], state->seq, (int32_t)(state->sensors >> g & 1U));
        wh_path_add(&signals->vacuum[g], state->seq, state->physics->vacuum[g].level);
    }
}

/* ------------------------------------------------------------------------------------------------- wafers */

static void look_at_wafer(wh_signals_t *signals, const wh_state_t *state, int32_t w, int32_t holder,
                          const wh_pose_t *pose) {
    const wh_stay_t *stay = &signals->stays[signals->stay_of[w]];
    /* Most wafers rest with all their bits; a comparison of these is the quickest. */
    const bool stays =
        stay->holder == holder && (wh_thin_is_same_pose(&stay->pose, pose) || is_at(&stay->pose, pose, 0, 0));
    if (!stays) {
        add_stay(signals, state->seq, w, holder, pose);
        for (size_t g = 0; g < state->gripper_count; ++g) {
            signals->vicinity[g].is_known = false;
            signals->measured[g].is_known = false;
        }
    }
}

static void add_wafers(wh_signals_t *signals, const wh_state_t *state) {
    for (size_t g = 0; g < state->gripper_count; ++g) {
        const wh_gripper_t *gripper = &state->grippers[g];
        if (gripper->wafer != WH_NONE) {
            look_at_wafer(signals, state, gripper->wafer, (int32_t)g, &gripper->gripper_from_wafer);
        }
    }
    const bool all = state->wafer_count <= WATCHED_WAFERS || state->event_count > 0 || signals->last < 0;
    for (size_t w = 0; all && w < state->wafer_count; ++w) {
        if (state->wafers[w].holder == WH_NONE) {
            look_at_wafer(signals, state, (int32_t)w, WH_NONE, &state->wafers[w].base_from_wafer);
        }
    }
}

/* ---------------------------------------------------------------------------------------------- proximity */

/* Each gripper against its nearest wafer, over time: the paper's Fig. 9. */
static double square_of(const wh_vec3_t *a, const wh_vec3_t *b) {
    const wh_vec3_t way = wh_vec3_subtract(a, b);
    return wh_vec3_dot(&way, &way);
}

static void add_neighbour(wh_neighbours_t *vicinity, int32_t wafer) {
    vicinity->wafers =
        wh_array_grow(vicinity->wafers, vicinity->count, &vicinity->capacity, sizeof *vicinity->wafers);
    vicinity->wafers[vicinity->count++] = wafer;
}

static void look_around(const wh_signals_t *signals, wh_neighbours_t *vicinity, const wh_state_t *state,
                        const wh_vec3_t *at) {
    /* Within the plot's range a wafer's centre is at most this far from the gripper's. */
    const double reach = WH_SIGNALS_REACH + 2 * signals->layout->grasp.near_projxy;
    const double radius = reach + ROOM;
    const bool few = state->wafer_count <= FEW_WAFERS;
    vicinity->count = 0;
    for (size_t w = 0; w < state->wafer_count; ++w) {
        if (few || square_of(&state->wafers[w].base_from_wafer.r, at) < radius * radius) {
            add_neighbour(vicinity, (int32_t)w);
        }
    }
    vicinity->centre = *at;
    vicinity->is_known = true;
}

/* The wafer that the gripper is measured against: see counterpart.h. Wafers that other grippers carry may
 * come near although they are not on the list. */
static int32_t find_nearest(wh_neighbours_t *vicinity, const wh_state_t *state, size_t g,
                            const wh_cell_t *cell) {
    const size_t listed = vicinity->count;
    for (size_t other = 0; other < state->gripper_count; ++other) {
        if (state->grippers[other].wafer != WH_NONE) {
            add_neighbour(vicinity, state->grippers[other].wafer);
        }
    }
    const int32_t found = wh_counterpart(state, g, cell, vicinity->wafers, vicinity->count);
    vicinity->count = listed;
    return found;
}

static void take_values(const wh_proximity_t *p, double values[WH_MEASURES]) {
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
    const int32_t nearest = find_nearest(vicinity, state, g, &signals->layout->cell);
    if (nearest == WH_NONE ||
        wh_layout_measure(signals->layout, &state->wafers[nearest].base_from_wafer, pose, &p) != WH_OK) {
        return WH_NONE;
    }
    take_values(&p, values);
    const bool near = values[WH_MEASURE_PROJZ] < WH_SIGNALS_REACH &&
                      values[WH_MEASURE_PROJXY] < 2 * signals->layout->grasp.near_projxy;
    return near ? nearest : WH_NONE;
}

/* Measures a gripper, or takes what it was measured to. */
static const wh_measured_t *look_at_gripper(wh_signals_t *signals, const wh_state_t *state, size_t g) {
    wh_measured_t *measured = &signals->measured[g];
    if (!measured->is_known) {
        measured->pose = state->grippers[g].base_from_gripper;
        measured->nearest = measure(signals, state, g, measured->values);
        measured->is_known = true;
    }
    return measured;
}

/* True if it carries a wafer that is elsewhere than before. */
static bool has_carried(wh_measured_t *measured, const wh_state_t *state, size_t g) {
    const int32_t wafer = state->grippers[g].wafer;
    if (wafer == WH_NONE || wh_thin_is_same_pose(&measured->carried, &state->wafers[wafer].base_from_wafer)) {
        return false;
    }
    measured->carried = state->wafers[wafer].base_from_wafer;
    return true;
}

/* Forgets what was measured to grippers that have moved, and to all if a wafer was carried. */
static void forget_moved(wh_signals_t *signals, const wh_state_t *state) {
    bool carried = false;
    for (size_t g = 0; g < state->gripper_count; ++g) {
        wh_measured_t *measured = &signals->measured[g];
        carried = has_carried(measured, state, g) || carried;
        measured->is_known = measured->is_known &&
                             wh_thin_is_same_pose(&measured->pose, &state->grippers[g].base_from_gripper);
    }
    for (size_t g = 0; carried && g < state->gripper_count; ++g) {
        signals->measured[g].is_known = false;
    }
}

static void add_gripper(wh_signals_t *signals, const wh_state_t *state, size_t g) {
    wh_steps_t *steps = &signals->nearest[g];
    const wh_measured_t *measured = look_at_gripper(signals, state, g);
    const int32_t nearest = measured->nearest;
    const bool is_other = steps->count > 0 && steps->steps[steps->count - 1].value != nearest;
    step(steps, state->seq, nearest);
    for (size_t m = 0; m < WH_MEASURES; ++m) {
        if (is_other) {
            wh_path_break(&signals->proximity[g][m]);
        }
        if (nearest != WH_NONE) {
            wh_path_add(&signals->proximity[g][m], state->seq, measured->values[m]);
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
    take_values(&event->measured, values);
    if (nearest_at(&signals->nearest[event->gripper], slice) == event->wafer) {
        for (size_t m = 0; m < WH_MEASURES; ++m) {
            wh_path_insert(&signals->proximity[event->gripper][m], slice, values[m]);
        }
    }
}

static void add_proximity(wh_signals_t *signals, const wh_state_t *state) {
    forget_moved(signals, state);
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

/* ------------------------------------------------------------------------------------------------- events */

/* False for events of a normal run: tracks and tables show them. */
static bool is_marked(const wh_event_t *event) {
    static const uint32_t plain = 1U << WH_EVENT_PICKED | 1U << WH_EVENT_RELEASED |
                                  1U << WH_EVENT_HANDED_OVER | 1U << WH_EVENT_SETTLED |
                                  1U << WH_EVENT_BAD_INPUT;
    return (plain >> (unsigned)event->kind & 1U) == 0 && !wh_record_is_carried(event);
}

/* The place of the event: the contact, otherwise the wafer, otherwise the gripper. Returns false if there
 * is none. */
static bool place_of(const wh_event_t *event, const wh_state_t *state, wh_vec3_t *at) {
    if (wh_record_is_contact(event->kind)) {
        *at = event->at;
        return true;
    }
    if (event->wafer >= 0 && (size_t)event->wafer < state->wafer_count) {
        *at = state->wafers[event->wafer].base_from_wafer.r;
        return true;
    }
    if (event->gripper >= 0 && (size_t)event->gripper < state->gripper_count) {
        *at = state->grippers[event->gripper].base_from_gripper.r;
        return true;
    }
    return false;
}

static void add_marks(wh_signals_t *signals, const wh_state_t *state) {
    for (size_t i = 0; i < state->event_count; ++i) {
        const wh_event_t *event = &state->events[i];
        if (is_marked(event)) {
            signals->marks = wh_array_grow(signals->marks, signals->mark_count, &signals->mark_capacity,
                                           sizeof *signals->marks);
            wh_mark_t *mark = &signals->marks[signals->mark_count++];
            *mark = (wh_mark_t){.event = *event, .utime = state->utime};
            mark->has_place = place_of(event, state, &mark->at);
        }
    }
}

/* ------------------------------------------------------------------------------------------------- slices */

static void for_each(wh_signals_t *signals, void (*act)(wh_path_t *), void (*act_on_own)(wh_thin_t *)) {
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        act(&signals->vacuum[g]);
        for (size_t m = 0; m < WH_MEASURES; ++m) {
            act(&signals->proximity[g][m]);
        }
        act_on_own(&signals->own[g]);
    }
    for (size_t axis = 0; axis < WH_AXES; ++axis) {
        act(&signals->axes[axis]);
    }
}

void wh_signals_slice(wh_signals_t *signals, const double axes[], size_t axis_count,
                      const wh_state_t *state) {
    if (!signals->layout || state->seq <= signals->last) {
        return;
    }
    signals->first = signals->first < 0 ? state->seq : signals->first;
    const bool is_whole = axes && axis_count >= signals->layout->machine.axis_count;
    add_grippers(signals, is_whole ? axes : NULL, state);
    if (axes) {
        add_axes(signals, axes, axis_count, state);
    }
    add_signals(signals, state);
    add_wafers(signals, state);
    add_proximity(signals, state);
    if (state->physics) {
        wh_edge_scans_hear(&signals->scans, state->seq, &state->physics->scan);
    }
    if (state->event_count > 0) {
        add_marks(signals, state);
        wh_signals_mark(signals);
    }
    signals->last = state->seq;
}

void wh_signals_mark(wh_signals_t *signals) {
    for_each(signals, wh_path_force, wh_thin_force);
}

void wh_signals_finish(wh_signals_t *signals) {
    for_each(signals, wh_path_finish, wh_thin_finish);
}

void wh_signals_close(wh_signals_t *signals) {
    for_each(signals, wh_path_close, wh_thin_close);
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        free(signals->valves[g].steps);
        free(signals->sensors[g].steps);
        free(signals->nearest[g].steps);
        free(signals->vicinity[g].wafers);
    }
    free(signals->stays);
    free(signals->stay_of);
    free(signals->marks);
    wh_edge_scans_close(&signals->scans);
    memset(signals, 0, sizeof *signals);
}
