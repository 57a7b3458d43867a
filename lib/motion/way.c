#include "way.h"

#include <string.h>

#include "track.h"

#define POSITIONS 32 /* of the first search */
#define CUTS 24      /* of golden section */
#define HALVINGS 60  /* of a time: less than rounding */
#define ROUNDS 3     /* of a search for two arms, in turn */

/* The values that the search compares: a leg in and a leg out via an inner position. */
typedef struct {
    wh_profile_t in, out;
    wh_real_t came_in;  /* s after the start, when R is at most `reach` */
    wh_real_t goes_out; /* s after the leg out has begun, when R is at `reach` again */
} legs_t;

/* The arm for which a way is searched. */
typedef struct {
    const wh_limits_t *limits;        /* of its R */
    wh_real_t from, to, reach, least; /* mm */
    wh_real_t turn;                   /* s: the least time of the turning axes */
    wh_real_t others_in;   /* s after the start, when the other arm has come in; 0: there is no other arm */
    wh_real_t others_tail; /* s from when the other arm leaves the circle to its end */
} trip_t;

/* The time at which a profile from `begin` passes `place`, which lies between its ends. */
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

/* The duration of the turn from when the arm is in; it also waits for the other arm. */
static wh_real_t turn_of(const trip_t *task, const legs_t *legs) {
    return task->turn + (wh_real_max(legs->came_in, task->others_in) - legs->came_in);
}

/* The time that R waits at its inner position. */
static wh_real_t wait_of(const trip_t *task, const legs_t *legs) {
    const wh_real_t inside = (legs->in.duration - legs->came_in) + legs->goes_out;
    const wh_real_t turn = turn_of(task, legs);
    return turn > inside ? turn - inside : 0;
}

/* The duration of the arm's way; if the other arm moves out, until that one is at its end, too. */
static wh_real_t lasts(const trip_t *task, const legs_t *legs) {
    const wh_real_t own = legs->in.duration + wait_of(task, legs) + legs->out.duration;
    if (task->others_tail > 0) {
        return wh_real_max(own, legs->came_in + turn_of(task, legs) + task->others_tail);
    }
    return own;
}

static wh_real_t duration_of(const trip_t *task, wh_real_t inner, legs_t *legs, wh_status_t *status) {
    if (*status == WH_OK) {
        *status = plan_legs(task, inner, legs);
    }
    return *status == WH_OK ? lasts(task, legs) : 0;
}

/* The best inner position so far. */
typedef struct {
    const trip_t *task;
    wh_real_t inner, shortest;
    wh_status_t status;
} inner_t;

/* Returns the duration via `inner`. */
static wh_real_t try_inner(inner_t *search, wh_real_t inner) {
    legs_t legs;
    const wh_real_t duration = duration_of(search->task, inner, &legs, &search->status);
    if (duration < search->shortest) {
        search->shortest = duration;
        search->inner = inner;
    }
    return duration;
}

/* An end that is already inside may itself be the inner position. */
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

/* Finds the legs with the shortest duration. */
static wh_status_t find_legs(const trip_t *task, legs_t *legs) {
    inner_t search = {task, task->reach, (wh_real_t)FLT_MAX, WH_OK};
    try_ends(&search);
    try_between(&search, task->least < task->reach ? task->least : task->reach, task->reach);
    return search.status == WH_OK ? plan_legs(task, search.inner, legs) : search.status;
}

/* ---------------------------------------------------------------------------------------------- all axes */

/* A way that is being planned. */
typedef struct {
    wh_way_t *way;
    const wh_polar_t *robot;
    wh_real_t turn, along; /* s: the least times of those axes */
    size_t count;          /* the number of arms that leave the circle */
    size_t axes[WH_POLAR_ARMS];
    trip_t trips[WH_POLAR_ARMS];
    legs_t legs[WH_POLAR_ARMS];
} plan_t;

static bool turns(const wh_polar_t *robot, size_t axis) {
    return axis == WH_AXIS_THETA || axis == WH_AXIS_YAW || axis == robot->rail;
}

/* Plans each axis alone. */
static wh_status_t plan_alone(plan_t *plan) {
    wh_way_t *way = plan->way;
    wh_status_t status = WH_OK;
    for (size_t axis = 0; status == WH_OK && axis < way->axis_count; ++axis) {
        const wh_real_t distance = way->to[axis] - way->from[axis];
        status = wh_profile_plan(&way->profiles[axis], distance, &plan->robot->limits[axis]);
    }
    return status;
}

