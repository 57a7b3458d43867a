#include "slice_fields.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../layout/axes.h"
#include "../layout/grips.h"
#include "../math/trig.h"
#include "../record/counterpart.h"
#include "../record/quaternion.h"
#include "../record/signals.h"
#include "../text/array.h"

enum { OF_GRIPPER = 8, OF_WAFER = 13 };

/* The cells that have a column. */
typedef enum { IN_ALL, WITH_EDGES, WITH_FACES, WITH_GRIPS } told_t;

static const struct {
    const char *name;
    wh_slice_field_t kind;
    told_t told;
} of_gripper[OF_GRIPPER] = {{"valve", WH_FIELD_NUMBER, IN_ALL},
                            {"sensor", WH_FIELD_NUMBER, IN_ALL},
                            {"vacuum", WH_FIELD_NUMBER, IN_ALL},
                            {"nearest", WH_FIELD_WAFER, IN_ALL},
                            {"dr_proj_z mm", WH_FIELD_NUMBER, IN_ALL},
                            {"dr_proj_xy mm", WH_FIELD_NUMBER, IN_ALL},
                            {"n1_proj_n2", WH_FIELD_NUMBER, IN_ALL},
                            {"plunger mm", WH_FIELD_NUMBER, WITH_EDGES}},
  of_wafer[OF_WAFER] = {{"holder", WH_FIELD_GRIPPER, IN_ALL},
                        {"x mm", WH_FIELD_NUMBER, IN_ALL},
                        {"y mm", WH_FIELD_NUMBER, IN_ALL},
                        {"z mm", WH_FIELD_NUMBER, IN_ALL},
                        {"qx", WH_FIELD_NUMBER, IN_ALL},
                        {"qy", WH_FIELD_NUMBER, IN_ALL},
                        {"qz", WH_FIELD_NUMBER, IN_ALL},
                        {"qw", WH_FIELD_NUMBER, IN_ALL},
                        {"face down", WH_FIELD_NUMBER, WITH_FACES},
                        {"held dx mm", WH_FIELD_NUMBER, WITH_GRIPS},
                        {"held dy mm", WH_FIELD_NUMBER, WITH_GRIPS},
                        {"held turn deg", WH_FIELD_NUMBER, WITH_GRIPS},
                        {"held by front", WH_FIELD_NUMBER, WITH_FACES}};

static bool is_told(const wh_layout_t *layout, told_t told) {
    switch (told) {
    case WITH_EDGES:
        return wh_layout_has_edge(layout);
    case WITH_FACES:
        return layout->has_faces;
    case WITH_GRIPS:
        return wh_layout_has_grips(layout);
    case IN_ALL:
        break;
    }
    return true;
}

static size_t of_each_gripper(const wh_layout_t *layout) {
    return is_told(layout, WITH_EDGES) ? OF_GRIPPER : OF_GRIPPER - 1;
}

/* The columns of a wafer in this cell, in their order. */
static size_t of_each_wafer(const wh_layout_t *layout, size_t told[OF_WAFER]) {
    size_t count = 0;
    for (size_t i = 0; i < OF_WAFER; ++i) {
        told[count] = i;
        count += is_told(layout, of_wafer[i].told) ? 1 : 0;
    }
    return count;
}

static bool has_axis(const wh_layout_t *layout, size_t axis) {
    return axis >= wh_machine_robot_axes(&layout->machine) || wh_axis_exists(&layout->machine, axis);
}

/* Counts all axes except the yaw of an arm without a wrist. */
static size_t count_axes(const wh_layout_t *layout) {
    size_t count = 0;
    for (size_t axis = 0; axis < layout->machine.axis_count; ++axis) {
        count += has_axis(layout, axis) ? 1 : 0;
    }
    return count;
}

/* The machine's axis with number `i` among these. */
static size_t axis_of(const wh_layout_t *layout, size_t i) {
    size_t axis = 0;
    while (i > 0 || !has_axis(layout, axis)) {
        i -= has_axis(layout, axis) ? 1 : 0;
        ++axis;
    }
    return axis;
}

size_t wh_slice_field_count(const wh_layout_t *layout) {
    size_t told[OF_WAFER];
    return count_axes(layout) + of_each_gripper(layout) * layout->machine.gripper_count +
           of_each_wafer(layout, told) * layout->wafer_count;
}

