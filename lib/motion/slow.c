#include "slow.h"

static void slow_down(wh_limits_t *limits, const wh_slowness_t *slowness) {
    const wh_real_t pace = slowness->pace;
    limits->speed *= slowness->share.speed * pace;
    limits->acceleration *= slowness->share.acceleration * pace * pace;
    limits->jerk *= slowness->share.acceleration * pace * pace * pace;
}

static wh_carrier_t *copy_arm(wh_slow_t *slow, size_t *used, const wh_carrier_t *carrier,
                              const wh_slowness_t *slowness) {
    wh_carrier_t *copy = &slow->carriers[*used];
    ++*used;
    *copy = *carrier;
    for (size_t axis = 0; axis < WH_CHAIN_AXES; ++axis) {
        slow_down(&copy->chain.limits[axis], slowness);
    }
    return copy;
}

static wh_carrier_t *copy_carrier(wh_slow_t *slow, size_t *used, const wh_carrier_t *carrier,
                                  const wh_slowness_t *slowness) {
    wh_carrier_t *copy = copy_arm(slow, used, carrier, slowness);
    if (carrier->second) {
        copy->second = copy_arm(slow, used, carrier->second, slowness);
    }
    return copy;
}

static void make_slow(wh_slow_t *slow, const wh_machine_t *machine, const wh_slowness_t *slowness) {
    size_t used = 0;
    slow->machine = *machine;
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        slow_down(&slow->machine.robot.limits[axis], slowness);
    }
    slow_down(&slow->machine.chuck_limits, slowness);
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        slow_down(&slow->machine.mounts[g].limits, slowness);
    }
    const wh_carrier_t **link = &slow->machine.carrier;
    for (const wh_carrier_t *carrier = machine->carrier; carrier; carrier = carrier->next) {
        wh_carrier_t *copy = copy_carrier(slow, &used, carrier, slowness);
        *link = copy;
        link = &copy->next;
    }
}

/* False for NaN. */
static bool is_part(wh_real_t part) {
    return part > 0 && part <= 1;
}

wh_status_t wh_track_begin_slowly(wh_track_t *track, const wh_segment_t *segment,
                                  const wh_slowness_t *slowness, wh_slow_t *room) {
    if (!track || !segment || !slowness || !room) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (track->mark != WH_TRACK_MARK) {
        return WH_STATUS_NOT_INITIALISED;
    }
    if (!is_part(slowness->share.speed) || !is_part(slowness->share.acceleration) ||
        !is_part(slowness->pace)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    const wh_machine_t *machine = track->machine;
    make_slow(room, machine, slowness);
    track->machine = &room->machine;
    const wh_status_t status = wh_track_begin(track, segment);
    track->machine = machine;
    return status;
}
