/* Internal to the room: shared by the three grips of a step. */
#ifndef WH_GRASP_GRIPS_INTERNAL_H
#define WH_GRASP_GRIPS_INTERNAL_H

#include "grips.h"

/* One slice of one gripper. */
typedef struct {
    wh_grips_t *grips;
    wh_gripper_t *gripper;
    const wh_gripper_input_t *input;
    wh_event_list_t *list; /* may be null */
    size_t index;
} wh_turn_t;

static inline wh_wafer_t *wh_turn_wafers(const wh_turn_t *turn) {
    return turn->grips->table->storage.wafers;
}

/* Releases the wafer at its present place. */
void wh_turn_let_go(const wh_turn_t *turn) WH_SYMBOL(wh_turn_let_go);

/* Gives the wafer to the gripper and reports the pick; `measured` is of the gripper's pose at the slice's
 * end. The caller sets gripper_from_wafer. */
void wh_turn_take(const wh_turn_t *turn, size_t wafer) WH_SYMBOL(wh_turn_take);

/* The frame of this wafer's face towards the gripper. */
wh_face_t wh_turn_face(const wh_turn_t *turn, size_t wafer, wh_pose_t *base_from_face)
    WH_SYMBOL(wh_turn_face);

/* Parts 2 and 3 of a step for an edge grip. Picks are for grippers that began the slice without a wafer. */
void wh_edge_turn_move(const wh_turn_t *turn) WH_SYMBOL(wh_edge_turn_move);
void wh_edge_turn_pick(const wh_turn_t *turn) WH_SYMBOL(wh_edge_turn_pick);

/* These are the parts for passive pads. */
void wh_passive_turn_move(const wh_turn_t *turn) WH_SYMBOL(wh_passive_turn_move);
void wh_passive_turn_pick(const wh_turn_t *turn) WH_SYMBOL(wh_passive_turn_pick);

/* These are the parts for vacuum; the third has part 4's near misses and contests. */
void wh_vacuum_turn_move(const wh_turn_t *turn) WH_SYMBOL(wh_vacuum_turn_move);
void wh_vacuum_turn_pick(const wh_turn_t *turn) WH_SYMBOL(wh_vacuum_turn_pick);
void wh_vacuum_turn_watch(const wh_turn_t *turn) WH_SYMBOL(wh_vacuum_turn_watch);

#endif
