#include "ramp.h"

#include <string.h>

/* Differences of three orders: of speed, acceleration and jerk. */
#define ORDERS 3
/* How much more than the planned motion a ramp may have of each, and what rounding alone makes, mm or rad. */
#define MARGIN WH_REAL(1e-3)
#define NOISE WH_REAL(2e-11)
/* Differences are measured over at least this time, us: rounding counts for little then; and in at most so
 * many steps of a segment. */
#define LEAST_US 1000
#define MOST_STEPS 20000
/* A ramp begins at the latest so long after the STOP, s; and it is tried each so many seconds. */
#define LATEST WH_REAL(0.6)
#define STEP WH_REAL(0.01)
/* The length of a ramp is found to this part. */
#define HALVINGS 8

/* The last places of all axes, and the largest differences. */
typedef struct {
    size_t count;   /* axes */
    int64_t stride; /* slices of a step */
    wh_real_t last[ORDERS + 1][WH_AXES];
    wh_real_t most[ORDERS][WH_AXES];
} course_t;

static void begin_course(course_t *course, size_t count, int64_t stride, const wh_real_t at[WH_AXES]) {
    memset(course, 0, sizeof *course);
    course->count = count;
    course->stride = stride;
    memcpy(course->last[0], at, count * sizeof at[0]);
}

/* Takes the axes of the next step. */
static void go_on(course_t *course, const wh_real_t at[WH_AXES]) {
    for (size_t axis = 0; axis < course->count; ++axis) {
        wh_real_t now = at[axis];
        for (size_t order = 0; order <= ORDERS; ++order) {
            const wh_real_t last = course->last[order][axis];
            course->last[order][axis] = now;
            if (order > 0) {
                wh_real_t *most = &course->most[order - 1][axis];
                *most = wh_real_max(*most, wh_real_abs(now));
            }
            now -= last;
        }
    }
}

static bool is_within(const course_t *course, const course_t *planned) {
    for (size_t order = 0; order < ORDERS; ++order) {
        for (size_t axis = 0; axis < course->count; ++axis) {
            if (course->most[order][axis] > planned->most[order][axis] * (1 + MARGIN) + NOISE) {
                return false;
            }
        }
    }
    return true;
}

static wh_real_t slice_of(const wh_track_t *track) {
    return (wh_real_t)track->slice_us / WH_REAL(1e6);
}

/* The differences of the whole segment, from rest to rest. */
static void see_segment(course_t *planned, const wh_track_t *track) {
    const wh_real_t dt = slice_of(track);
    const int64_t fine = (LEAST_US + track->slice_us - 1) / track->slice_us;
    const int64_t coarse = track->segment_slices / MOST_STEPS + 1;
    const int64_t stride = fine > coarse ? fine : coarse;
    wh_real_t axes[WH_AXES];
    memcpy(axes, track->axes, sizeof axes);
    wh_track_place(track, 0, axes);
    begin_course(planned, track->machine->axis_count, stride, axes);
    for (int64_t i = stride; i <= track->segment_slices + ORDERS * stride; i += stride) {
        wh_track_place(track, (wh_real_t)i * dt, axes);
        go_on(planned, axes);
    }
}

/* The limit of an axis of that order, as a difference over a step. */
static wh_real_t limit_of(const wh_track_t *track, size_t axis, size_t order, wh_real_t step) {
    const wh_limits_t *limits = wh_machine_limits(track->machine, axis);
    if (order == 0) {
        return limits->speed * step;
    }
    return order == 1 ? limits->acceleration * step * step : limits->jerk * step * step * step;
}

/* One axis at least goes as near to its limits as the motion may: so near may all of them go. */
static void allow_limits(course_t *planned, const wh_track_t *track) {
    const wh_real_t step = (wh_real_t)planned->stride * slice_of(track);
    for (size_t order = 0; order < ORDERS; ++order) {
        wh_real_t part = 0;
        for (size_t axis = 0; axis < planned->count; ++axis) {
            part = wh_real_max(part, planned->most[order][axis] / limit_of(track, axis, order, step));
        }
        for (size_t axis = 0; axis < planned->count; ++axis) {
            wh_real_t *most = &planned->most[order][axis];
            *most = wh_real_max(*most, part * limit_of(track, axis, order, step));
        }
    }
}

