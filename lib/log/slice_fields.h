/* A slice as a row of named numbers: the columns of a table of slices, and the values by which two recordings
 * are compared.
 *
 * The order is: each axis ("axis theta rad", or "axis 1" if only a message tells of the cell). Then for each
 * gripper: its valve (0: open), its sensor (1: on), its vacuum (0 to 1), the wafer that it is measured
 * against (record/counterpart.h) and, as absolute values, the distances and the angle between the two (mm,
 * mm, cosine); in a cell with edge grips its plunger (s, mm). Then for each wafer: its gripper, its place
 * (mm, in base) and its rotation (a unit quaternion); in a cell with faces 1 if it is face down. With faces,
 * edge grips or passive pads follows the place of the face that looks at the gripper, in the gripper's frame:
 * dx and dy (mm) and the turn of its x (deg); in a cell with faces 1 if that is its front.
 *
 * Unknown or missing values are NaN: axes that a log does not tell, a gripper's distances if no wafer is
 * near, the plunger of a gripper without one, and the place in a gripper of a wafer that is not held.
 */
#ifndef WH_LOG_SLICE_FIELDS_H
#define WH_LOG_SLICE_FIELDS_H

#include "../layout/layout.h"
#include "../sim/slice.h"

#define WH_SLICE_FIELD_NAME 96

typedef enum {
    WH_FIELD_NUMBER,
    WH_FIELD_WAFER,  /* the index of a wafer, or WH_NONE */
    WH_FIELD_GRIPPER /* of a gripper, or WH_NONE */
} wh_slice_field_t;

size_t wh_slice_field_count(const wh_layout_t *layout);

/* The i-th field's name, such as "Wafer 1 x mm", and its kind. */
wh_slice_field_t wh_slice_field_name(const wh_layout_t *layout, size_t i, char name[WH_SLICE_FIELD_NAME]);

/* The name for an index; "" for WH_NONE; null for a number. */
const char *wh_slice_field_word(const wh_layout_t *layout, wh_slice_field_t kind, double value);

/* Writes all of them. For `axes` see wh_log_run_listener_t. Cost: linear in the wafers, times the
 * grippers. */
void wh_slice_fields(const wh_layout_t *layout, const double axes[], const wh_state_t *state,
                     double values[]);

/* Likewise for one slice after the other of a run: a wafer that lies as before keeps its values, and so
 * does a gripper that stands as before while all wafers do. Zero it to begin with; read `values`, of
 * wh_slice_field_count, after wh_slice_row_take; free it at the end. */
typedef struct {
    double *values;     /* null before the first slice */
    wh_wafer_t *wafers; /* of the slice before, like the following */
    wh_pose_t grippers[WH_GRIPPERS];
    bool holds; /* a gripper holds a wafer */
} wh_slice_row_t;

void wh_slice_row_take(wh_slice_row_t *row, const wh_layout_t *layout, const double axes[],
                       const wh_state_t *state);
void wh_slice_row_free(wh_slice_row_t *row);

#endif
