#include "doors.h"

wh_status_t wh_layout_give_doors(const wh_layout_t *layout, wh_simulator_t *simulator) {
    const wh_door_set_t set = wh_door_set(&layout->machine);
    return set.count > 0 ? wh_simulator_set_doors(simulator, &set) : WH_OK;
}

void wh_layout_place_doors(const wh_layout_t *layout, const wh_doors_t *doors, const wh_real_t axes[],
                           wh_pose_t base_from_door[WH_DOORS]) {
    const wh_machine_t *machine = &layout->machine;
    for (size_t d = 0; d < machine->door_count; ++d) {
        wh_real_t at = wh_door_home(&machine->doors[d]);
        if (doors && d < (size_t)doors->count) {
            at = doors->at[d];
        } else if (axes) {
            at = axes[wh_machine_door_axis(machine, d)];
        }
        base_from_door[d] = wh_door_pose(&machine->doors[d], at);
    }
}
