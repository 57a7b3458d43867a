/* The parts of a cell for the collision check: what a layout says of them, and defaults that fit wafers of
 * 150, 200 and 300 mm.
 *
 * A part has a name for reports: "A ledge 3 left", "EE finger right", "forearm", "wall".
 */
#ifndef WH_BODIES_SHAPES_H
#define WH_BODIES_SHAPES_H

#include "../align/beam.h"
#include "../cell/station.h"
#include "../grasp/edge.h"
#include "../layout/sizes.h"

/* The stand that carries the wafers of a station. */
typedef enum { WH_STAND_LEDGES, WH_STAND_FOUP, WH_STAND_CHUCK, WH_STAND_NOTHING } wh_stand_t;

/* The defaults for wafers of a diameter and thickness, and a robot whose R reaches to `farthest` and Z down
 * to `lowest`. */
wh_shapes_t wh_shapes_default(wh_real_t diameter, wh_real_t thickness, wh_real_t farthest, wh_real_t lowest);

/* The length of a polar arm's links by default, of a robot whose R reaches to `farthest`, mm. */
wh_real_t wh_shapes_link(wh_real_t farthest);

/* How many parts the functions below add at most. */
size_t wh_shapes_count_station(wh_stand_t stand, int32_t slots);
#define WH_SHAPES_ROBOT 5
#define WH_SHAPES_GRIPPER 5
#define WH_SHAPES_EDGE 3

/* Adds a station's ledges, shell and load port, or its prealigner's body: fixed parts with the owner
 * `index`. */
void wh_shapes_add_station(wh_part_list_t *list, const wh_shapes_t *shapes, const wh_station_t *station,
                           int32_t index, wh_stand_t stand, const char *name);

/* An arm to be added. */
typedef struct {
    wh_real_t links[2];         /* lengths of upper arm and forearm, mm */
    wh_real_t reach;            /* from the wrist to the end-effector's origin */
    wh_real_t lowest;           /* the least height of the contact plane */
    size_t first;               /* number of the arm's first body */
    const char *robot, *number; /* what stands before and behind the parts' names */
    wh_arm_body_t own;          /* bodies before this one are another arm's */
} wh_shapes_arm_t;

/* Adds an arm from its first own body on: a robot's first one with the column. */
void wh_shapes_add_arm(wh_part_list_t *list, const wh_shapes_t *shapes, const wh_shapes_arm_t *arm);

/* Adds a gripper's blade with its neck to the wrist, `reach` behind the end-effector's origin, and with a
 * post where the blade is above or below the hand; without a pose (null) the chuck of a prealigner. The pose
 * turns about z alone. */
void wh_shapes_add_gripper(wh_part_list_t *list, const wh_shapes_t *shapes, int32_t gripper, wh_real_t reach,
                           const wh_pose_t *effector_from_gripper, const char *name);

/* Adds the two rests of an edge grip, and its plunger as long as its stroke, as high as a wafer above the
 * blade. */
void wh_shapes_add_edge(wh_part_list_t *list, const wh_shapes_t *shapes, int32_t gripper,
                        const wh_edge_t *edge, const char *name);

/* A gripper's blade with its neck from above, as beams see it: within 1 m of the gripper's origin. */
wh_blade_outline_t wh_shapes_outline(const wh_shapes_t *shapes, const wh_pose_t *effector_from_gripper);

/* Adds a part, for which there must be room. Its name is cut to fit. */
void wh_shapes_add(wh_part_list_t *list, const wh_part_t *part, const char *name, ...)
    __attribute__((format(printf, 3, 4)));

/* A wafer as a disc, its back face at its origin. */
wh_convex_t wh_shapes_wafer(const wh_shapes_t *shapes);

#endif
