/* The sizes of what a cell's shapes are made from: blades, ledges, walls, chucks; and parts with their names.
 * bodies/shapes.h makes the shapes.
 */
#ifndef WH_LAYOUT_SIZES_H
#define WH_LAYOUT_SIZES_H

#include "../collision/world.h"

#define WH_PART_NAME_SIZE 144

/* A horseshoe blade in the gripper's frame: its upper side is the contact plane. mm. */
typedef struct {
    wh_real_t thickness;
    wh_real_t half_width; /* of the horseshoe */
    wh_real_t finger;     /* width of a finger, less than half_width */
    wh_real_t length;     /* from the gripper's origin forward to the finger tips */
    wh_real_t palm; /* from the gripper's origin back to the horseshoe's end; the neck goes on to the wrist */
} wh_blade_t;

/* The ledges that carry a wafer left and right, in the slot's frame: their upper side is the slot's plane.
 * mm. */
typedef struct {
    wh_real_t inner, outer; /* from the middle to both edges, inner < outer */
    wh_real_t thickness;
    wh_real_t length; /* along the way in, about the wafer's middle */
} wh_ledge_t;

/* The shell of a FOUP around its slots, open towards the robot. mm. */
typedef struct {
    wh_real_t room;        /* between a centred wafer's rim and the walls */
    wh_real_t wall;        /* thickness */
    wh_real_t floor, roof; /* from the first slot's plane down, from the last one's up, to the inside */
} wh_shell_t;

/* A prealigner's chuck, on whose upper side the wafer lies, and the body below it. mm. */
typedef struct {
    wh_real_t radius, height;
    wh_real_t body; /* radius of the body, which begins 1 mm below the chuck */
} wh_spindle_t;

typedef struct {
    wh_real_t wafer_radius, wafer_thickness;
    wh_real_t lowest; /* of the robot's Z travel */
    wh_arm_t arm;
    wh_blade_t blade;
    wh_ledge_t ledge;
    wh_shell_t shell;
    wh_spindle_t chuck;
} wh_shapes_t;

/* Parts with their names, while they are collected. */
typedef struct {
    wh_part_t *parts;
    char (*names)[WH_PART_NAME_SIZE];
    size_t count, capacity;
} wh_part_list_t;

#endif
