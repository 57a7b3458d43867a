/* A run's cell as a glTF 2.0 scene.
 *
 * Nodes hang on "cell", all of them in base, m: "base" (with the robot's column), obstacles by their names,
 * "station NAME" in the station's frame, "lift", "upper arm", "forearm" and "hand", then grippers, doors
 * and wafers by their names in their own frames. A node's extras are { kind: "base", "obstacle", "station",
 * "link", "gripper", "door" or "wafer", index: from 0 }. Shapes are those of the collision check
 * (bodies/shapes.h); wafers have their notch. The nodes have their places before the run. With `animated`
 * an animation "run" moves them, also wafers, to within 0.05 mm plus the error of the signals; links to
 * within 0.5 mm.
 */
#ifndef WH_SCENE_SCENE_H
#define WH_SCENE_SCENE_H

#include <jansson.h>

#include "../record/signals.h"

/* The scene, which the caller releases. It ends the program if out of memory. */
json_t *wh_scene_make(const wh_signals_t *signals, const char *name, bool animated);

#endif
