/* Shared by the files that read a layout: one function for each part of it, in the order of reading. */
#ifndef WH_READING_LAYOUT_INTERNAL_H
#define WH_READING_LAYOUT_INTERNAL_H

#include "../layout/layout.h"
#include "../layout/layout_fields.h"
#include "../script/reader.h"
#include "layout_read.h"

/* The path of a file that another one names: relative to that one's folder. */
void wh_layout_path(char *path, size_t size, const char *beside, const char *name);

/* A function like wh_layout_find_wafer: it returns the index of a name, or WH_NONE. */
typedef int32_t wh_layout_find_t(const wh_layout_t *layout, const char *name);

/* Reads a field that names something of the layout, and returns what `lookup` says of the name; `expected` is
 * what an error says. Required if fallback is null. */
int32_t wh_layout_read_name(wh_reader_t *reader, const wh_layout_t *layout, const char *field,
                            const char *fallback, wh_layout_find_t *lookup, const char *expected);

/* Reads a field that names a gripper: the first one on the robot, unless the field names one. */
int32_t wh_layout_read_gripper_name(wh_reader_t *reader, const wh_layout_t *layout, const char *field,
                                    const char *expected);

/* The pitch of the wafers' size, mm; 0: there is none for such wafers. */
double wh_layout_default_pitch(const wh_layout_t *layout);

/* speed, acceleration and jerk by default, as the rows have them: in rad if they turn; and those of the table
 * being read. */
wh_limits_t wh_layout_usual_limits(const wh_reader_field_t *rows, bool turns);
void wh_layout_read_limits(wh_reader_t *reader, wh_limits_t *limits);

/* wh_reader_apart of a field whose default follows from the wafers' size. If there is none (0), the field is
 * required, and the error says so. */
double wh_layout_sized(wh_reader_t *reader, const wh_layout_t *layout, const char *field, double fallback);

/* Each reads its fields from the layout's top table, at which the reader is. */
void wh_layout_read_patterns(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_physics(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_robot(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_stations(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_grippers(wh_reader_t *reader, wh_layout_t *layout);

/* Stations that are given by `axes`. At a station: true if slot 1's place is, which waits for the
 * grippers, and nothing else says it. At a station or at a robot's part of it: refuses what does not go
 * with `axes`. Then, behind the grippers: the places; and the grippers at stations, where these now stand. */
bool wh_layout_is_taught(wh_reader_t *reader, const wh_layout_t *layout);
void wh_layout_check_taught(wh_reader_t *reader);
void wh_layout_read_taught(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_move_chucks(wh_layout_t *layout);
void wh_layout_read_doors(wh_reader_t *reader, wh_layout_t *layout);

/* Reads the times of stations, once doors and servers are read. */
void wh_layout_read_times(wh_reader_t *reader, wh_layout_t *layout);

/* The points that the arm passes on its way to stations. */
void wh_layout_read_vias(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_effectors(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_wafers(wh_reader_t *reader, wh_layout_t *layout);

/* Load ports, and carriers without their wafers, whose number is returned; those wafers, for which there must
 * be room; and, once all wafers are there, in which state each port begins. */
size_t wh_layout_read_ports(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_add_carried(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_begin_ports(wh_reader_t *reader, wh_layout_t *layout);

/* Read `grip` of the gripper at which the reader is; and, once rims are read, the wafers as edge grips meet
 * them. */
void wh_layout_read_grip(wh_reader_t *reader, wh_layout_t *layout, size_t g);
void wh_layout_read_edge_wafers(wh_reader_t *reader, wh_layout_t *layout);

void wh_layout_read_sensing(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_shapes(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_world(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_study(wh_reader_t *reader, wh_layout_t *layout);

/* Reads the links of robots from the URDFs that they name, if they do, once the arms' lengths are read. */
void wh_layout_read_urdfs(wh_reader_t *reader, wh_layout_t *layout);

/* Fails at a field that must not be there. */
void wh_layout_refuse_field(wh_reader_t *reader, const char *field, const char *expected);

/* Finds numbers that look as if they were in another unit, once all of the table is read. */
void wh_layout_guess_units(wh_reader_t *reader, wh_layout_t *layout);

/* `robots`; and one of them, at which the reader is. */
void wh_layout_read_robots(wh_reader_t *reader, wh_layout_t *layout);
void wh_layout_read_carrier(wh_reader_t *reader, wh_layout_robot_t *robot);

/* Makes the layout's robots, all of them read, the machine's; the layout goes by the first where it asks for
 * one. */
void wh_layout_take_carriers(wh_layout_t *layout);

/* Reads how robots come to the station at which the reader is: the rail's place and the elbow's side, and
 * with several robots the way in of each. */
void wh_layout_read_approach(wh_reader_t *reader, const wh_layout_t *layout, size_t s);

/* speed, acceleration and jerk; degrees where it turns. */
void wh_layout_read_axis_limits(wh_reader_t *reader, bool turns, wh_limits_t *limits);

/* The speed of a way of mm or rad that takes `seconds`, a field of the table at which the reader is. */
void wh_layout_read_seconds(wh_reader_t *reader, wh_real_t way, wh_limits_t *limits);

/* The place and the kind of the shape at which the reader is: box, cylinder, capsule or mesh. */
void wh_layout_read_shape(wh_reader_t *reader, const wh_layout_t *layout, const char *name,
                          wh_convex_t *convex);

/* Once grippers are read, and with several robots: which of them serve the station at which the reader is. */
void wh_layout_read_server(wh_reader_t *reader, wh_layout_t *layout, size_t s);

/* The names of the table at which the reader is, sorted, for Lua's own order differs from run to run: `count`
 * items of `size` bytes that begin with their name. More than `most` are refused. */
void *wh_layout_read_keys(wh_reader_t *reader, size_t most, size_t size, const char *what, size_t *count);

/* `shape` of errors that are spread. */
wh_shape_t wh_layout_read_spread_shape(wh_reader_t *reader, wh_shape_t fallback);

/* Reads the beams of the station at which the reader is. */
void wh_layout_read_beams(wh_reader_t *reader, wh_layout_t *layout, size_t s);

/* Reads the probe of a gripper and the blocks of stations, once beams are read. */
void wh_layout_read_blocks(wh_reader_t *reader, wh_layout_t *layout);

/* Fills in `blades`, once grippers and shapes are read. */
void wh_layout_read_blades(wh_reader_t *reader, wh_layout_t *layout);

/* Reads `loaded` of the robot or gripper at which the reader is. */
void wh_layout_read_loaded(wh_reader_t *reader, wh_limits_t *loaded);

void wh_layout_read_faults(wh_reader_t *reader, wh_layout_t *layout);

#endif
