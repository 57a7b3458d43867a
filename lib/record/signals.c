#include "signals.h"

#include <stdlib.h>
#include <string.h>

#include "../layout/collision.h"
#include "../text/array.h"

/* Up to so many wafers are compared in each slice. More are compared only in slices with events. */
#define WATCHED_WAFERS 64

/* wh_signals_walk looks at no more than so many places from one point to the next. */
#define PLACES 32

/* This near to where its axes put it a gripper is there: another machine's sines may differ in their last
 * bits. */
#define SAME_MM 1e-9
#define SAME_ROTATION 1e-12

const char *const wh_signals_link_names[WH_SIGNALS_LINKS] = {"lift", "upper arm", "forearm", "hand"};

/* ------------------------------------------------------------------------------------------------ opening */

static bool turns(size_t axis) {
    return axis != WH_AXIS_R && axis != WH_AXIS_Z;
}

static void open_curve(wh_path_t *curve, double tolerance) {
    wh_path_open(curve, WH_SIGNALS_SHARE * tolerance, WH_SIGNALS_POINTS);
}

static void open_tracks(wh_signals_t *signals) {
    static const double measured[WH_MEASURES] = {WH_SIGNALS_PROJZ, WH_SIGNALS_PROJXY, WH_SIGNALS_PLANAR};
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        open_curve(&signals->vacuum[g], WH_SIGNALS_VACUUM);
        for (size_t m = 0; m < WH_MEASURES; ++m) {
            /* Half of the tolerance: points that are inserted later may take the other half. */
            open_curve(&signals->proximity[g][m], measured[m] / 2);
        }
        wh_thin_open(&signals->own[g], 3, WH_SIGNALS_SHARE * WH_SIGNALS_OWN_MM,
                     WH_SIGNALS_SHARE * WH_SIGNALS_OWN_RAD, WH_SIGNALS_POINTS);
    }
    for (size_t axis = 0; axis < WH_AXES; ++axis) {
        open_curve(&signals->axes[axis], turns(axis) ? WH_SIGNALS_RAD : WH_SIGNALS_MM);
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
    memcpy(axes, machine->robot.home, sizeof machine->robot.home);
    wh_machine_grippers(machine, axes, poses);
    wh_physics_state_start(&condition, &layout->physics);
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

/* True if the two poses differ by at most so much, in place and in each number of the rotation. */
static bool is_at(const wh_pose_t *a, const wh_pose_t *b, double mm, double rotation) {
    const wh_vec3_t way = wh_vec3_subtract(&a->r, &b->r);
    bool same = wh_real_abs(way.x) <= mm && wh_real_abs(way.y) <= mm && wh_real_abs(way.z) <= mm;
    for (size_t i = 0; same && i < 9; ++i) {
        same = wh_real_abs(a->R.m[i / 3][i % 3] - b->R.m[i / 3][i % 3]) <= rotation;
    }
    return same;
}

/* Adds the poses of grippers that are not where the axes put them; from then on all of them. */
static void add_grippers(wh_signals_t *signals, const double axes[], const wh_state_t *state) {
    wh_pose_t expected[WH_GRIPPERS];
    if (axes) {
        wh_machine_grippers(&signals->layout->machine, axes, expected);
    }
    for (size_t g = 0; g < state->gripper_count; ++g) {
        const wh_pose_t *pose = &state->grippers[g].base_from_gripper;
        if (signals->own[g].of > 0 || !axes || !is_at(pose, &expected[g], SAME_MM, SAME_ROTATION)) {
            wh_thin_add_pose(&signals->own[g], state->seq, pose);
        }
    }
}

static void add_axes(wh_signals_t *signals, const double axes[], size_t axis_count, const wh_state_t *state) {
    for (size_t axis = 0; axis < axis_count; ++axis) {
        wh_path_add(&signals->axes[axis], state->seq, axes[axis]);
    }
    signals->axis_count = axis_count > signals->axis_count ? axis_count : signals->axis_count;
}

/* -------------------------------------------------------------------------------------------------- steps */

void wh_signals_step(wh_steps_t *steps, int64_t slice, int32_t value) {
    if (steps->count > 0 && steps->steps[steps->count - 1].value == value) {
        return;
    }
    steps->steps = wh_array_grow(steps->steps, steps->count, &steps->capacity, sizeof *steps->steps);
    steps->steps[steps->count++] = (wh_step_t){slice, value};
}

static void add_signals(wh_signals_t *signals, const wh_state_t *state) {
    for (size_t g = 0; g < state->gripper_count; ++g) {
        wh_signals_step(&signals->valves[g], state->seq, state->physics->told[g]);
        wh_signals_step(&signals->sensors[g], state->seq, (int32_t)(state->sensors >> g & 1U));
        wh_path_add(&signals->vacuum[g], state->seq, state->physics->vacuum[g].level);
    }
}

/* ------------------------------------------------------------------------------------------------- wafers */

static void look_at_wafer(wh_signals_t *signals, const wh_state_t *state, int32_t w, int32_t holder,
                          const wh_pose_t *pose) {
    const wh_stay_t *stay = &signals->stays[signals->stay_of[w]];
    if (stay->holder != holder || !is_at(&stay->pose, pose, 0, 0)) {
        add_stay(signals, state->seq, w, holder, pose);
        for (size_t g = 0; g < state->gripper_count; ++g) {
            signals->vicinity[g].is_known = false;
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

/* ------------------------------------------------------------------------------------------------- events */

/* False for events of a normal run: tracks and tables show them. */
static bool is_marked(wh_event_kind_t kind) {
    static const uint32_t plain = 1U << WH_EVENT_PICKED | 1U << WH_EVENT_RELEASED |
                                  1U << WH_EVENT_HANDED_OVER | 1U << WH_EVENT_SETTLED |
                                  1U << WH_EVENT_BAD_INPUT;
    return (plain >> (unsigned)kind & 1U) == 0;
}

/* Where the event happened: at the contact, else at the wafer, else at the gripper. False if nowhere. */
static bool place_of(const wh_event_t *event, const wh_state_t *state, wh_vec3_t *at) {
    static const uint32_t contacts = 1U << WH_EVENT_HIT | 1U << WH_EVENT_UNDECIDED | 1U << WH_EVENT_TOO_CLOSE;
    if (contacts >> (unsigned)event->kind & 1U) {
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
        if (is_marked(event->kind)) {
            signals->marks = wh_array_grow(signals->marks, signals->mark_count, &signals->mark_capacity,
                                           sizeof *signals->marks);
            wh_mark_t *mark = &signals->marks[signals->mark_count++];
            *mark = (wh_mark_t){.event = *event, .utime = state->utime};
            mark->has_place = place_of(event, state, &mark->at);
        }
    }
}

/* ------------------------------------------------------------------------------------------------- slices */

typedef void each_curve_t(wh_path_t *curve);
typedef void each_own_t(wh_thin_t *own);

static void for_each(wh_signals_t *signals, each_curve_t *act, each_own_t *act_on_own) {
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
    wh_signals_proximity(signals, state);
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
    memset(signals, 0, sizeof *signals);
}

/* -------------------------------------------------------------------------------------------------- poses */

static void read_grippers(const wh_signals_t *signals, int64_t slice, wh_pose_t poses[WH_GRIPPERS]) {
    const wh_machine_t *machine = &signals->layout->machine;
    double axes[WH_AXES] = {0};
    for (size_t axis = 0; axis < WH_AXES && signals->axes[axis].list.count > 0; ++axis) {
        axes[axis] = wh_path_read(&signals->axes[axis], slice, NULL);
    }
    wh_machine_grippers(machine, axes, poses);
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        const wh_thin_t *own = &signals->own[g];
        if (own->list.count > 0 && slice >= own->list.points[0].slice) {
            wh_thin_read_pose(own, slice, &poses[g]);
        }
    }
}

void wh_signals_gripper(const wh_signals_t *signals, size_t gripper, int64_t slice,
                        wh_pose_t *base_from_gripper) {
    wh_pose_t poses[WH_GRIPPERS];
    read_grippers(signals, slice, poses);
    *base_from_gripper = poses[gripper];
}

bool wh_signals_links(const wh_signals_t *signals, int64_t slice,
                      wh_pose_t base_from_links[WH_SIGNALS_LINKS]) {
    wh_pose_t poses[WH_GRIPPERS];
    wh_pose_t base_from_effector;
    wh_pose_t bodies[WH_ARM_BODIES];
    read_grippers(signals, slice, poses);
    if (!wh_collision_effector(&signals->layout->machine, poses, &base_from_effector)) {
        return false;
    }
    wh_arm_place(&signals->layout->shapes.arm, &base_from_effector, bodies);
    for (size_t i = 0; i < WH_SIGNALS_LINKS; ++i) {
        base_from_links[i] = bodies[WH_ARM_LIFT + i];
    }
    return true;
}

/* --------------------------------------------------------------------------------------------------- walk */

/* How many points of each signal the walk has passed. */
typedef struct {
    size_t axes[WH_AXES], own[WH_GRIPPERS];
} passed_t;

/* The first slice after `slice` at which a signal has a point, or the last slice of all. */
static int64_t next_point(const wh_signals_t *signals, passed_t *passed, int64_t slice) {
    int64_t next = signals->last;
    for (size_t axis = 0; axis < signals->axis_count; ++axis) {
        next = wh_points_next(&signals->axes[axis].list, &passed->axes[axis], slice, next);
    }
    for (size_t g = 0; g < signals->layout->machine.gripper_count; ++g) {
        next = wh_points_next(&signals->own[g].list, &passed->own[g], slice, next);
    }
    return next;
}

void wh_signals_walk(const wh_signals_t *signals, void (*visit)(void *user, int64_t slice), void *user) {
    passed_t passed = {{0}, {0}};
    int64_t slice = signals->first;
    visit(user, slice);
    while (slice < signals->last) {
        const int64_t next = next_point(signals, &passed, slice);
        const int64_t width = next - slice;
        const int64_t places = width < PLACES ? width : PLACES;
        for (int64_t i = 1; i < places; ++i) {
            visit(user, slice + (int64_t)((double)width * (double)i / (double)places));
        }
        visit(user, next);
        slice = next;
    }
}
