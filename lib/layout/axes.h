/* The axes of a layout's robot by name, as commands, tables and files have them.
 *
 * `axis` is below wh_machine_robot_axes, unless a function says otherwise. All functions are reentrant.
 */
#ifndef WH_LAYOUT_AXES_H
#define WH_LAYOUT_AXES_H

#include "layout.h"

/* Its name: theta, r (of a SCARA forearm), z, yaw, rail, tilt_x, tilt_y, flip; of a second arm r2, of a
 * second wrist yaw2. */
const char *wh_axis_name(const wh_machine_t *machine, size_t axis);

/* True if it turns (rad), false if it shifts (mm). */
bool wh_axis_turns(const wh_machine_t *machine, size_t axis);

/* False for the yaw of an arm without a wrist, which stands at 0. */
bool wh_axis_exists(const wh_machine_t *machine, size_t axis);

/* True if the robot is of kind "SCARA". */
bool wh_layout_is_scara(const wh_layout_t *layout, size_t robot);

/* How far a robot's end-effector comes from theta's axis at least and at most, mm. */
wh_travel_t wh_axis_reach(const wh_machine_t *machine, size_t robot);

/* Like wh_axis_turns, for any axis of the machine: true for a chuck, false for an axis that moves a stage,
 * pins or a door. It is also true for an unknown axis (axes_untold): curves are then fine enough for either
 * unit. */
bool wh_layout_axis_turns(const wh_layout_t *layout, size_t axis);

/* Its unit in recordings, "rad" or "mm"; null: the layout was not told which. Any axis of the machine. */
const char *wh_layout_axis_unit(const wh_layout_t *layout, size_t axis);

/* Its name in tables, pages and recordings: R and Z of the usual robot have capitals. Any axis of the
 * machine. The name of an axis beside a robot is its gripper's name with the word chuck, stage x, stage y,
 * pins or flipper. A door's axis has the door's name with the word door. With several robots the robot's name
 * comes first. An unknown axis is axis 1, axis 2 and so on, by its place in a command. */
void wh_layout_name_axis(const wh_layout_t *layout, size_t axis, char *name, size_t size);

/* Its name as commands have it, wh_axis_name; with several robots wh_layout_name_axis. Returns `name` or a
 * constant. `axis` belongs to a robot. */
const char *wh_layout_axis_label(const wh_layout_t *layout, size_t axis, char *name, size_t size);

/* Says why something is for the usual robot alone: the end of a sentence, such as `a robot of kind "TRZY"
 * ...`. */
#define WH_AXES_USUAL "a robot of kind \"TRZY\" at base's origin, without rail, tilt and flip"

/* The text for one of several robots. */
#define WH_AXES_USUAL_OF_SEVERAL "a robot of kind \"TRZY\" without rail, tilt and flip"

#endif
