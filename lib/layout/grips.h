/* A layout's grips, as a simulator takes them: only layouts that use something new have any. */
#ifndef WH_LAYOUT_GRIPS_H
#define WH_LAYOUT_GRIPS_H

#include "../sim/simulator.h"
#include "layout.h"

/* The memory that a simulator with grips writes to beside its wafers and grippers. Each simulator has its
 * own. */
typedef struct {
    wh_wafer_t *seen; /* as many as the layout has wafers; null where it has no grips */
} wh_grips_room_t;

/* True if a simulator of this layout needs grips. */
bool wh_layout_has_grips(const wh_layout_t *layout);

/* True if a gripper has passive pads. */
bool wh_layout_has_passive(const wh_layout_t *layout);

/* Finds whether wafers may come to lie face down, once robots, stations and wafers are known. */
void wh_layout_find_faces(wh_layout_t *layout);

/* The number of supports that take wafers over from passive pads: the planes of all slots, chucks
 * included. 0 without such pads. */
size_t wh_layout_count_supports(const wh_layout_t *layout);

/* Makes the planes of the layout's places its supports; `supports` has room for their count, and must
 * outlive it. */
void wh_layout_take_supports(wh_layout_t *layout, wh_pose_t supports[]);

/* True if a gripper has an edge grip; and if anything of the cell meets wafers' true rims: edge sensors,
 * beams or edge grips. */
bool wh_layout_has_edge(const wh_layout_t *layout);
bool wh_layout_has_rims(const wh_layout_t *layout);

/* A rim as an edge grip meets it: a circle with a notch. Chips, bow and roundings of corners do not count. */
wh_edge_wafer_t wh_layout_edge_wafer(const wh_rim_t *rim);

/* Why an edge grip cannot take a wafer with this rim, a constant text that says which it takes; null if it
 * can. `wafer` is wh_layout_edge_wafer of the rim. */
const char *wh_layout_edge_refuses(const wh_edge_t *edge, const wh_rim_t *rim, const wh_edge_wafer_t *wafer);

/* True if each edge grip of the layout may take a wafer with this rim. */
bool wh_layout_edges_take(const wh_layout_t *layout, const wh_rim_t *rim);

/* A layout's grips as a step takes them, without the parts that belong to one simulator: `states` and
 * `seen`. */
wh_grips_parts_t wh_layout_grips(const wh_layout_t *layout);

/* wh_grips_complete of a state that came from elsewhere, for a simulator of this layout. */
bool wh_layout_complete_grips(const wh_layout_t *layout, const wh_gripper_t grippers[],
                              wh_physics_state_t *physics);

/* "vacuum", "edge" or "passive". */
const char *wh_layout_grip_name(wh_grip_kind_t kind);

/* How many wafers `seen` needs room for: none without grips. */
size_t wh_layout_seen(const wh_layout_t *layout);

/* How many buckets a table of the layout may have: grips have none. */
size_t wh_layout_buckets(const wh_layout_t *layout);

/* wh_simulator_set_grips for a simulator that was just set up with the layout's physics. Without grips
 * nothing is done, and WH_OK returned. */
wh_status_t wh_layout_give_grips(const wh_layout_t *layout, wh_simulator_t *simulator, wh_grips_room_t *room);

/* A wafer in the middle of a slot, the way its station wants it. */
wh_pose_t wh_layout_lying(const wh_layout_t *layout, int32_t station, int32_t slot);

/* "up" or "down"; "up or down" for either. */
const char *wh_layout_face_name(wh_station_face_t face);

/* How a wafer lies or is held: face down if its e3 points below the horizontal; as a word "up" or "down". */
bool wh_layout_is_face_down(const wh_pose_t *base_from_wafer);
const char *wh_layout_face_of(const wh_pose_t *base_from_wafer);

/* wh_face_towards where the cell has faces, else the back. */
wh_face_t wh_layout_face_towards(const wh_layout_t *layout, const wh_pose_t *base_from_wafer,
                                 const wh_pose_t *base_from_gripper);

/* The check of the face that looks at the gripper, by the layout's tolerance: wh_face_measure where the
 * cell has faces, else wh_proximity_measure. */
wh_status_t wh_layout_measure(const wh_layout_t *layout, const wh_pose_t *base_from_wafer,
                              const wh_pose_t *base_from_gripper, wh_proximity_t *result);

#endif
