#include "way.h"

#include <string.h>

#include "track.h"

#define POSITIONS 32 /* of the first search */
#define CUTS 24      /* of golden section */
#define HALVINGS 60  /* of a time: less than rounding */

/* What the search compares: a leg in and a leg out by way of an inner position. */
typedef struct {
    wh_profile_t in, out;
    wh_real_t came_in;  /* s after the start, when R is at most `reach` */
    wh_real_t goes_out; /* s after the leg out has begun, when R is at `reach` again */
} legs_t;

/* What is to be found a way for. */
typedef struct {
    const wh_limits_t *limits; /* of R */
    wh_real_t from, to, reach; /* mm */
    wh_real_t turn;            /* s that theta and yaw need at least */
} trip_t;

/* When a profile from `begin` passes `place`, which lies between its ends. */
static wh_real_t time_at(const wh_profile_t *profile, wh_real_t begin, wh_real_t place) {
    const bool rises = profile->distance > 0;
    wh_real_t early = 0;
    wh_real_t late = profile->duration;
    for (int i = 0; i < HALVINGS; ++i) {
        const wh_real_t middle = early + (late - early) / 2;
        if ((begin + wh_profile_position(profile, middle) < place) == rises) {
            early = middle;
        } else {
            late = middle;
        }
    }
    return rises ? early : late;
}

static wh_status_t plan_legs(const trip_t *task, wh_real_t inner, legs_t *legs) {
    wh_status_t status = wh_profile_plan(&legs->in, inner - task->from, task->limits);
    if (status == WH_OK) {
        status = wh_profile_plan(&legs->out, task->to - inner, task->limits);
    }
    if (status == WH_OK) {
        legs->came_in = task->from > task->reach ? time_at(&legs->in, task->from, task->reach) : 0;
        legs->goes_out =
            task->to > task->reach ? time_at(&legs->out, inner, task->reach) : legs->out.duration;
    }
    return status;
}

/* How long R waits at its inner position. */
static wh_real_t wait_of(const trip_t *task, const legs_t *legs) {
    const wh_real_t inside = (legs->in.duration - legs->came_in) + legs->goes_out;
    return task->turn > inside ? task->turn - inside : 0;
}

static wh_real_t duration_of(const trip_t *task, wh_real_t inner, legs_t *legs, wh_status_t *status) {
    if (*status == WH_OK) {
        *status = plan_legs(task, inner, legs);
    }
    return *status == WH_OK ? legs->in.duration + wait_of(task, legs) + legs->out.duration : 0;
}

/* The best inner position so far. */
typedef struct {
    const trip_t *task;
    wh_real_t inner, shortest;
    wh_status_t status;
} inner_t;

/* Returns the duration by way of `inner`. */
static wh_real_t try_inner(inner_t *search, wh_real_t inner) {
    legs_t legs;
    const wh_real_t duration = duration_of(search->task, inner, &legs, &search->status);
    if (duration < search->shortest) {
        search->shortest = duration;
        search->inner = inner;
    }
    return duration;
}

/* An end that is inside already may be the inner position itself. */
static void try_ends(inner_t *search) {
    const trip_t *task = search->task;
    (void)try_inner(search, task->reach);
    if (task->from < task->reach) {
        (void)try_inner(search, task->from);
    }
    if (task->to < task->reach) {
        (void)try_inner(search, task->to);
    }
}

static void try_between(inner_t *search, wh_real_t least, wh_real_t most) {
    const wh_real_t golden = WH_REAL(0.61803398874989484820);
    const wh_real_t apart = (most - least) / POSITIONS;
    for (int i = 0; i < POSITIONS; ++i) {
        (void)try_inner(search, least + apart * (wh_real_t)i);
    }
    wh_real_t low = wh_real_max(search->inner - apart, least);
    wh_real_t high = search->inner + apart < most ? search->inner + apart : most;
    for (int i = 0; i < CUTS; ++i) {
        const wh_real_t a = high - golden * (high - low);
        const wh_real_t b = low + golden * (high - low);
        if (try_inner(search, a) < try_inner(search, b)) {
            high = b;
        } else {
            low = a;
        }
    }
}

static wh_status_t plan_alone(wh_profile_t *profile, const wh_robot_t *robot, const wh_real_t from[],
                              const wh_real_t to[], size_t axis) {
    return wh_profile_plan(profile, to[axis] - from[axis], &robot->limits[axis]);
}

static wh_status_t stretch(wh_profile_t *profile, wh_real_t duration) {
    return duration > profile->duration ? wh_profile_stretch(profile, duration) : WH_OK;
}

/* Theta, yaw and Z as they are alone, and how long the turn takes at least. */
static wh_status_t plan_turn(wh_way_t *way, const wh_robot_t *robot, wh_real_t *turn) {
    wh_status_t status = plan_alone(&way->theta, robot, way->from, way->to, WH_AXIS_THETA);
    if (status == WH_OK) {
        status = plan_alone(&way->yaw, robot, way->from, way->to, WH_AXIS_YAW);
    }
    if (status == WH_OK) {
        status = plan_alone(&way->Z, robot, way->from, way->to, WH_AXIS_Z);
    }
    *turn = status == WH_OK ? wh_real_max(way->theta.duration, way->yaw.duration) : 0;
    return status;
}

