#include "signals.h"

#include <stdlib.h>
#include <string.h>

#include "quaternion.h"
#include "record.h"

/* So many wafers are compared in each slice; more, only in slices with events. */
#define WATCHED_WAFERS 64

/* A gripper so near to where its axes put it is there. */
#define SAME_MM 1e-9
#define SAME_ROTATION 1e-12

/* -------------------------------------------------------------------------------------------------- opening */

static bool turns(size_t axis) {
    return axis != WH_AXIS_R && axis != WH_AXIS_Z;
}

static void open_curve(wh_curve_t *curve, double tolerance) {
    wh_curve_open(curve, WH_TRACE_SHARE * tolerance, WH_TRACE_POINTS);
}

static void open_tracks(wh_trace_t *trace) {
    static const double measured[WH_MEASURES] = {WH_TRACE_PROJZ, WH_TRACE_PROJXY, WH_TRACE_PLANAR};
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        open_curve(&trace->vacuum[g], WH_TRACE_VACUUM);
        for (size_t m = 0; m < WH_MEASURES; ++m) {
            /* Half, for points are inserted. */
            open_curve(&trace->proximity[g][m], measured[m] / 2);
        }
        wh_thin_open(&trace->own[g], 3, WH_TRACE_SHARE * WH_TRACE_OWN_MM, WH_TRACE_SHARE * WH_TRACE_OWN_RAD,
                     WH_TRACE_POINTS);
    }
    for (size_t axis = 0; axis < WH_AXES; ++axis) {
        open_curve(&trace->axes[axis], turns(axis) ? WH_TRACE_RAD : WH_TRACE_MM);
    }
}

static void add_stay(wh_trace_t *trace, int64_t slice, int32_t wafer, int32_t holder, const wh_pose_t *pose) {
    trace->stays =
        wh_record_grow(trace->stays, trace->stay_count, &trace->stay_capacity, sizeof *trace->stays);
    const wh_stay_t stay = {slice, wafer, holder, *pose};
    trace->stay_of[wafer] = (int32_t)trace->stay_count;
    trace->stays[trace->stay_count++] = stay;
}

/* As motion control finds it: at home, all valves closed. */
static void start_at_home(wh_trace_t *trace) {
    const wh_layout_t *layout = trace->layout;
    const wh_machine_t *machine = &layout->machine;
    wh_gripper_t grippers[WH_GRIPPERS];
    wh_condition_t condition;
    wh_pose_t poses[WH_GRIPPERS];
    double axes[WH_AXES] = {0};
    memcpy(axes, machine->robot.home, sizeof machine->robot.home);
    wh_machine_grippers(machine, axes, poses);
    wh_condition_start(&condition, &layout->physics);
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
                              .condition = &condition};
    wh_trace_slice(trace, axes, machine->axis_count, &state);
}

void wh_trace_begin(wh_trace_t *trace, const wh_layout_t *layout, bool at_home) {
    trace->layout = layout;
    trace->first = trace->last = -1;
    open_tracks(trace);
    trace->stay_of = calloc(layout->wafer_count + 1, sizeof *trace->stay_of);
    if (!trace->stay_of) {
        abort();
    }
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        add_stay(trace, 0, (int32_t)w, WH_NONE, &layout->start[w].base_from_wafer);
    }
    if (at_home) {
        start_at_home(trace);
    }
}

/* --------------------------------------------------------------------------------------------------- motion */

/* Another machine's sines may differ in their last bits. */
static bool is_at(const wh_pose_t *pose, const wh_pose_t *expected) {
    const wh_vec3_t way = wh_vec3_subtract(&pose->r, &expected->r);
    bool same = wh_vec3_norm(&way) <= SAME_MM;
    for (size_t i = 0; same && i < 9; ++i) {
        same = wh_real_abs(pose->R.m[i / 3][i % 3] - expected->R.m[i / 3][i % 3]) <= SAME_ROTATION;
    }
    return same;
}

static void add_own(wh_thin_t *own, int64_t slice, const wh_pose_t *pose) {
    double values[7] = {pose->r.x, pose->r.y, pose->r.z};
    const bool follows = own->of > 0;
    wh_quaternion_from_matrix(&pose->R, follows ? own->last.values + 3 : NULL, values + 3);
    wh_thin_add(own, slice, values);
}

/* What the axes do not say of the grippers. */
static void add_grippers(wh_trace_t *trace, const double axes[], const wh_state_t *state) {
    wh_pose_t expected[WH_GRIPPERS];
    if (axes) {
        wh_machine_grippers(&trace->layout->machine, axes, expected);
    }
    for (size_t g = 0; g < state->gripper_count; ++g) {
        const wh_pose_t *pose = &state->grippers[g].base_from_gripper;
        if (trace->own[g].of > 0 || !axes || !is_at(pose, &expected[g])) {
            add_own(&trace->own[g], state->seq, pose);
        }
    }
}

static void add_axes(wh_trace_t *trace, const double axes[], size_t axis_count, const wh_state_t *state) {
    for (size_t axis = 0; axis < axis_count; ++axis) {
        wh_curve_add(&trace->axes[axis], state->seq, axes[axis]);
    }
    trace->axis_count = axis_count > trace->axis_count ? axis_count : trace->axis_count;
}

/* ---------------------------------------------------------------------------------------------------- steps */

void wh_trace_step(wh_steps_t *steps, int64_t slice, int32_t value) {
    if (steps->count > 0 && steps->steps[steps->count - 1].value == value) {
        return;
    }
    steps->steps = wh_record_grow(steps->steps, steps->count, &steps->capacity, sizeof *steps->steps);
    steps->steps[steps->count].slice = slice;
    steps->steps[steps->count++].value = value;
}

