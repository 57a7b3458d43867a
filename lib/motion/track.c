#include "track.h"

#include <string.h>

#include "../grasp/grasp.h"

#define MAX_SLICE_US 1000000
#define MAX_SECONDS WH_REAL(1e6)

/* The relative error of a time in seconds that was counted in slices: three roundings. */
#if defined(WH_FLOAT)
#define ROUNDING (4 * FLT_EPSILON)
#else
#define ROUNDING (4 * DBL_EPSILON)
#endif

wh_status_t wh_track_init(wh_track_t *track, const wh_machine_t *machine, int64_t slice_us) {
    if (!track) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    const wh_status_t status = wh_machine_validate(machine);
    if (status != WH_OK) {
        return status;
    }
    if (slice_us < 1 || slice_us > MAX_SLICE_US) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    static const wh_track_t fresh = {.slice = 0};
    *track = fresh;
    track->machine = machine;
    track->slice_us = slice_us;
    wh_machine_home(machine, track->axes);
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        track->valves[g] = WH_VALVE_CLOSED;
    }
    track->segment = wh_track_blank(track);
    track->mark = WH_TRACK_MARK;
    return WH_OK;
}

wh_segment_t wh_track_blank(const wh_track_t *track) {
    wh_segment_t segment;
    segment.kind = WH_SEGMENT_DWELL;
    segment.travel = wh_vec3(0, 0, 0);
    segment.speed = 0;
    segment.acceleration = 0;
    segment.seconds = 0;
    segment.gripper = WH_NONE;
    segment.reach = 0;
    segment.reach2 = 0;
    segment.points = NULL;
    segment.point_count = 0;
    for (size_t axis = 0; axis < WH_AXES; ++axis) {
        segment.target[axis] = track->axes[axis];
    }
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        segment.valves[g] = WH_NONE;
    }
    return segment;
}

/* The least number of whole slices that last at least `seconds`, which are at most MAX_SECONDS: 1e12
 * slices. A number that exceeds a whole one by rounding alone counts as that whole one: 2.007 s are 2007
 * ms, not 2008. */
static int64_t slices_for(const wh_track_t *track, wh_real_t seconds) {
    const wh_real_t exact = seconds * WH_REAL(1e6) / (wh_real_t)track->slice_us;
    const int64_t whole = (int64_t)exact;
    return exact - (wh_real_t)whole > ROUNDING * exact ? whole + 1 : whole;
}

/* Time since the segment began. Its last slice is exactly at its end, however the two were rounded. */
static wh_real_t segment_time(const wh_track_t *track, wh_real_t duration) {
    if (track->segment_slice == track->segment_slices) {
        return duration;
    }
    return (wh_real_t)(track->segment_slice * track->slice_us) / WH_REAL(1e6);
}

static wh_status_t plan_axes(wh_track_t *track, const wh_segment_t *segment) {
    const wh_machine_t *machine = track->machine;
    wh_limits_t limits[WH_AXES];
    const wh_status_t travel = wh_machine_check_travel(machine, segment->target);
    if (travel != WH_OK) {
        return travel;
    }
    for (size_t axis = 0; axis < machine->axis_count; ++axis) {
        limits[axis] = *wh_machine_limits(machine, axis);
    }
    wh_move_t *move = &track->plan.move;
    const wh_status_t status =
        wh_move_plan_within(move, machine->axis_count, track->axes, segment->target, limits, MAX_SECONDS);
    if (status == WH_OK) {
        track->segment_slices = slices_for(track, wh_move_duration(move));
    }
    return status;
}

/* Takes a line of `seconds`, unless planning refused it. */
static wh_status_t take_line(wh_track_t *track, wh_status_t status, wh_real_t seconds) {
    if (status == WH_OK && seconds > MAX_SECONDS) {
        return WH_STATUS_BAD_SEGMENT;
    }
    if (status == WH_OK) {
        track->segment_slices = slices_for(track, seconds);
    }
    return status == WH_STATUS_OUT_OF_RANGE ? WH_STATUS_BAD_SEGMENT : status;
}

/* The robot that moves in a LINE or a WAY; SIZE_MAX: none. */
static size_t robot_of(const wh_machine_t *machine, const wh_segment_t *segment) {
    const wh_carrier_t *carrier = machine->carrier;
    if (!carrier || !(carrier->next || carrier->second) || segment->gripper == WH_NONE) {
        return 0;
    }
    const bool is_one = segment->gripper >= 0 && (size_t)segment->gripper < machine->gripper_count &&
                        machine->mounts[segment->gripper].axis == WH_NONE;
    return is_one ? machine->mounts[segment->gripper].robot : SIZE_MAX;
}