/* Completes a way from its legs: R waits for the turn, and for Z. */
static wh_status_t complete(wh_way_t *way, const trip_t *task, const legs_t *legs) {
    const wh_real_t legs_alone = legs->in.duration + legs->out.duration;
    const wh_real_t waits = wh_real_max(wait_of(task, legs), way->Z.duration - legs_alone);
    way->in = legs->in;
    way->out = legs->out;
    way->out_begin = legs->in.duration + wh_real_max(waits, 0);
    way->duration = way->out_begin + legs->out.duration;
    way->turn_begin = legs->came_in;
    const wh_real_t turn_end = way->out_begin + legs->goes_out;
    wh_status_t status = stretch(&way->theta, turn_end - way->turn_begin);
    if (status == WH_OK) {
        status = stretch(&way->yaw, turn_end - way->turn_begin);
    }
    return status == WH_OK ? stretch(&way->Z, way->duration) : status;
}

/* R never leaves the circle: all axes move at once. */
static wh_status_t move_at_once(wh_way_t *way, const wh_robot_t *robot, wh_real_t turn) {
    wh_status_t status = plan_alone(&way->in, robot, way->from, way->to, WH_AXIS_R);
    if (status == WH_OK) {
        way->duration = wh_real_max(wh_real_max(way->in.duration, way->Z.duration), turn);
        way->out_begin = way->duration;
        status = stretch(&way->in, way->duration);
    }
    if (status == WH_OK) {
        status = stretch(&way->theta, way->duration);
    }
    if (status == WH_OK) {
        status = stretch(&way->yaw, way->duration);
    }
    return status == WH_OK ? stretch(&way->Z, way->duration) : status;
}

static wh_status_t go_in_and_out(wh_way_t *way, const wh_robot_t *robot, const trip_t *task) {
    inner_t search = {task, task->reach, (wh_real_t)FLT_MAX, WH_OK};
    const wh_real_t least = robot->travel[WH_AXIS_R].min;
    try_ends(&search);
    try_between(&search, least < task->reach ? least : task->reach, task->reach);
    legs_t legs;
    if (search.status == WH_OK) {
        search.status = plan_legs(task, search.inner, &legs);
    }
    return search.status == WH_OK ? complete(way, task, &legs) : search.status;
}

static wh_status_t check(const wh_way_t *way, const wh_robot_t *robot, const wh_real_t from[],
                         const wh_real_t to[], wh_real_t reach) {
    if (way == NULL || robot == NULL || from == NULL || to == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        if (!wh_real_is_finite(from[axis]) || !wh_real_is_finite(to[axis])) {
            return WH_STATUS_NOT_FINITE;
        }
    }
    if (!wh_real_is_finite(reach)) {
        return WH_STATUS_NOT_FINITE;
    }
    return reach < robot->travel[WH_AXIS_R].min - WH_SLACK_MM ? WH_STATUS_OUT_OF_REACH : WH_OK;
}

wh_status_t wh_way_plan(wh_way_t *way, const wh_robot_t *robot, const wh_real_t from[WH_ROBOT_AXES],
                        const wh_real_t to[WH_ROBOT_AXES], wh_real_t reach) {
    wh_status_t status = check(way, robot, from, to, reach);
    if (status != WH_OK) {
        return status;
    }
    wh_way_t planned;
    memset(&planned, 0, sizeof planned);
    memcpy(planned.from, from, sizeof planned.from);
    memcpy(planned.to, to, sizeof planned.to);
    trip_t task = {&robot->limits[WH_AXIS_R], from[WH_AXIS_R], to[WH_AXIS_R], reach, 0};
    status = plan_turn(&planned, robot, &task.turn);
    if (status == WH_OK) {
        const bool is_inside = task.from <= reach && task.to <= reach;
        status = is_inside ? move_at_once(&planned, robot, task.turn) : go_in_and_out(&planned, robot, &task);
    }
    if (status == WH_OK) {
        *way = planned;
    }
    return status;
}

void wh_way_at(const wh_way_t *way, wh_real_t t, wh_real_t q[WH_ROBOT_AXES]) {
    if (t >= way->duration) {
        memcpy(q, way->to, sizeof way->to);
        return;
    }
    const wh_real_t turned = t - way->turn_begin;
    const bool is_out = t >= way->out_begin;
    q[WH_AXIS_THETA] = way->from[WH_AXIS_THETA] + wh_profile_position(&way->theta, turned);
    q[WH_AXIS_R] = way->from[WH_AXIS_R] + wh_profile_position(&way->in, t) +
                   (is_out ? wh_profile_position(&way->out, t - way->out_begin) : 0);
    q[WH_AXIS_Z] = way->from[WH_AXIS_Z] + wh_profile_position(&way->Z, t);
    q[WH_AXIS_YAW] = way->from[WH_AXIS_YAW] + wh_profile_position(&way->yaw, turned);
}

void wh_track_take_ways(wh_track_t *track) {
    static const wh_ways_t ways = {wh_way_plan, wh_way_at};
    track->ways = &ways;
}