wh_slice_field_t wh_slice_field_name(const wh_layout_t *layout, size_t i, char name[WH_SLICE_FIELD_NAME]) {
    const size_t axes = count_axes(layout);
    const size_t each = of_each_gripper(layout);
    const size_t grippers = each * layout->machine.gripper_count;
    if (i < axes) {
        char axis[WH_NAME_SIZE + 8];
        const char *unit = wh_layout_axis_unit(layout, axis_of(layout, i));
        wh_layout_name_axis(layout, axis_of(layout, i), axis, sizeof axis);
        (void)snprintf(name, WH_SLICE_FIELD_NAME, "%s%s%s%s", unit ? "axis " : "", axis, unit ? " " : "",
                       unit ? unit : "");
        return WH_FIELD_NUMBER;
    }
    if (i < axes + grippers) {
        const size_t part = (i - axes) % each;
        (void)snprintf(name, WH_SLICE_FIELD_NAME, "%s %s", layout->grippers[(i - axes) / each].name,
                       of_gripper[part].name);
        return of_gripper[part].kind;
    }
    const size_t at = i - axes - grippers;
    size_t told[OF_WAFER];
    const size_t fields = of_each_wafer(layout, told);
    const size_t part = told[at % fields];
    (void)snprintf(name, WH_SLICE_FIELD_NAME, "%s %s", layout->wafers[at / fields].name, of_wafer[part].name);
    return of_wafer[part].kind;
}

const char *wh_slice_field_word(const wh_layout_t *layout, wh_slice_field_t kind, double value) {
    const size_t count = kind == WH_FIELD_WAFER ? layout->wafer_count : layout->machine.gripper_count;
    if (kind == WH_FIELD_NUMBER) {
        return NULL;
    }
    if (!(value >= 0 && value < (double)count)) {
        return "";
    }
    return kind == WH_FIELD_WAFER ? layout->wafers[(size_t)value].name : layout->grippers[(size_t)value].name;
}

/* True if a report shows the gripper against this wafer. */
static bool is_near(const wh_proximity_t *measured, const wh_grasp_config_t *grasp) {
    return fabs(measured->dr_proj_z) < WH_SIGNALS_REACH && measured->dr_proj_xy_norm < 2 * grasp->near_projxy;
}

/* The nearest wafer: it changes with the place of the gripper and with wafers alone. */
static void put_nearest(const wh_layout_t *layout, const wh_state_t *state, size_t g, double values[]) {
    const int32_t nearest = wh_counterpart(state, g, &layout->cell, NULL, state->wafer_count);
    wh_proximity_t measured;
    const bool is_measured = nearest != WH_NONE &&
                             wh_layout_measure(layout, &state->wafers[nearest].base_from_wafer,
                                               &state->grippers[g].base_from_gripper, &measured) == WH_OK &&
                             is_near(&measured, &layout->grasp);
    values[3] = is_measured ? nearest : WH_NONE;
    values[4] = is_measured ? fabs(measured.dr_proj_z) : (double)NAN;
    values[5] = is_measured ? measured.dr_proj_xy_norm : (double)NAN;
    values[6] = is_measured ? measured.n1_proj_n2 : (double)NAN;
}

static void put_gripper(const wh_layout_t *layout, const wh_state_t *state, size_t g, bool is_as_before,
                        double values[]) {
    values[0] = state->physics->told[g] == WH_VALVE_OPEN ? 0 : 1;
    values[1] = state->sensors >> g & 1U;
    values[2] = state->physics->vacuum[g].level;
    if (!is_as_before) {
        put_nearest(layout, state, g, values);
    }
    if (is_told(layout, WITH_EDGES)) {
        values[7] = layout->grips[g].kind == WH_GRIP_EDGE ? state->physics->grips[g].s : (double)NAN;
    }
}