/* The arm that moves in a LINE; null: none. */
static const wh_carrier_t *arm_of(const wh_machine_t *machine, const wh_segment_t *segment, size_t *first) {
    const size_t robot = robot_of(machine, segment);
    if (robot == SIZE_MAX) {
        return NULL;
    }
    const wh_carrier_t *carrier = wh_machine_carrier(machine, robot, first);
    const bool is_second = segment->gripper != WH_NONE && carrier->second;
    return is_second ? wh_machine_arm(machine, (size_t)segment->gripper, first) : carrier;
}

static wh_status_t plan_carriers_line(wh_track_t *track, const wh_segment_t *segment,
                                      const wh_line_caps_t *caps) {
    size_t first;
    const wh_carrier_t *carrier = arm_of(track->machine, segment, &first);
    if (!carrier) {
        return WH_STATUS_BAD_SEGMENT;
    }
    wh_chain_line_t line;
    wh_status_t status = carrier->plan_line(carrier, &line, &track->axes[first], &segment->travel, caps);
    status = take_line(track, status, status == WH_OK ? wh_chain_line_duration(&line) : 0);
    if (status == WH_OK) {
        track->plan.chain_line = line;
    }
    return status;
}

static wh_status_t plan_line(wh_track_t *track, const wh_segment_t *segment) {
    const wh_line_caps_t caps = {segment->speed, segment->acceleration};
    if (track->machine->carrier) {
        return plan_carriers_line(track, segment, &caps);
    }
    wh_line_t line;
    wh_status_t status =
        wh_line_plan_capped(&line, &track->machine->robot, track->axes, &segment->travel, &caps);
    status = take_line(track, status, status == WH_OK ? wh_line_duration(&line) : 0);
    if (status == WH_OK) {
        track->plan.line = line;
    }
    return status;
}

static bool valve_is_sound(int32_t valve) {
    return valve == WH_NONE || valve == WH_VALVE_OPEN || valve == WH_VALVE_CLOSED;
}

static wh_status_t plan_valves(wh_track_t *track, const wh_segment_t *segment) {
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        const bool absent = g >= track->machine->gripper_count;
        if (!valve_is_sound(segment->valves[g]) || (absent && segment->valves[g] != WH_NONE)) {
            return WH_STATUS_BAD_SEGMENT;
        }
    }
    track->segment_slices = 1;
    return WH_OK;
}

static wh_status_t plan_wait(wh_track_t *track, const wh_segment_t *segment) {
    const bool awaits = segment->kind == WH_SEGMENT_SENSOR;
    if (!wh_real_is_finite(segment->seconds)) {
        return WH_STATUS_NOT_FINITE;
    }
    if (segment->seconds < 0 || segment->seconds > MAX_SECONDS ||
        (awaits && (segment->gripper < 0 || (size_t)segment->gripper >= track->machine->gripper_count))) {
        return WH_STATUS_BAD_SEGMENT;
    }
    track->segment_slices = slices_for(track, segment->seconds);
    return WH_OK;
}

/* A robot's axes as ways use them, beginning at `first`. A second arm's R is the last one. */
static void take_robot(const wh_machine_t *machine, size_t number, wh_polar_t *robot, size_t *first) {
    const wh_carrier_t *carrier = wh_machine_carrier(machine, number, first);
    *robot = wh_polar_from_robot(&machine->robot);
    if (!carrier) {
        return;
    }
    robot->axis_count = carrier->axis_count;
    for (size_t own = 0; own < carrier->axis_count; ++own) {
        robot->limits[own] = *wh_machine_limits(machine, *first + own);
        robot->rail = carrier->axes[own] == WH_CHAIN_RAIL ? own : robot->rail;
    }
    const bool has_elbow = carrier->chain.kind == WH_CHAIN_SCARA;
    robot->second = carrier->second && !has_elbow ? carrier->axis_count - 1 : 0;
    robot->inner[0] = carrier->chain.travel[WH_CHAIN_REACH].min;
    robot->inner[1] = robot->inner[0];
    robot->links[0] = has_elbow ? carrier->chain.links[0] : 0;
    robot->links[1] = has_elbow ? carrier->chain.links[1] : 0;
}

