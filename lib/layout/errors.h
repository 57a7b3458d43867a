/* The errors of a study: how wide each is, and what a trial draws of it.
 *
 * Placement says where a wafer lies in its slot, teaching how far a station really stands from where it was taught, timing by
 * how much valves and vacuum act late. Lengths in mm, angles in degrees, times in s. A width of 0 is drawn as 0.
 */
#ifndef WH_LAYOUT_ERRORS_H
#define WH_LAYOUT_ERRORS_H

#include "../math/deviate.h"
#include "../math/pose.h"
#include "../motion/machine.h"

typedef enum {
    WH_SHAPE_NORMAL, /* the width is the standard deviation */
    WH_SHAPE_UNIFORM /* evenly from -width to +width */
} wh_shape_t;

typedef struct {
    wh_real_t width; /* at least 0 */
    wh_shape_t shape;
} wh_spread_t;

/* Where a wafer lies, in its slot's frame: beside, above, tilted about the slot's x and y (each is drawn), turned about z. */
typedef enum {
    WH_PLACEMENT_DX,
    WH_PLACEMENT_DY,
    WH_PLACEMENT_DZ,
    WH_PLACEMENT_TILT,
    WH_PLACEMENT_TURN
} wh_placement_field_t;
#define WH_PLACEMENT_FIELDS 5

/* Where a station stands: moved along base's axes, turned about lines through slot 1 along base's fixed x, y, z. */
typedef enum {
    WH_TEACHING_X,
    WH_TEACHING_Y,
    WH_TEACHING_Z,
    WH_TEACHING_ROLL,
    WH_TEACHING_PITCH,
    WH_TEACHING_YAW
} wh_teaching_field_t;
#define WH_TEACHING_FIELDS 6

typedef struct {
    wh_spread_t of[WH_PLACEMENT_FIELDS];
} wh_placement_t;

typedef struct {
    wh_spread_t of[WH_TEACHING_FIELDS];
} wh_teaching_t;

/* One for each wafer, station and gripper of a layout. A delay is the size of what is drawn: never early. */
typedef struct {
    wh_placement_t *wafers;
    wh_teaching_t *stations;
    wh_spread_t valves[WH_GRIPPERS]; /* each gripper's valve acts so late */
    wh_spread_t vacuum;              /* the vacuum's time constant upwards is so much longer */
} wh_errors_t;

/* What a trial has drawn. */
typedef struct {
    wh_vec3_t moved;   /* mm */
    wh_real_t turn[3]; /* about x, y, z; deg */
} wh_displacement_t;

/* Each depends on seed, trial, field and index alone. Cost: about 70 ns for each width that is not 0. */
wh_displacement_t wh_errors_draw_wafer(const wh_errors_t *errors, const wh_trial_t *trial, size_t wafer);
wh_displacement_t wh_errors_draw_station(const wh_errors_t *errors, const wh_trial_t *trial, size_t station);
wh_real_t wh_errors_draw_valve(const wh_errors_t *errors, const wh_trial_t *trial, size_t gripper);
wh_real_t wh_errors_draw_vacuum(const wh_errors_t *errors, const wh_trial_t *trial);

/* Whether anything of it is not 0. */
bool wh_displacement_is_any(const wh_displacement_t *displacement);

#endif
