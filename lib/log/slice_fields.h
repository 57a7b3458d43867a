/* A slice as a row of numbers, each with a name: what a table of slices has as its columns, and what two
 * recordings are compared by.
 *
 * In this order: each axis ("axis theta rad", or "axis 1" where only a message tells of the cell); of each
 * gripper its valve (0: open), its sensor (1: on), its vacuum (0 to 1), the wafer that it is measured against
 * (record/counterpart.h) and, as absolute values, the distances and the angle between the two (mm, mm,
 * cosine), and in a cell with edge grips its plunger (s, mm); of each wafer who holds it, where it is (mm, in
 * base) and how it is turned (a unit quaternion), and in a cell with faces 1 if it is face down. Where there
 * are faces, edge grips or passive pads, then how the face that looks at its gripper lies in the gripper's
 * frame: dx and dy (mm) and the turn of its x (deg), and in a cell with faces 1 if that is its front.
 *
 * What is not known, or not there, is NaN: axes that a log does not tell, what a gripper is measured by if
 * nothing is near it, the plunger of one that has none, and how a wafer is held that nobody holds.
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

/* The i-th one's name, such as "Wafer 1 x mm", and what kind it is of. */
wh_slice_field_t wh_slice_field_name(const wh_layout_t *layout, size_t i, char name[WH_SLICE_FIELD_NAME]);

/* The name that stands for an index; "" for WH_NONE; null for a number. */
const char *wh_slice_field_word(const wh_layout_t *layout, wh_slice_field_t kind, double value);

/* Writes all of them. `axes` as of wh_log_run_listener_t. Cost: linear in the wafers, times the grippers. */
void wh_slice_fields(const wh_layout_t *layout, const double axes[], const wh_state_t *state,
                     double values[]);

#endif
