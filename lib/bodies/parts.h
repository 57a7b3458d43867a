/* The parts of a whole cell, which make the world of its collision check. */
#ifndef WH_BODIES_PARTS_H
#define WH_BODIES_PARTS_H

#include "../layout/layout.h"
#include "shapes.h"

/* Something in the way, beside what stations, robots and grippers have: with its name. */
typedef struct {
    wh_part_t part;
    char name[WH_PART_NAME_SIZE];
} wh_obstacle_t;

typedef struct {
    wh_obstacle_t *items;
    size_t count;
} wh_obstacles_t;

/* Counts the parts of stations, robot and grippers. Obstacles are not among them. */
size_t wh_layout_count_parts(const wh_layout_t *layout);

/* Fills the list with these parts and the obstacles, which may be null, and makes them the layout's world.
 * The list needs room for all of them, and its arrays must outlive the layout. */
void wh_layout_set_parts(wh_layout_t *layout, wh_part_list_t *list, const wh_obstacles_t *obstacles);

/* Moves the collision world without the layout's table, if only stations stand elsewhere. `parts` and
 * `names` are room for the world's parts and one more for each station; they and the copy must outlive the
 * world. */
void wh_layout_move_world(wh_layout_t *copy, wh_part_t *parts, char (*names)[WH_PART_NAME_SIZE]);

#endif
