/* Within the layout's check: what its parts share. */
#ifndef WH_LAYOUT_FEASIBILITY_INTERNAL_H
#define WH_LAYOUT_FEASIBILITY_INTERNAL_H

#include "feasibility.h"

/* One more finding; its `parts` are none. */
__attribute__((format(printf, 4, 5))) wh_finding_t *wh_feasibility_add(wh_feasibility_t *check,
                                                                       wh_finding_kind_t kind,
                                                                       int32_t station, const char *format,
                                                                       ...);

/* base_from_gripper with the end-effector level in a slot, heading in. */
wh_pose_t wh_feasibility_entry(const wh_station_t *station, int32_t slot);

/* Looks at each station: reach, and the blade's room. */
void wh_feasibility_reach(wh_feasibility_t *check, size_t station);
void wh_feasibility_room(wh_feasibility_t *check, size_t station);

#endif
