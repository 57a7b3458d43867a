/* Within the room: what the three grips of a step share. */
#ifndef WH_GRASP_GRIPS_INTERNAL_H
#define WH_GRASP_GRIPS_INTERNAL_H

#include "grips.h"

/* One slice of one gripper. */
typedef struct {
    wh_grips_t *grips;
    wh_gripper_t *gripper;
    const wh_gripper_input_t *input;
    wh_event_list_t *list; /* null: not wanted */
    size_t index;
} wh_turn_t;

static inline wh_wafer_t *wh_turn_wafers(const wh_turn_t *turn) {
    return turn->grips->table->storage.wafers;
}

/* The wafer stays where it is now. */
void wh_turn_let_go(const wh_turn_t *turn) WH_SYMBOL(wh_turn_let_go);

/* The wafer is the gripper's from now on, and the pick is reported, `measured` being of the gripper's pose at
 * the slice's end. The caller sets gripper_from_wafer. */
void wh_turn_take(const wh_turn_t *turn, size_t wafer) WH_SYMBOL(wh_turn_take);

/* The frame of the face of this wafer that looks at the gripper. */
wh_face_t wh_turn_face(const wh_turn_t *turn, size_t wafer, wh_pose_t *base_from_face)
    WH_SYMBOL(wh_turn_face);

/* Parts 2 and 3 of a step for an edge grip. The picks are asked of grippers that began the slice without a
 * wafer. */
void wh_edge_turn_move(const wh_turn_t *turn) WH_SYMBOL(wh_edge_turn_move);
void wh_edge_turn_pick(const wh_turn_t *turn) WH_SYMBOL(wh_edge_turn_pick);

/* And for passive pads. */
void wh_passive_turn_move(const wh_turn_t *turn) WH_SYMBOL(wh_passive_turn_move);
void wh_passive_turn_pick(const wh_turn_t *turn) WH_SYMBOL(wh_passive_turn_pick);

/* And for vacuum; the third is part 4's near misses and contests. */
void wh_vacuum_turn_move(const wh_turn_t *turn) WH_SYMBOL(wh_vacuum_turn_move);
void wh_vacuum_turn_pick(const wh_turn_t *turn) WH_SYMBOL(wh_vacuum_turn_pick);
void wh_vacuum_turn_watch(const wh_turn_t *turn) WH_SYMBOL(wh_vacuum_turn_watch);

#endif