/* A way, with or without via points, moves the axes of one robot; chucks and other robots move in segments
 * of their own. */
static bool goes_ways(const wh_track_t *track, const wh_segment_t *segment, wh_polar_t *robot,
                      size_t *first) {
    const size_t number = robot_of(track->machine, segment);
    if (number == SIZE_MAX) {
        return false;
    }
    take_robot(track->machine, number, robot, first);
    bool fits = true;
    for (size_t axis = 0; axis < track->machine->axis_count; ++axis) {
        const bool is_its = axis >= *first && axis < *first + robot->axis_count;
        fits = fits && (is_its || !(wh_real_abs(segment->target[axis] - track->axes[axis]) > 0));
    }
    return fits;
}

static wh_status_t plan_way(wh_track_t *track, const wh_segment_t *segment) {
    const wh_status_t travel = wh_machine_check_travel(track->machine, segment->target);
    wh_polar_t robot;
    size_t first = 0;
    if (travel != WH_OK) {
        return travel;
    }
    if (!track->ways || !goes_ways(track, segment, &robot, &first)) {
        return WH_STATUS_BAD_SEGMENT;
    }
    const wh_real_t reach[WH_POLAR_ARMS] = {segment->reach, segment->reach2};
    wh_way_t way;
    const wh_status_t status =
        track->ways->plan(&way, &robot, &track->axes[first], &segment->target[first], reach);
    if (status == WH_STATUS_OUT_OF_RANGE || (status == WH_OK && wh_way_duration(&way) > MAX_SECONDS)) {
        return WH_STATUS_BAD_SEGMENT;
    }
    if (status == WH_OK) {
        track->plan.way = way;
        track->segment_slices = slices_for(track, wh_way_duration(&way));
    }
    return status;
}

/* Each point must be allowed for the robot's axes, which are `count` from `first` on. */
static wh_status_t check_points(const wh_track_t *track, const wh_segment_t *segment, size_t first,
                                size_t count) {
    wh_real_t axes[WH_AXES];
    wh_status_t status = wh_machine_check_travel(track->machine, segment->target);
    memcpy(axes, track->axes, sizeof axes);
    for (size_t i = 0; status == WH_OK && i < segment->point_count; ++i) {
        memcpy(&axes[first], segment->points[i].q, count * sizeof axes[0]);
        status = wh_machine_check_travel(track->machine, axes);
    }
    return status;
}

static wh_status_t plan_via(wh_track_t *track, const wh_segment_t *segment) {
    wh_polar_t robot;
    size_t first = 0;
    if (!track->vias || !segment->points || !goes_ways(track, segment, &robot, &first)) {
        return WH_STATUS_BAD_SEGMENT;
    }
    wh_status_t status = check_points(track, segment, first, robot.axis_count);
    if (status != WH_OK) {
        return status;
    }
    wh_via_t via;
    status = track->vias->plan(&via, &robot, &track->axes[first], segment->points, segment->point_count,
                               &segment->target[first]);
    if (status == WH_STATUS_OUT_OF_RANGE || (status == WH_OK && wh_via_duration(&via) > MAX_SECONDS)) {
        return WH_STATUS_BAD_SEGMENT;
    }
    if (status == WH_OK) {
        track->plan.via = via;
        track->segment_slices = slices_for(track, wh_via_duration(&via));
    }
    return status;
}

static wh_status_t plan(wh_track_t *track, const wh_segment_t *segment) {
    switch (segment->kind) {
    case WH_SEGMENT_AXES:
        return plan_axes(track, segment);
    case WH_SEGMENT_LINE:
        return plan_line(track, segment);
    case WH_SEGMENT_VALVES:
        return plan_valves(track, segment);
    case WH_SEGMENT_DWELL:
    case WH_SEGMENT_SENSOR:
        return plan_wait(track, segment);
    case WH_SEGMENT_WAY:
        return plan_way(track, segment);
    case WH_SEGMENT_VIA:
        return plan_via(track, segment);
    }
    return WH_STATUS_BAD_SEGMENT;
}

wh_status_t wh_track_begin(wh_track_t *track, const wh_segment_t *segment) {
    if (!track || !segment) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (track->mark != WH_TRACK_MARK) {
        return WH_STATUS_NOT_INITIALISED;
    }
    const wh_status_t status = plan(track, segment);
    if (status == WH_OK) {
        track->segment = *segment;
        track->segment.points = NULL;
        track->segment_slice = 0;
    }
    return status;
}

