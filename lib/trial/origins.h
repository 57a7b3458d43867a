/* Where the wafers lay that grippers hold: for a GET that takes the wafer of another slot.
 *
 * It follows the cell by the states, slice by slice: before a slice nobody knows which wafer is taken in
 * it, and after it the wafer has moved with its gripper. It allocates nothing.
 */
#ifndef WH_TRIAL_ORIGINS_H
#define WH_TRIAL_ORIGINS_H

#include "../layout/layout.h"
#include "../sim/slice.h"

/* The wafer that a gripper took, and its place before that. */
typedef struct {
    int32_t wafer; /* WH_NONE: none, or one that came from another blade */
    wh_pose_t base_from_wafer;
} wh_origin_t;

typedef struct {
    const wh_layout_t *layout;
    wh_pose_t *lain; /* by wafer: where it lay last; the caller's */
    size_t wafer_count;
    int32_t held[WH_GRIPPERS]; /* by gripper: its wafer in the last state */
    wh_origin_t of[WH_GRIPPERS];
} wh_origins_t;

/* Begins with the cell as `state` has it. `lain` has room for its wafers; it and `layout` must outlive
 * `origins`. */
void wh_origins_begin(wh_origins_t *origins, const wh_layout_t *layout, wh_pose_t lain[],
                      const wh_state_t *state);

/* Looks at all wafers, as after a state that was restored. Cost: linear in the wafers. */
void wh_origins_look(wh_origins_t *origins, const wh_state_t *state);

/* Takes the state after a slice. One of a cell with another number of wafers changes nothing. Cost: linear in
 * the grippers; in a slice in which a fault begins or ends, that of wh_origins_look. */
void wh_origins_hear(wh_origins_t *origins, const wh_state_t *state);

/* Where the wafer lay that this gripper holds in the last state; null: it holds none, or nobody knows. */
const wh_pose_t *wh_origins_find(const wh_origins_t *origins, int32_t gripper);

#endif
