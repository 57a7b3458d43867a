/* A layout's doors in a simulator, and where their walls are. */
#ifndef WH_LAYOUT_DOORS_H
#define WH_LAYOUT_DOORS_H

#include "../sim/simulator.h"
#include "layout.h"

/* wh_simulator_set_doors for a simulator that was just set up with the layout's physics. Without doors it
 * does nothing. */
wh_status_t wh_layout_give_doors(const wh_layout_t *layout, wh_simulator_t *simulator);

/* base_from_door of each of the layout's doors: where the state says that they are; without it (null, or a
 * state that has none) where the machine's axes say; without both at home. */
void wh_layout_place_doors(const wh_layout_t *layout, const wh_doors_t *doors, const wh_real_t axes[],
                           wh_pose_t base_from_door[WH_DOORS]);

#endif
