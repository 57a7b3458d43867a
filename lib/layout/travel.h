/* How far axes go, and in words why they may not: for the errors OUT_OF_REACH and LIMIT_EXCEEDED.
 *
 * The words name each axis that would leave its travel, the value it would reach, its travel, and the place:
 * "r: 200 (expected 300 to 900 mm) with EE at x 200.000, y 0.000, z 897.000 mm". The library itself judges
 * each axis alone, and the words follow its answer.
 *
 * Lengths in mm, angles in rad; in the words angles are in degrees. All functions are reentrant and allocate
 * nothing.
 */
#ifndef WH_LAYOUT_TRAVEL_H
#define WH_LAYOUT_TRAVEL_H

#include "../motion/line.h"
#include "layout.h"

/* The longest text, with its terminator. Text that does not fit is left out. */
#define WH_TRAVEL_BYTES 400

/* R is least between the ends of a line that passes base's axis; all else runs one way. False, *least_R
 * unchanged, if this line does not pass it. */
bool wh_travel_passes_axis(const wh_line_t *line, wh_real_t *least_R);

/* Says why the axes may not stand there: axes[0 .. machine.axis_count - 1]. Empty if they may. A chuck has
 * its gripper's name. Cost: linear in the axes. */
void wh_travel_say_axes(const wh_layout_t *layout, const wh_real_t axes[], char text[WH_TRAVEL_BYTES]);

/* Where a gripper on the robot shall go: to the point `at`, level, with its x along `heading`; or, with a
 * machine's carrier, to a pose. */
typedef struct {
    size_t gripper;
    wh_vec3_t at;
    wh_real_t heading;
    const wh_pose_t *pose;           /* base_from_gripper; null: at and heading count */
    const wh_chain_choice_t *choice; /* with a pose */
} wh_travel_goal_t;

/* The axes for it, coming from near_q: wh_machine_inverse or wh_machine_bring. */
wh_status_t wh_travel_find(const wh_layout_t *layout, const wh_travel_goal_t *goal, const wh_real_t near_q[],
                           wh_real_t q[]);

/* Says why it may not be brought there, if wh_travel_find refuses it. Empty if it may, or if a number is not
 * finite. Cost: some microseconds. */
void wh_travel_say_point(const wh_layout_t *layout, const wh_travel_goal_t *goal, const wh_real_t near_q[],
                         char text[WH_TRAVEL_BYTES]);

/* Why the end-effector that carries this gripper (WH_NONE: the first) may not go by `travel` from these axes
 * in a straight line, and after how many mm an axis leaves its travel, if wh_line_plan or wh_chain_line_plan
 * refuses the line. Empty if it may, or if a number is not finite. Cost: some 100 microseconds; with a SCARA
 * some 10 ms. */
void wh_travel_say_line(const wh_layout_t *layout, int32_t gripper, const wh_real_t from_q[],
                        const wh_vec3_t *travel, char text[WH_TRAVEL_BYTES]);

#endif
