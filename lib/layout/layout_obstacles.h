/* Parts that a layout adds to the cell by itself: walls, tables, covers, tools on the robot. */
#ifndef WH_LAYOUT_LAYOUT_OBSTACLES_H
#define WH_LAYOUT_LAYOUT_OBSTACLES_H

#include "shapes.h"

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

#endif
