/* Within the layout reader: one function for each part of a layout, in the order in which they are read. */
#ifndef WH_LAYOUT_LAYOUT_INTERNAL_H
#define WH_LAYOUT_LAYOUT_INTERNAL_H

#include "../script/reader.h"
#include "layout.h"
#include "layout_obstacles.h"

/* Memory for `count` items that lives as long as the state, zeroed. */
void *wh_layout_memory(lua_State *L, size_t count, size_t size);

/* Each reads its fields from the table that the reader is at, the layout's top. */
void wh_layout_read_checks(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_physics(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_robot(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_stations(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_grippers(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_effectors(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_wafers(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_shapes(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_world(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_study(wh_reader_t *reader, wh_layout_t *layout);

/* What the layout adds by itself, for wh_layout_read_world. */
void wh_layout_read_obstacles(wh_reader_t *reader, const wh_layout_t *layout, wh_obstacles_t *obstacles);
void wh_layout_read_faults(wh_reader_t *reader, wh_layout_t *layout);

#endif