static void switch_valves(wh_track_t *track) {
    for (size_t g = 0; g < track->machine->gripper_count; ++g) {
        const int32_t valve = track->segment.valves[g];
        track->valves[g] = valve == WH_NONE ? track->valves[g] : valve;
    }
}

static WH_OUT_OF_LINE void place_on_carriers_line(const wh_track_t *track, wh_real_t t, wh_real_t axes[]) {
    size_t first = 0;
    const wh_carrier_t *carrier = arm_of(track->machine, &track->segment, &first);
    carrier->line_at(carrier, &track->plan.chain_line, t, &axes[first]);
}

static void place_on_line(const wh_track_t *track, wh_real_t t, wh_real_t axes[]) {
    if (track->machine->carrier) {
        place_on_carriers_line(track, t, axes);
    } else {
        wh_line_at(&track->plan.line, t, axes);
    }
}

static WH_OUT_OF_LINE void place_on_way(const wh_track_t *track, wh_real_t t, wh_real_t axes[]) {
    size_t first;
    (void)wh_machine_carrier(track->machine, robot_of(track->machine, &track->segment), &first);
    track->ways->at(&track->plan.way, t, &axes[first]);
}

static WH_OUT_OF_LINE void place_on_via(const wh_track_t *track, wh_real_t t, wh_real_t axes[]) {
    size_t first;
    (void)wh_machine_carrier(track->machine, robot_of(track->machine, &track->segment), &first);
    track->vias->at(&track->plan.via, t, &axes[first]);
}

wh_real_t wh_track_seconds(const wh_track_t *track) {
    switch (track->segment.kind) {
    case WH_SEGMENT_AXES:
        return wh_move_duration(&track->plan.move);
    case WH_SEGMENT_LINE:
        return track->machine->carrier ? wh_chain_line_duration(&track->plan.chain_line)
                                       : wh_line_duration(&track->plan.line);
    case WH_SEGMENT_WAY:
        return wh_way_duration(&track->plan.way);
    case WH_SEGMENT_VIA:
        return wh_via_duration(&track->plan.via);
    case WH_SEGMENT_VALVES:
    case WH_SEGMENT_DWELL:
    case WH_SEGMENT_SENSOR:
        break;
    }
    return 0;
}

void wh_track_place(const wh_track_t *track, wh_real_t seconds, wh_real_t axes[WH_AXES]) {
    const wh_segment_kind_t kind = track->segment.kind;
    if (kind == WH_SEGMENT_AXES) {
        wh_move_at(&track->plan.move, seconds, axes);
    } else if (kind == WH_SEGMENT_LINE) {
        place_on_line(track, seconds, axes);
    } else if (kind == WH_SEGMENT_WAY) {
        place_on_way(track, seconds, axes);
    } else if (kind == WH_SEGMENT_VIA) {
        place_on_via(track, seconds, axes);
    }
}

/* Sets axes or valves for the slice. A segment that only waits changes nothing. */
static void apply(wh_track_t *track) {
    if (track->segment.kind == WH_SEGMENT_VALVES) {
        switch_valves(track);
    } else {
        wh_track_place(track, segment_time(track, wh_track_seconds(track)), track->axes);
    }
}

static bool sensor_is_on(const wh_track_t *track, uint32_t sensors) {
    return track->segment.kind == WH_SEGMENT_SENSOR && (sensors >> track->segment.gripper & 1U) != 0;
}

wh_track_state_t wh_track_next(wh_track_t *track, uint32_t sensors) {
    if (track->mark != WH_TRACK_MARK || sensor_is_on(track, sensors)) {
        return WH_TRACK_DONE;
    }
    if (track->segment_slice >= track->segment_slices) {
        return track->segment.kind == WH_SEGMENT_SENSOR ? WH_TRACK_TIMED_OUT : WH_TRACK_DONE;
    }
    ++track->segment_slice;
    ++track->slice;
    apply(track);
    return WH_TRACK_MOVING;
}

void wh_track_skip(wh_track_t *track) {
    if (track->mark == WH_TRACK_MARK && track->segment_slice < track->segment_slices) {
        track->segment_slice = track->segment_slices;
        apply(track);
    }
}
