/* Within the core: near misses and contests, looked at after the picks of a step. */
#ifndef WH_CORE_ENCOUNTER_INTERNAL_H
#define WH_CORE_ENCOUNTER_INTERNAL_H

#include "core/grasp.h"

/* A blank event of the running step, appended to the list for the caller to fill in. There is room: the step
 * has looked. */
wh_event_t *wh_event_append(const wh_grasp_t *table, wh_event_list_t *list, wh_event_kind_t kind);

/* Updates one gripper's approach and contest and reports those that ended. `input` is this slice's, the
 * gripper still has the previous slice's pose and valve. */
void wh_encounter_update(wh_grasp_t *table, size_t gripper, const wh_gripper_input_t *input,
                         wh_event_list_t *list);

#endif
