#include "track.h"

#include "../grasp/grasp.h"

#define MAX_SLICE_US 1000000
#define MAX_SECONDS WH_REAL(1e6)

/* Relative error of a time in seconds that was counted in slices: three roundings. */
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
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        track->axes[axis] = machine->robot.home[axis];
    }
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        track->valves[g] = WH_VALVE_CLOSED;
    }
    track->segment = wh_track_blank(track);
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
    for (size_t axis = 0; axis < WH_AXES; ++axis) {
        segment.target[axis] = track->axes[axis];
    }
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        segment.valves[g] = WH_NONE;
    }
    return segment;
}

/* The least number of whole slices that last at least `seconds`, which are at most MAX_SECONDS: 1e12 slices.
 * A number that is above a whole one by rounding alone is that whole one: 2.007 s are 2007 ms, not 2008. */
static int64_t slices_for(const wh_track_t *track, wh_real_t seconds) {
    const wh_real_t exact = seconds * WH_REAL(1e6) / (wh_real_t)track->slice_us;
    const int64_t whole = (int64_t)exact;
    return exact - (wh_real_t)whole > ROUNDING * exact ? whole + 1 : whole;
}

/* Time since the segment began. Its last slice is at its end exactly, however the two were rounded. */
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
    wh_move_t move;
    const wh_status_t status = wh_move_plan(&move, machine->axis_count, track->axes, segment->target, limits);
    if (status == WH_OK && wh_move_duration(&move) > MAX_SECONDS) {
        return WH_STATUS_BAD_SEGMENT;
    }
    if (status == WH_OK) {
        track->plan.move = move;
        track->segment_slices = slices_for(track, wh_move_duration(&move));
    }
    return status;
}

static wh_status_t plan_line(wh_track_t *track, const wh_segment_t *segment) {
    const wh_line_caps_t caps = {segment->speed, segment->acceleration};
    wh_line_t line;
    const wh_status_t status =
        wh_line_plan_capped(&line, &track->machine->robot, track->axes, &segment->travel, &caps);
    if (status == WH_OK && wh_line_duration(&line) > MAX_SECONDS) {
        return WH_STATUS_BAD_SEGMENT;
    }
    if (status == WH_OK) {
        track->plan.line = line;
        track->segment_slices = slices_for(track, wh_line_duration(&line));
    }
    return status == WH_STATUS_OUT_OF_RANGE ? WH_STATUS_BAD_SEGMENT : status;
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

/* Chucks turn in segments of their own. */
static bool chucks_stand(const wh_track_t *track, const wh_segment_t *segment) {
    bool stand = true;
    for (size_t axis = WH_ROBOT_AXES; axis < track->machine->axis_count; ++axis) {
        stand = stand && !(wh_real_abs(segment->target[axis] - track->axes[axis]) > 0);
    }
    return stand;
}

static wh_status_t plan_way(wh_track_t *track, const wh_segment_t *segment) {
    const wh_status_t travel = wh_machine_check_travel(track->machine, segment->target);
    if (travel != WH_OK) {
        return travel;
    }
    if (track->ways == NULL || !chucks_stand(track, segment)) {
        return WH_STATUS_BAD_SEGMENT;
    }
    wh_way_t way;
    const wh_status_t status =
        track->ways->plan(&way, &track->machine->robot, track->axes, segment->target, segment->reach);
    if (status == WH_OK && wh_way_duration(&way) > MAX_SECONDS) {
        return WH_STATUS_BAD_SEGMENT;
    }
    if (status == WH_OK) {
        track->plan.way = way;
        track->segment_slices = slices_for(track, wh_way_duration(&way));
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
    }
    return WH_STATUS_BAD_SEGMENT;
}

wh_status_t wh_track_begin(wh_track_t *track, const wh_segment_t *segment) {
    if (!track || !segment) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    const wh_status_t status = plan(track, segment);
    if (status == WH_OK) {
        track->segment = *segment;
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

/* Sets axes or valves for the slice. A segment that only waits changes nothing. */
static void apply(wh_track_t *track) {
    const wh_segment_kind_t kind = track->segment.kind;
    if (kind == WH_SEGMENT_AXES) {
        wh_move_at(&track->plan.move, segment_time(track, wh_move_duration(&track->plan.move)), track->axes);
    } else if (kind == WH_SEGMENT_LINE) {
        wh_line_at(&track->plan.line, segment_time(track, wh_line_duration(&track->plan.line)), track->axes);
    } else if (kind == WH_SEGMENT_WAY) {
        track->ways->at(&track->plan.way, segment_time(track, wh_way_duration(&track->plan.way)),
                        track->axes);
    } else if (kind == WH_SEGMENT_VALVES) {
        switch_valves(track);
    }
}

static bool sensor_is_on(const wh_track_t *track, uint32_t sensors) {
    return track->segment.kind == WH_SEGMENT_SENSOR && (sensors >> track->segment.gripper & 1U) != 0;
}

wh_track_state_t wh_track_next(wh_track_t *track, uint32_t sensors) {
    if (sensor_is_on(track, sensors)) {
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
    if (track->segment_slice < track->segment_slices) {
        track->segment_slice = track->segment_slices;
        apply(track);
    }
}