/* True for an arm that leaves the circle. */
static bool is_out(const plan_t *plan, size_t axis) {
    bool found = false;
    for (size_t i = 0; i < plan->count; ++i) {
        found = found || plan->axes[i] == axis;
    }
    return found;
}

/* The times of the axes that turn, and of those that move all the time. */
static void take_times(plan_t *plan) {
    for (size_t axis = 0; axis < plan->way->axis_count; ++axis) {
        const wh_real_t alone = plan->way->profiles[axis].duration;
        if (turns(plan->robot, axis)) {
            plan->turn = wh_real_max(plan->turn, alone);
        } else if (!is_out(plan, axis)) {
            plan->along = wh_real_max(plan->along, alone);
        }
    }
}

static void take_arms(plan_t *plan, const wh_real_t reach[]) {
    const size_t axes[WH_POLAR_ARMS] = {WH_AXIS_R, plan->robot->second};
    for (size_t arm = 0; arm < WH_POLAR_ARMS; ++arm) {
        const size_t axis = axes[arm];
        const wh_real_t from = plan->way->from[axis];
        const wh_real_t to = plan->way->to[axis];
        if (axis > 0 && (from > reach[arm] || to > reach[arm])) {
            const trip_t trip = {.limits = &plan->robot->limits[axis],
                                 .from = from,
                                 .to = to,
                                 .reach = reach[arm],
                                 .least = plan->robot->inner[arm]};
            plan->trips[plan->count] = trip;
            plan->axes[plan->count] = axis;
            ++plan->count;
        }
    }
}

/* Searches for two arms in turn, each with the last result of the other. */
static wh_status_t find_all_legs(plan_t *plan) {
    wh_status_t status = WH_OK;
    const size_t count = plan->count;
    const size_t rounds = count > 1 ? ROUNDS : 1;
    for (size_t i = 0; status == WH_OK && i < rounds * count; ++i) {
        const size_t arm = i % count;
        plan->trips[arm].turn = plan->turn;
        status = find_legs(&plan->trips[arm], &plan->legs[arm]);
        if (status == WH_OK && count > 1) {
            const legs_t *legs = &plan->legs[arm];
            plan->trips[1 - arm].others_in = legs->came_in;
            plan->trips[1 - arm].others_tail = legs->out.duration - legs->goes_out;
        }
    }
    return status;
}

/* Places an arm that leaves the circle: it waits for the turn, for the axes that move all the time, and for
 * the other arm. */
static void place_arm(plan_t *plan, size_t arm) {
    const legs_t *legs = &plan->legs[arm];
    wh_way_out_t *out = &plan->way->outs[arm];
    wh_real_t whole = plan->along;
    if (plan->count > 1) {
        whole = wh_real_max(whole, lasts(&plan->trips[1 - arm], &plan->legs[1 - arm]));
    }
    const wh_real_t alone = legs->in.duration + legs->out.duration;
    const wh_real_t waits = wh_real_max(wait_of(&plan->trips[arm], legs), whole - alone);
    plan->way->profiles[plan->axes[arm]] = legs->in;
    out->axis = plan->axes[arm];
    out->profile = legs->out;
    out->begin = legs->in.duration + wh_real_max(waits, 0);
}

/* The turn lies between the time when all arms are in and the time when the first of them moves out;
 * without arms it takes the whole way. */
static void place_arms(plan_t *plan, wh_real_t *turn_begin, wh_real_t *turn_end) {
    wh_way_t *way = plan->way;
    way->out_count = plan->count;
    way->duration = plan->count > 0 ? 0 : wh_real_max(plan->along, plan->turn);
    *turn_begin = 0;
    *turn_end = plan->count > 0 ? (wh_real_t)FLT_MAX : way->duration;
    for (size_t arm = 0; arm < plan->count; ++arm) {
        place_arm(plan, arm);
        const wh_real_t end = way->outs[arm].begin + plan->legs[arm].goes_out;
        way->duration = wh_real_max(way->duration, way->outs[arm].begin + way->outs[arm].profile.duration);
        *turn_begin = wh_real_max(*turn_begin, plan->legs[arm].came_in);
        *turn_end = end < *turn_end ? end : *turn_end;
    }
}

static wh_status_t stretch(wh_profile_t *profile, wh_real_t duration) {
    return duration > profile->duration ? wh_profile_stretch(profile, duration) : WH_OK;
}

