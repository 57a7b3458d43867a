/* A robot of a layout as a URDF has it: where its links are at the robot's axes, if that agrees with the
 * robot's own kinematics, and with which body of its arms (arms.h) each link moves.
 *
 * A joint follows one of the robot's axes, or an angle of a polar arm's links (WH_URDF_FOLD and on): value
 * = offset + factor * that, in rad or mm. Frames: the URDF's root is the robot's foot, base itself for the
 * usual robot; the link `tool` is the end-effector, on which grippers ride by their `at` and `rpy`, of a
 * second arm or wrist the other `tool`.
 */
#ifndef WH_BODIES_URDF_H
#define WH_BODIES_URDF_H

#include "../layout/links.h"
#include "urdf_file.h"

/* The largest distance of the URDF's end-effector from the robot's, mm, and the largest turn from it, rad:
 * rounding. */
#define WH_URDF_SAME_MM 1e-6
#define WH_URDF_SAME_RAD 1e-9

/* The number of configurations that are compared. */
#define WH_URDF_CONFIGURATIONS 500

/* Arms or wrists of one robot. */
#define WH_URDF_ARMS 2

/* Angles of a polar arm's two links, rad, behind the robot's axes in the order of sources; those of the
 * second arm come behind those of the first. */
enum {
    WH_URDF_FOLD = WH_CARRIER_AXES, /* between the line to the wrist and the upper arm; right_handed: < 0 */
    WH_URDF_SHOULDER,               /* of the upper arm against the foot's x; turns on with theta */
    WH_URDF_ELBOW,                  /* of the forearm against the upper arm; stretched: 0 */
    WH_URDF_WRIST,                  /* of the hand against the forearm; turns on with yaw */
    WH_URDF_FOLD_2,
    WH_URDF_SOURCES = WH_URDF_FOLD_2 + WH_URDF_FOLD_2 - WH_URDF_FOLD
};

/* How many there are of an arm. */
#define WH_URDF_ANGLES (WH_URDF_FOLD_2 - WH_URDF_FOLD)

typedef struct {
    int32_t source; /* an axis of the robot, or one of the angles above; -1: the joint stands */
    wh_real_t factor, offset;
} wh_urdf_drive_t;

typedef struct {
    const wh_urdf_file_t *file;
    size_t robot;                          /* of the layout's, whose axes these are */
    wh_urdf_drive_t drives[WH_URDF_LINKS]; /* of each link's joint; of those that mimic one, unused */
    size_t arm_count;                      /* 1, or 2 of a robot with two arms or wrists */
    int32_t tools[WH_URDF_ARMS];           /* links */
    bool folds[WH_URDF_ARMS];              /* a joint follows an angle of this arm's links */
} wh_urdf_map_t;

/* The result over all configurations. */
typedef struct {
    size_t reached; /* configurations: those that the arms' links reach */
    /* where the end-effectors differ most: which arm's, by how much, the axes, and both places in base */
    size_t arm;
    wh_real_t mm, rad;
    wh_real_t axes[WH_AXES];
    wh_vec3_t is, should;
    /* a joint beyond its limits: the link that it carries, or -1, its farthest value and the axes there */
    int32_t beyond;
    wh_real_t beyond_value;
    wh_real_t beyond_axes[WH_AXES];
    /* by link: the number of the body that it moves with, or -1, and its place there, to 1e-9 mm and 1e-12 */
    int32_t body[WH_URDF_LINKS];
    wh_pose_t body_from_link[WH_URDF_LINKS];
} wh_urdf_findings_t;

/* Takes the lengths of arm `number` of a map, an arm that folds, from its joints, to 1e-9 mm. Only the arm's
 * heading is taken from the robot. right_handed is read. */
void wh_urdf_arm(const wh_urdf_map_t *map, size_t number, const wh_layout_t *layout, wh_arm_t *arm);

/* The value of the joint that carries a link, rad or mm. */
wh_real_t wh_urdf_joint(const wh_urdf_map_t *map, int32_t link, const wh_real_t sources[]);

/* Looks at home, at both ends of each axis of the map's robot, and at places spread evenly over its travels;
 * other robots are at home. From the places with a limited joint's least and largest value a search goes on
 * to the joint's extremes: for an angle of the links, or R of an arm that folds, first over an even grid of R
 * and yaw, then along the axes by steps from a quarter of their travels down to 1e-9 of them. Angles of the
 * links count their full turns. The layout's machine, arms and the arms' lengths must be read. Cost: some 10
 * ms for each robot of the layout, and 5 ms for each limited joint that follows an angle of the links, 0.1 ms
 * for another one; bounded by the number of joints. */
void wh_urdf_examine(const wh_urdf_map_t *map, const wh_layout_t *layout, wh_urdf_findings_t *findings);

/* Takes a shape from its link's frame to the body's, all to 1e-9 mm. */
void wh_urdf_shape_place(const wh_pose_t *body_from_link, wh_convex_t *convex);

#endif
