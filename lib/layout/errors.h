/* The errors of a study: the width of each, and a trial's draw of it.
 *
 * Placement says where a wafer lies in its slot. Teaching says how far a station stands from where it was
 * taught. Timing says how late valves and vacuum act. Rims are the edges of wafers that edge sensors and
 * beams see. Beams stand beside their expected places, and latch late. Lengths in mm, angles in degrees,
 * times in s. A width of 0 draws 0.
 */
#ifndef WH_LAYOUT_ERRORS_H
#define WH_LAYOUT_ERRORS_H

#include "../math/pose.h"
#include "../motion/machine.h"
#include "../sim/faults.h"
#include "rim_errors.h"

/* The order of a wafer's errors in its slot's frame: dx, dy, dz beside and above, tilt about the slot's x and
 * y (one draw each), turn about z. The order of a station's errors: shifts along base's x, y, z, then turns
 * by roll, pitch, yaw about lines through slot 1 that are parallel to base's fixed x, y, z. */
#define WH_SPREADS 6
typedef struct {
    wh_spread_t of[WH_SPREADS];
} wh_spreads_t;

/* Where a wafer lies or a station stands, beside its place. */
typedef struct {
    wh_vec3_t moved;   /* mm */
    wh_real_t turn[3]; /* about x, y, z; deg */
} wh_displacement_t;

/* The draws for a beam: see beam_errors.h. */
typedef enum {
    WH_BEAM_DX,   /* mm, in the station's frame */
    WH_BEAM_DY,   /* mm */
    WH_BEAM_LATE, /* s */
    WH_BEAM_DRAWS
} wh_beam_draw_t;

typedef struct {
    wh_spread_t of[WH_BEAM_DRAWS];
} wh_beam_spreads_t;

/* Errors that are given, not drawn: for each wafer, station, gripper and beam of a layout. */
typedef struct {
    wh_displacement_t *wafers, *stations;
    wh_vec3_t *taught;            /* robot_count times of each station; null: all 0 */
    double (*rims)[WH_RIM_DRAWS]; /* of each wafer */
    double beams[WH_BEAMS][WH_BEAM_DRAWS];
    wh_real_t valves[WH_GRIPPERS], vacuum, debounce; /* s, at least 0 */
} wh_given_t;

/* One entry for each wafer, station, gripper and beam of a layout. A delay is the magnitude of the draw:
 * never early. */
typedef struct {
    const wh_given_t *given; /* what each trial then draws, whatever the widths; null: it goes by them */
    size_t robot_count;      /* the layout's */
    wh_spreads_t *wafers, *stations;
    wh_rim_spreads_t *rims; /* of each wafer */
    wh_beam_spreads_t beams[WH_BEAMS];
    wh_spread_t valves[WH_GRIPPERS]; /* how late each gripper's valve acts */
    wh_spread_t process;             /* of each station's process, longer or shorter, s */
    wh_spread_t port;                /* of each step of each load port, likewise */
    wh_spread_t vacuum;              /* added to the time constant with which vacuum builds up */
    wh_spread_t debounce;            /* added to that of the vacuum sensors */
} wh_errors_t;

/* Each draw depends on seed, trial, field and index alone. Cost: about 70 ns for each width that is not 0. */
wh_displacement_t wh_errors_draw_wafer(const wh_errors_t *errors, const wh_trial_t *trial, size_t wafer);
wh_displacement_t wh_errors_draw_station(const wh_errors_t *errors, const wh_trial_t *trial, size_t station);

/* With several robots a station stands where it should, only turned, and each robot was taught it by itself.
 * The result is how far the station stands from the place that this robot was taught, mm along base's axes.
 * With one robot it is 0. */
wh_vec3_t wh_errors_draw_taught(const wh_errors_t *errors, const wh_trial_t *trial, size_t station,
                                size_t robot);
wh_real_t wh_errors_draw_valve(const wh_errors_t *errors, const wh_trial_t *trial, size_t gripper);
void wh_errors_draw_rim(const wh_errors_t *errors, const wh_trial_t *trial, size_t wafer, const wh_rim_t *rim,
                        double drawn[WH_RIM_DRAWS]);
void wh_errors_draw_beam(const wh_errors_t *errors, const wh_trial_t *trial, size_t beam,
                         double drawn[WH_BEAM_DRAWS]);

/* By how much the station's process is longer, s; 0 if the errors are given. */
wh_real_t wh_errors_draw_process(const wh_errors_t *errors, const wh_trial_t *trial, size_t station);

/* By how much a step of the load port is longer, s; 0 if the errors are given. Steps are below 32. */
wh_real_t wh_errors_draw_port(const wh_errors_t *errors, const wh_trial_t *trial, size_t station,
                              size_t step);
wh_real_t wh_errors_draw_vacuum(const wh_errors_t *errors, const wh_trial_t *trial);
wh_real_t wh_errors_draw_debounce(const wh_errors_t *errors, const wh_trial_t *trial);

/* True if any of it is not 0. */
bool wh_displacement_is_any(const wh_displacement_t *displacement);

/* The names of a station's errors: x, y, z (mm), roll, pitch, yaw (deg); `axis` from 0 to WH_SPREADS - 1. The
 * name is a constant text. All of them, up to a null. */
const char *wh_errors_teaching_name(size_t axis);
extern const char *const wh_errors_teaching_names[];
wh_real_t *wh_displacement_part(wh_displacement_t *displacement, size_t axis);

/* The largest width that is drawn, and the largest error that is given: mm, degrees (a wafer's turn about its
 * own axis: all round), s. */
#define WH_ERRORS_MOST_MM 100
#define WH_ERRORS_MOST_DEG 45
#define WH_ERRORS_MOST_TURN_DEG 180
#define WH_ERRORS_MOST_S 1
#define WH_ERRORS_MOST_PROCESS_S 3600

#endif
