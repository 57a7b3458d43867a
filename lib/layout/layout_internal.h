/* Shared by the files that read a layout: one function for each part of it, in the order of reading. */
#ifndef WH_LAYOUT_LAYOUT_INTERNAL_H
#define WH_LAYOUT_LAYOUT_INTERNAL_H

#include "../script/reader.h"
#include "layout.h"
#include "layout_fields.h"

/* Zeroed memory for `count` items that lives as long as the Lua state. */
void *wh_layout_memory(lua_State *L, size_t count, size_t size);

/* As wh_layout_find_wafer: the index of a name, or WH_NONE. */
typedef int32_t wh_layout_find_t(const wh_layout_t *layout, const char *name);

/* Reads a field that names something of the layout, and returns what `lookup` says of the name; `expected` is
 * what an error says. Required if fallback is null. */
int32_t wh_layout_read_name(wh_reader_t *reader, const wh_layout_t *layout, const char *field,
                            const char *fallback, wh_layout_find_t *lookup, const char *expected);

/* The same for a gripper: the first one on the robot, unless the field names one. */
int32_t wh_layout_read_gripper_name(wh_reader_t *reader, const wh_layout_t *layout, const char *field,
                                    const char *expected);

/* The pitch of the wafers' size, mm; 0: there is none for such wafers. */
double wh_layout_default_pitch(const wh_layout_t *layout);

/* wh_reader_number of a field whose default follows from the wafers' size. If there is none (0), the field is
 * required, and the error says so. */
double wh_layout_sized(wh_reader_t *reader, const wh_layout_t *layout, const char *field, double fallback,
                       double min, double max);

/* Each reads its fields from the layout's top table, at which the reader is. */
void wh_layout_read_physics(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_robot(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_stations(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_grippers(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_effectors(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_wafers(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_sensing(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_shapes(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_world(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_study(wh_reader_t *reader, wh_layout_t *layout);

/* Wafers that sensors and beams can see, mm. */
#define WH_SENSED_LEAST 20
#define WH_SENSED_MOST 600

/* Reads the beams of the station at which the reader is. */
void wh_layout_read_beams(wh_reader_t *reader, wh_layout_t *layout, size_t s);

/* Fills in `blades`, once grippers and shapes are read. */
void wh_layout_read_blades(wh_layout_t *layout);

void wh_layout_read_faults(wh_reader_t *reader, wh_layout_t *layout);

#endif