/* How far the segment has come `slice` slices after the STOP, s. The rate falls by 3 x^2 - 2 x^3. */
static wh_real_t time_at(const wh_ramp_t *ramp, wh_real_t dt, int64_t slice) {
    if (slice <= ramp->delay || ramp->slices == 0) {
        return ramp->begin + (wh_real_t)slice * dt;
    }
    const wh_real_t length = (wh_real_t)ramp->slices * dt;
    const int64_t gone = slice - ramp->delay < ramp->slices ? slice - ramp->delay : ramp->slices;
    const wh_real_t x = (wh_real_t)gone / (wh_real_t)ramp->slices;
    return ramp->begin + (wh_real_t)ramp->delay * dt + length * x * (1 - x * x + x * x * x / 2);
}

/* True if the ramp is as smooth as the planned motion. It is looked at from some slices before it on. */
static bool is_smooth(const wh_ramp_t *ramp, const wh_track_t *track, const course_t *planned) {
    const wh_real_t dt = slice_of(track);
    wh_real_t axes[WH_AXES];
    course_t course;
    memcpy(axes, track->axes, sizeof axes);
    const int64_t stride = planned->stride;
    const int64_t first = ramp->delay - (ORDERS + 1) * stride;
    wh_track_place(track, time_at(ramp, dt, first), axes);
    begin_course(&course, planned->count, stride, axes);
    for (int64_t i = first + stride; i < ramp->delay + ramp->slices + (ORDERS + 1) * stride; i += stride) {
        wh_track_place(track, time_at(ramp, dt, i), axes);
        go_on(&course, axes);
        if (i < ramp->delay - stride) { /* differences across the first place are none */
            memset(course.most, 0, sizeof course.most);
        }
        if (!is_within(&course, planned)) {
            return false;
        }
    }
    return true;
}

/* The shortest ramp of at most `most` slices with this delay. False: none is smooth. */
static bool find_shortest(wh_ramp_t *ramp, const wh_track_t *track, const course_t *planned, int64_t most) {
    ramp->slices = most;
    if (most < 1 || !is_smooth(ramp, track, planned)) {
        return false;
    }
    int64_t least = 0;
    for (int i = 0; i < HALVINGS && most - least > 1; ++i) {
        ramp->slices = least + (most - least) / 2;
        const bool fits = is_smooth(ramp, track, planned);
        most = fits ? ramp->slices : most;
        least = fits ? least : ramp->slices;
    }
    ramp->slices = most;
    return true;
}

bool wh_ramp_begin(wh_ramp_t *ramp, const wh_track_t *track, bool as_planned) {
    const wh_real_t seconds = wh_track_seconds(track);
    const wh_real_t dt = slice_of(track);
    const int64_t rest = track->segment_slices - track->segment_slice;
    const int64_t step = (int64_t)(STEP / dt) > 1 ? (int64_t)(STEP / dt) : 1;
    course_t planned;
    memset(ramp, 0, sizeof *ramp);
    if (seconds <= 0 || rest <= 0 || track->segment_slice == 0) {
        return false;
    }
    ramp->is_on = true;
    ramp->begin = (wh_real_t)track->segment_slice * dt;
    see_segment(&planned, track);
    if (!as_planned) {
        allow_limits(&planned, track);
    }
    for (ramp->delay = 0; (wh_real_t)ramp->delay * dt <= LATEST && ramp->delay < rest; ramp->delay += step) {
        if (find_shortest(ramp, track, &planned, rest - ramp->delay)) {
            return true;
        }
    }
    ramp->delay = 0;
    ramp->slices = 0;
    return true;
}

bool wh_ramp_next(wh_ramp_t *ramp, wh_track_t *track) {
    const int64_t rest = track->segment_slices - track->segment_slice;
    const int64_t slices = ramp->slices > 0 ? ramp->delay + ramp->slices : rest;
    if (ramp->played >= slices) {
        return false;
    }
    ++ramp->played;
    ++track->slice;
    wh_track_place(track, time_at(ramp, slice_of(track), ramp->played), track->axes);
    return true;
}
