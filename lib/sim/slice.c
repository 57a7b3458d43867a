/* This is separate from simulator.c, so that a firmware that moves its axes without lib/motion does not
 * link it. */
#include "slice.h"

#include <string.h>

void wh_command_from_track(wh_command_t *command, wh_machine_cache_t *cache, const wh_track_t *track) {
    const wh_machine_t *machine = track->machine;
    if (track->mark != WH_TRACK_MARK) {
        return;
    }
    command->utime = track->slice * track->slice_us;
    command->seq = track->slice;
    command->gripper_count = machine->gripper_count;
    command->axis_count = machine->axis_count;
    wh_machine_update(machine, track->axes, cache, command->grippers);
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        command->grippers[g].valve = track->valves[g];
    }
    memcpy(command->axes, track->axes, sizeof command->axes);
}
