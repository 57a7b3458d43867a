/* Tables of measurements, read from files of comma-separated values: points touched at stations, timed
 * moves of axes, and a robot's touches.
 *
 * A line that is not understood is refused with file, line, column, value and the expected form
 * (text/csv.h). Host code: it ends the program if out of memory. */
#ifndef WH_ESTIMATE_TABLES_H
#define WH_ESTIMATE_TABLES_H

#include "../motion/robot.h"
#include "../text/csv.h"
#include "frame.h"
#include "geometry.h"
#include "limits.h"

/* ------------------------------------------------------------------------------------------------- points */

/* The most stations of a table. */
#define WH_TABLE_STATIONS 1000

/* The points of a station, in the order of the file. */
typedef struct {
    const char *name;
    wh_frame_point_t *points;
    size_t *lines; /* lines of the file, one for each point */
    size_t count, capacity, line_capacity;
    wh_frame_estimate_t estimate; /* the result of wh_point_table_estimate */
} wh_station_points_t;

/* Stations in the order in which the file first names them. Zero it at the beginning. */
typedef struct {
    wh_csv_t csv;
    wh_station_points_t *stations;
    size_t count, capacity;
} wh_point_table_t;

/* Reads a table with the columns station, touched_x, touched_y, touched_z (mm in base), x, y and z (mm on
 * the station). Returns WH_STATUS_BAD_TABLE if it is refused; csv.message then gives the reason. Close it
 * in either case. */
wh_status_t wh_point_table_open(wh_point_table_t *table, const char *path);

/* Fits the frame of each station. Returns true if all are determined. */
bool wh_point_table_estimate(wh_point_table_t *table);

void wh_point_table_close(wh_point_table_t *table);

/* -------------------------------------------------------------------------------------------------- moves */

/* The axes whose limits a layout gives: the robot's, and the prealigners' chucks. */
#define WH_TABLE_AXES (WH_ROBOT_AXES + 1)

/* The moves of an axis, in the order of the file; `count` is 0 if there are none. */
typedef struct {
    wh_timed_move_t *moves;
    size_t *lines; /* lines of the file, one for each move */
    size_t count, capacity, line_capacity;
    wh_limits_estimate_t estimate; /* the result of wh_move_table_estimate */
} wh_axis_moves_t;

/* One for each axis: WH_AXIS_THETA to WH_AXIS_YAW, then the chucks. Zero it at the beginning. */
typedef struct {
    wh_csv_t csv;
    wh_axis_moves_t axes[WH_TABLE_AXES];
} wh_move_table_t;

/* Reads a table with the columns axis (theta, r, z, yaw or chuck), from, to (mm; degrees of theta, yaw and
 * chuck) and seconds, from the command to the end of the move. Returns WH_STATUS_BAD_TABLE if it is
 * refused; csv.message then gives the reason. Close it in either case. */
wh_status_t wh_move_table_open(wh_move_table_t *table, const char *path);

/* Fits the limits of each axis that has moves, and with `with_delay` a delay. Returns true if all are
 * determined. */
bool wh_move_table_estimate(wh_move_table_t *table, bool with_delay);

/* True for an axis whose estimate is OK, with no move set aside and times that scatter about the fitted
 * profile by no more than rounding to 1 ms does: no real axis is so exact, so they look simulated. */
bool wh_axis_moves_look_simulated(const wh_axis_moves_t *moves);

void wh_move_table_close(wh_move_table_t *table);

/* ------------------------------------------------------------------------------------------------ touches */

/* The touches of a robot, in the order of the file. Zero it at the beginning. */
typedef struct {
    wh_csv_t csv;
    wh_touch_t *touches;
    size_t *lines; /* lines of the file, one for each touch */
    size_t count, capacity, line_capacity;
    wh_geometry_estimate_t estimate; /* the result of wh_touch_table_estimate */
} wh_touch_table_t;

/* Reads a table with the columns theta, r, z, yaw (the axes as the controller gives them, degrees and mm),
 * touched_x, touched_y, touched_z (mm, the known place of the touched point) and perhaps heading (degrees;
 * of the tool, from x towards y; in lines where it was measured). Returns WH_STATUS_BAD_TABLE if it is
 * refused; csv.message then gives the reason. Close it in either case. */
wh_status_t wh_touch_table_open(wh_touch_table_t *table, const char *path);

/* Fits the geometry, and with `with_scales` the axes' scales. Returns true if everything is determined. */
bool wh_touch_table_estimate(wh_touch_table_t *table, bool with_scales);

void wh_touch_table_close(wh_touch_table_t *table);

/* An axis's name in tables and layouts, and whether it turns. */
const char *wh_table_axis_name(size_t axis);
bool wh_table_axis_turns(size_t axis);

#endif
