/* A run's cell as a glTF 2.0 scene.
 *
 * Nodes hang on "cell", all of them in base, m: "base" (with the robot's column), obstacles by their names,
 * "station NAME" in the station's frame, "lift", "upper arm", "forearm" and "hand", then grippers, doors and
 * wafers by their names in their own frames. A node's extras tell { kind: "base", "obstacle", "station",
 * "link", "gripper", "door" or "wafer", index: from 0 }. Shapes are those that the collision check has
 * (layout/shapes.h); wafers have their notch. The nodes stand as before the run; with `animated` an animation
 * "run" moves them, wafers too, to within 0.05 mm and what the signals are off; links to within 0.5 mm.
 */
#ifndef WH_VIEW_SCENE_H
#define WH_VIEW_SCENE_H

#include <jansson.h>

#include "../record/signals.h"

/* The scene, to be released by the caller. Ends the program if out of memory. */
json_t *wh_scene_make(const wh_signals_t *signals, const char *name, bool animated);

#endif
