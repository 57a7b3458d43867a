/* Parts that a layout adds to the cell by itself: walls, tables, covers, tools on the robot. */
#ifndef WH_LAYOUT_LAYOUT_OBSTACLES_H
#define WH_LAYOUT_LAYOUT_OBSTACLES_H

#include "layout.h"

typedef struct {
    wh_part_t part;
    char name[WH_PART_NAME_SIZE];
} wh_obstacle_t;

typedef struct {
    wh_obstacle_t *items;
    size_t count;
} wh_obstacles_t;

/* Adds those that are fixed, or those that hang on something. */
void wh_obstacles_add(wh_part_list_t *list, const wh_obstacles_t *obstacles, bool fixed);

/* How many parts stations, robot and grippers of the layout have at most. */
size_t wh_layout_count_parts(const wh_layout_t *layout);

/* Fills the list with them and the obstacles, for which it must have room, and makes it the parts of the layout's world:
 * the list's arrays must outlive the layout. */
void wh_layout_set_parts(wh_layout_t *layout, wh_part_list_t *list, const wh_obstacles_t *obstacles);

#endif