/* Writes the place of the face that looks at its gripper, from values[9] on. */
static void put_held(const wh_layout_t *layout, const wh_state_t *state, const wh_wafer_t *wafer,
                     double values[OF_WAFER]) {
    const bool is_held = wafer->holder != WH_NONE;
    wh_pose_t seen = wh_pose_identity();
    wh_face_t face = WH_FACE_BACK;
    if (is_held) {
        const wh_pose_t *gripper = &state->grippers[wafer->holder].base_from_gripper;
        wh_pose_t base_from_face;
        face = wh_layout_face_towards(layout, &wafer->base_from_wafer, gripper);
        wh_face_frame(&wafer->base_from_wafer, layout->cell.thickness, face, &base_from_face);
        seen = wh_pose_relative(gripper, &base_from_face);
    }
    values[9] = is_held ? seen.r.x : (double)NAN;
    values[10] = is_held ? seen.r.y : (double)NAN;
    values[11] = is_held ? wh_deg_from_rad(wh_atan2(seen.R.m[1][0], seen.R.m[0][0])) : (double)NAN;
    values[12] = !is_held ? (double)NAN : face == WH_FACE_FRONT ? 1 : 0;
}

static void put_wafer(const wh_layout_t *layout, const wh_state_t *state, const wh_wafer_t *wafer,
                      double values[OF_WAFER]) {
    const wh_pose_t *pose = &wafer->base_from_wafer;
    values[0] = wafer->holder;
    values[1] = pose->r.x;
    values[2] = pose->r.y;
    values[3] = pose->r.z;
    wh_quaternion_from_matrix(&pose->R, NULL, values + 4);
    values[8] = wh_layout_is_face_down(pose) ? 1 : 0;
    put_held(layout, state, wafer, values);
}

static bool lies_as_before(const wh_wafer_t *wafer, const wh_wafer_t *before) {
    return wafer->holder == WH_NONE && memcmp(wafer, before, sizeof *wafer) == 0;
}

static bool is_as_before(const wh_gripper_t *gripper, const wh_pose_t *before) {
    return memcmp(&gripper->base_from_gripper, before, sizeof *before) == 0;
}

static void put_wafers(const wh_layout_t *layout, const wh_state_t *state, const wh_slice_row_t *row,
                       double values[]) {
    size_t told[OF_WAFER];
    const size_t count = of_each_wafer(layout, told);
    for (size_t w = 0; w < layout->wafer_count; ++w, values += count) {
        double all[OF_WAFER];
        if (row && lies_as_before(&state->wafers[w], &row->wafers[w])) {
            continue;
        }
        put_wafer(layout, state, &state->wafers[w], all);
        for (size_t i = 0; i < count; ++i) {
            values[i] = all[told[i]];
        }
    }
}

/* `row`: of the values that are there; null: none are. */
static void put_fields(const wh_layout_t *layout, const double axes[], const wh_state_t *state,
                       const wh_slice_row_t *row, double values[]) {
    const bool are_wafers_same =
        row && memcmp(state->wafers, row->wafers, layout->wafer_count * sizeof *row->wafers) == 0;
    for (size_t axis = 0; axis < layout->machine.axis_count; ++axis) {
        if (has_axis(layout, axis)) {
            *values++ = axes ? axes[axis] : (double)NAN;
        }
    }
    for (size_t g = 0; g < layout->machine.gripper_count; ++g, values += of_each_gripper(layout)) {
        put_gripper(layout, state, g, are_wafers_same && is_as_before(&state->grippers[g], &row->grippers[g]),
                    values);
    }
    if (!row || !are_wafers_same || row->holds) {
        put_wafers(layout, state, row, values);
    }
}

static bool holds_any(const wh_state_t *state) {
    bool holds = false;
    for (size_t g = 0; g < state->gripper_count; ++g) {
        holds = holds || state->grippers[g].wafer != WH_NONE;
    }
    return holds;
}

void wh_slice_fields(const wh_layout_t *layout, const double axes[], const wh_state_t *state,
                     double values[]) {
    put_fields(layout, axes, state, NULL, values);
}

void wh_slice_row_take(wh_slice_row_t *row, const wh_layout_t *layout, const double axes[],
                       const wh_state_t *state) {
    const bool is_first = !row->values;
    if (is_first) {
        row->values = wh_array_new(wh_slice_field_count(layout), sizeof *row->values);
        row->wafers = wh_array_new(layout->wafer_count, sizeof *row->wafers);
    }
    put_fields(layout, axes, state, is_first ? NULL : row, row->values);
    memcpy(row->wafers, state->wafers, layout->wafer_count * sizeof *row->wafers);
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        row->grippers[g] = state->grippers[g].base_from_gripper;
    }
    row->holds = holds_any(state);
}

void wh_slice_row_free(wh_slice_row_t *row) {
    free(row->values);
    free(row->wafers);
    memset(row, 0, sizeof *row);
}