static wh_status_t complete(plan_t *plan) {
    wh_way_t *way = plan->way;
    wh_real_t turn_begin;
    wh_real_t turn_end;
    wh_status_t status = WH_OK;
    place_arms(plan, &turn_begin, &turn_end);
    for (size_t axis = 0; status == WH_OK && axis < way->axis_count; ++axis) {
        if (turns(plan->robot, axis)) {
            way->begins[axis] = turn_begin;
            status = stretch(&way->profiles[axis], turn_end - turn_begin);
        } else if (!is_out(plan, axis)) {
            status = stretch(&way->profiles[axis], way->duration);
        }
    }
    return status;
}

static bool are_finite(const wh_real_t values[], size_t count) {
    bool good = true;
    for (size_t i = 0; i < count; ++i) {
        good = good && wh_real_is_finite(values[i]);
    }
    return good;
}

static wh_status_t check_reach(const wh_polar_t *robot, const wh_real_t reach[]) {
    const size_t arms = robot->second > 0 ? WH_POLAR_ARMS : 1;
    if (!are_finite(reach, arms)) {
        return WH_STATUS_NOT_FINITE;
    }
    bool is_below = false;
    for (size_t arm = 0; arm < arms; ++arm) {
        is_below = is_below || reach[arm] < robot->inner[arm] - WH_SLACK_MM;
    }
    return is_below ? WH_STATUS_OUT_OF_REACH : WH_OK;
}

static wh_status_t check(const wh_way_t *way, const wh_polar_t *robot, const wh_real_t from[],
                         const wh_real_t to[], const wh_real_t reach[]) {
    if (way == NULL || robot == NULL || from == NULL || to == NULL || reach == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (!wh_polar_is_sound(robot) || robot->links[0] > 0) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    if (!are_finite(from, robot->axis_count) || !are_finite(to, robot->axis_count)) {
        return WH_STATUS_NOT_FINITE;
    }
    return check_reach(robot, reach);
}

wh_status_t wh_way_plan_polar(wh_way_t *way, const wh_polar_t *robot, const wh_real_t from[],
                              const wh_real_t to[], const wh_real_t reach[WH_POLAR_ARMS]) {
    wh_status_t status = check(way, robot, from, to, reach);
    if (status != WH_OK) {
        return status;
    }
    wh_way_t planned;
    plan_t plan;
    memset(&planned, 0, sizeof planned);
    memset(&plan, 0, sizeof plan);
    planned.axis_count = robot->axis_count;
    memcpy(planned.from, from, robot->axis_count * sizeof *from);
    memcpy(planned.to, to, robot->axis_count * sizeof *to);
    plan.way = &planned;
    plan.robot = robot;
    take_arms(&plan, reach);
    status = plan_alone(&plan);
    if (status == WH_OK) {
        take_times(&plan);
        status = find_all_legs(&plan);
    }
    if (status == WH_OK) {
        status = complete(&plan);
    }
    if (status == WH_OK) {
        *way = planned;
    }
    return status;
}

wh_status_t wh_way_plan(wh_way_t *way, const wh_robot_t *robot, const wh_real_t from[WH_ROBOT_AXES],
                        const wh_real_t to[WH_ROBOT_AXES], wh_real_t reach) {
    if (robot == NULL) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    const wh_polar_t polar = wh_polar_from_robot(robot);
    const wh_real_t reaches[WH_POLAR_ARMS] = {reach, reach};
    return wh_way_plan_polar(way, &polar, from, to, reaches);
}

void wh_way_at(const wh_way_t *way, wh_real_t t, wh_real_t q[]) {
    if (t >= way->duration) {
        memcpy(q, way->to, way->axis_count * sizeof *q);
        return;
    }
    for (size_t axis = 0; axis < way->axis_count; ++axis) {
        q[axis] = way->from[axis] + wh_profile_position(&way->profiles[axis], t - way->begins[axis]);
    }
    for (size_t i = 0; i < way->out_count; ++i) {
        const wh_way_out_t *out = &way->outs[i];
        q[out->axis] += t >= out->begin ? wh_profile_position(&out->profile, t - out->begin) : 0;
    }
}

void wh_track_take_ways(wh_track_t *track) {
    static const wh_ways_t ways = {wh_way_plan_polar, wh_way_at};
    track->ways = &ways;
}