static void add_signals(wh_trace_t *trace, const wh_state_t *state) {
    for (size_t g = 0; g < state->gripper_count; ++g) {
        wh_trace_step(&trace->valves[g], state->seq, state->condition->told[g]);
        wh_trace_step(&trace->sensors[g], state->seq, (int32_t)(state->sensors >> g & 1U));
        wh_curve_add(&trace->vacuum[g], state->seq, state->condition->vacuum[g].level);
    }
}

/* --------------------------------------------------------------------------------------------------- wafers */

static bool is_same(const wh_pose_t *a, const wh_pose_t *b) {
    const wh_vec3_t way = wh_vec3_subtract(&a->r, &b->r);
    bool same = !(wh_real_abs(way.x) > 0) && !(wh_real_abs(way.y) > 0) && !(wh_real_abs(way.z) > 0);
    for (size_t i = 0; same && i < 9; ++i) {
        same = !(wh_real_abs(a->R.m[i / 3][i % 3] - b->R.m[i / 3][i % 3]) > 0);
    }
    return same;
}

static void look_at_wafer(wh_trace_t *trace, const wh_state_t *state, int32_t w, int32_t holder,
                          const wh_pose_t *pose) {
    const wh_stay_t *stay = &trace->stays[trace->stay_of[w]];
    if (stay->holder != holder || !is_same(&stay->pose, pose)) {
        add_stay(trace, state->seq, w, holder, pose);
        for (size_t g = 0; g < state->gripper_count; ++g) {
            trace->vicinity[g].is_known = false;
        }
    }
}

static void add_wafers(wh_trace_t *trace, const wh_state_t *state) {
    for (size_t g = 0; g < state->gripper_count; ++g) {
        const wh_gripper_t *gripper = &state->grippers[g];
        if (gripper->wafer != WH_NONE) {
            look_at_wafer(trace, state, gripper->wafer, (int32_t)g, &gripper->gripper_from_wafer);
        }
    }
    const bool all = state->wafer_count <= WATCHED_WAFERS || state->event_count > 0 || trace->last < 0;
    for (size_t w = 0; all && w < state->wafer_count; ++w) {
        if (state->wafers[w].holder == WH_NONE) {
            look_at_wafer(trace, state, (int32_t)w, WH_NONE, &state->wafers[w].base_from_wafer);
        }
    }
}

/* --------------------------------------------------------------------------------------------------- events */

/* What went as it should is told by other means. */
static bool is_marked(wh_event_kind_t kind) {
    static const uint32_t plain = 1U << WH_EVENT_PICKED | 1U << WH_EVENT_RELEASED |
                                  1U << WH_EVENT_HANDED_OVER | 1U << WH_EVENT_SETTLED |
                                  1U << WH_EVENT_BAD_INPUT;
    return (plain >> (unsigned)kind & 1U) == 0;
}

/* Where it happened: contact, wafer or gripper. */
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

static void add_marks(wh_trace_t *trace, const wh_state_t *state) {
    for (size_t i = 0; i < state->event_count; ++i) {
        const wh_event_t *event = &state->events[i];
        if (is_marked(event->kind)) {
            trace->marks =
                wh_record_grow(trace->marks, trace->mark_count, &trace->mark_capacity, sizeof *trace->marks);
            wh_mark_t *mark = &trace->marks[trace->mark_count++];
            memset(mark, 0, sizeof *mark);
            mark->event = *event;
            mark->utime = state->utime;
            mark->has_place = place_of(event, state, &mark->at);
        }
    }
}

/* --------------------------------------------------------------------------------------------------- slices */

typedef void each_curve_t(wh_curve_t *curve);
typedef void each_own_t(wh_thin_t *own);

static void for_each(wh_trace_t *trace, each_curve_t *act, each_own_t *act_on_own) {
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        act(&trace->vacuum[g]);
        for (size_t m = 0; m < WH_MEASURES; ++m) {
            act(&trace->proximity[g][m]);
        }
        act_on_own(&trace->own[g]);
    }
    for (size_t axis = 0; axis < WH_AXES; ++axis) {
        act(&trace->axes[axis]);
    }
}

void wh_trace_slice(wh_trace_t *trace, const double axes[], size_t axis_count, const wh_state_t *state) {
    if (!trace->layout || state->seq <= trace->last) {
        return;
    }
    trace->first = trace->first < 0 ? state->seq : trace->first;
    const bool is_whole = axes && axis_count >= trace->layout->machine.axis_count;
    add_grippers(trace, is_whole ? axes : NULL, state);
    if (axes) {
        add_axes(trace, axes, axis_count, state);
    }
    add_signals(trace, state);
    add_wafers(trace, state);
    wh_trace_proximity(trace, state);
    if (state->event_count > 0) {
        add_marks(trace, state);
        wh_trace_mark(trace);
    }
    trace->last = state->seq;
}

void wh_trace_mark(wh_trace_t *trace) {
    for_each(trace, wh_curve_force, wh_thin_force);
}

void wh_trace_finish(wh_trace_t *trace) {
    for_each(trace, wh_curve_finish, wh_thin_finish);
}

void wh_trace_close(wh_trace_t *trace) {
    for_each(trace, wh_curve_close, wh_thin_close);
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        free(trace->valves[g].steps);
        free(trace->sensors[g].steps);
        free(trace->nearest[g].steps);
        free(trace->vicinity[g].wafers);
    }
    free(trace->stays);
    free(trace->stay_of);
    free(trace->marks);
    memset(trace, 0, sizeof *trace);
}
