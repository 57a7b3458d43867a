#include "slice_fields.h"

#include <math.h>
#include <stdio.h>

#include "../record/counterpart.h"
#include "../record/quaternion.h"
#include "../record/signals.h"

enum { OF_GRIPPER = 7, OF_WAFER = 8 };

static const struct {
    const char *name;
    wh_slice_field_t kind;
} of_gripper[OF_GRIPPER] = {{"valve", WH_FIELD_NUMBER},        {"sensor", WH_FIELD_NUMBER},
                            {"vacuum", WH_FIELD_NUMBER},       {"nearest", WH_FIELD_WAFER},
                            {"dr_proj_z mm", WH_FIELD_NUMBER}, {"dr_proj_xy mm", WH_FIELD_NUMBER},
                            {"n1_proj_n2", WH_FIELD_NUMBER}},
  of_wafer[OF_WAFER] = {{"holder", WH_FIELD_GRIPPER}, {"x mm", WH_FIELD_NUMBER}, {"y mm", WH_FIELD_NUMBER},
                        {"z mm", WH_FIELD_NUMBER},    {"qx", WH_FIELD_NUMBER},   {"qy", WH_FIELD_NUMBER},
                        {"qz", WH_FIELD_NUMBER},      {"qw", WH_FIELD_NUMBER}};

size_t wh_slice_field_count(const wh_layout_t *layout) {
    return layout->machine.axis_count + OF_GRIPPER * layout->machine.gripper_count +
           OF_WAFER * layout->wafer_count;
}

wh_slice_field_t wh_slice_field_name(const wh_layout_t *layout, size_t i, char name[WH_SLICE_FIELD_NAME]) {
    const size_t axes = layout->machine.axis_count;
    const size_t grippers = OF_GRIPPER * layout->machine.gripper_count;
    if (i < axes) {
        char axis[WH_NAME_SIZE + 8];
        wh_signals_name_axis(layout, i, axis, sizeof axis);
        (void)snprintf(name, WH_SLICE_FIELD_NAME, "axis %s %s", axis, wh_signals_turns(i) ? "rad" : "mm");
        return WH_FIELD_NUMBER;
    }
    if (i < axes + grippers) {
        const size_t part = (i - axes) % OF_GRIPPER;
        (void)snprintf(name, WH_SLICE_FIELD_NAME, "%s %s", layout->grippers[(i - axes) / OF_GRIPPER].name,
                       of_gripper[part].name);
        return of_gripper[part].kind;
    }
    const size_t at = i - axes - grippers;
    (void)snprintf(name, WH_SLICE_FIELD_NAME, "%s %s", layout->wafers[at / OF_WAFER].name,
                   of_wafer[at % OF_WAFER].name);
    return of_wafer[at % OF_WAFER].kind;
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

/* True where a report shows the gripper against this wafer. */
static bool is_near(const wh_proximity_t *measured, const wh_grasp_config_t *grasp) {
    return fabs(measured->dr_proj_z) < WH_SIGNALS_REACH && measured->dr_proj_xy_norm < 2 * grasp->near_projxy;
}

static void put_gripper(const wh_layout_t *layout, const wh_state_t *state, size_t g, double values[]) {
    const wh_tolerance_t *tolerance = &layout->grasp.tolerance;
    const int32_t nearest = wh_counterpart(state, g, tolerance, NULL, state->wafer_count);
    wh_proximity_t measured;
    const bool is_measured =
        nearest != WH_NONE &&
        wh_proximity_measure(&state->wafers[nearest].base_from_wafer, &state->grippers[g].base_from_gripper,
                             tolerance, &measured) == WH_OK &&
        is_near(&measured, &layout->grasp);
    values[0] = state->physics->told[g] == WH_VALVE_OPEN ? 0 : 1;
    values[1] = state->sensors >> g & 1U;
    values[2] = state->physics->vacuum[g].level;
    values[3] = is_measured ? nearest : WH_NONE;
    values[4] = is_measured ? fabs(measured.dr_proj_z) : (double)NAN;
    values[5] = is_measured ? measured.dr_proj_xy_norm : (double)NAN;
    values[6] = is_measured ? measured.n1_proj_n2 : (double)NAN;
}

static void put_wafer(const wh_wafer_t *wafer, double values[]) {
    const wh_pose_t *pose = &wafer->base_from_wafer;
    values[0] = wafer->holder;
    values[1] = pose->r.x;
    values[2] = pose->r.y;
    values[3] = pose->r.z;
    wh_quaternion_from_matrix(&pose->R, NULL, values + 4);
}

void wh_slice_fields(const wh_layout_t *layout, const double axes[], const wh_state_t *state,
                     double values[]) {
    for (size_t axis = 0; axis < layout->machine.axis_count; ++axis) {
        *values++ = axes ? axes[axis] : (double)NAN;
    }
    for (size_t g = 0; g < layout->machine.gripper_count; ++g, values += OF_GRIPPER) {
        put_gripper(layout, state, g, values);
    }
    for (size_t w = 0; w < layout->wafer_count; ++w, values += OF_WAFER) {
        put_wafer(&state->wafers[w], values);
    }
}
