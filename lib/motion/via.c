#include "via.h"

#include <string.h>

#include "../math/trig.h"
#include "profile_internal.h"
#include "track.h"

#define OVERLAPS 64
/* For each profile: three in its rise, three in its fall, and the end. */
#define BREAKS 7

/* The excess over a limit that rounding may cause. */
#if defined(WH_FLOAT)
#define SLACK (1 + 1e-5F)
#else
#define SLACK (1 + 1e-12)
#endif

/* An axis's profile on a leg, as long as the leg. */
static void shape(const wh_via_t *via, size_t leg, size_t axis, wh_profile_t *profile) {
    const wh_real_t *alone = via->times[leg][axis];
    const wh_profile_times_t times = {alone[0], alone[1], alone[2]};
    wh_profile_shape(profile, via->at[leg + 1][axis] - via->at[leg][axis], &times,
                     via->end[leg] - via->begin[leg]);
}

/* ----------------------------------------------------------------------------------------------- a corner */

/* Two legs; the second begins `overlap` before the end of the first. */
typedef struct {
    const wh_polar_t *robot;
    wh_profile_t first[WH_CARRIER_AXES], second[WH_CARRIER_AXES];
    const wh_via_point_t *point;
    wh_real_t overlap;
} corner_t;

static void sum_at(const corner_t *corner, size_t axis, wh_real_t u, wh_motion_t *sum) {
    wh_motion_t second;
    wh_profile_at(&corner->first[axis], corner->first[axis].duration - corner->overlap + u, sum);
    wh_profile_at(&corner->second[axis], u, &second);
    sum->position += second.position;
    sum->speed += second.speed;
    sum->acceleration += second.acceleration;
    sum->jerk += second.jerk;
}

static bool is_within(wh_real_t value, wh_real_t limit) {
    return wh_real_abs(value) <= limit * SLACK;
}

/* Checks between two instants at which no phase begins or ends. There the sum's jerk is constant, so its
 * acceleration is largest at an end. Its speed is largest there or where the acceleration passes zero. */
static bool keeps_limits(const corner_t *corner, size_t axis, wh_real_t u, wh_real_t until) {
    const wh_limits_t *limits = &corner->robot->limits[axis];
    const wh_real_t half = (until - u) / 2;
    wh_motion_t middle;
    sum_at(corner, axis, u + half, &middle);
    const wh_real_t j = middle.jerk;
    const wh_real_t a = middle.acceleration;
    const wh_real_t most = wh_real_abs(a) + wh_real_abs(j) * half;
    const wh_real_t bend = j * half * half / 2;
    bool good = is_within(j, limits->jerk) && is_within(most, limits->acceleration) &&
                is_within(middle.speed + a * half + bend, limits->speed) &&
                is_within(middle.speed - a * half + bend, limits->speed);
    if (good && wh_real_abs(a) < wh_real_abs(j) * half) {
        good = is_within(middle.speed - a * a / (2 * j), limits->speed);
    }
    return good;
}

/* Inserts an instant within the overlap, in order. */
static void insert(wh_real_t breaks[], size_t *count, wh_real_t u, wh_real_t overlap) {
    if (!(u > 0 && u < overlap)) {
        return;
    }
    size_t place = *count;
    while (place > 0 && breaks[place - 1] > u) {
        breaks[place] = breaks[place - 1];
        --place;
    }
    breaks[place] = u;
    ++*count;
}

static void insert_phases(wh_real_t breaks[], size_t *count, const wh_profile_t *profile, wh_real_t begin,
                          wh_real_t overlap) {
    const wh_real_t d = profile->duration;
    const wh_real_t all[BREAKS] = {profile->jerk_end,
                                   profile->hold_end,
                                   profile->rise_end,
                                   d - profile->rise_end,
                                   d - profile->hold_end,
                                   d - profile->jerk_end,
                                   d};
    for (size_t i = 0; i < BREAKS; ++i) {
        insert(breaks, count, all[i] - begin, overlap);
    }
}

static bool axis_keeps_limits(const corner_t *corner, size_t axis) {
    wh_real_t breaks[2 * BREAKS + 1];
    size_t count = 0;
    const wh_profile_t *first = &corner->first[axis];
    insert_phases(breaks, &count, first, first->duration - corner->overlap, corner->overlap);
    insert_phases(breaks, &count, &corner->second[axis], 0, corner->overlap);
    breaks[count] = corner->overlap;
    wh_real_t u = 0;
    bool good = true;
    for (size_t i = 0; good && i <= count; ++i) {
        good = keeps_limits(corner, axis, u, breaks[i]);
        u = breaks[i];
    }
    return good;
}

/* The place of the end of the arm with this R, in the robot's frame; theta is the direction of that arm. */
static wh_vec3_t place_of(const wh_polar_t *robot, const wh_real_t q[], size_t arm) {
    const bool has_elbow = robot->links[0] > 0;
    const wh_real_t first = has_elbow ? robot->links[0] : q[arm];
    const wh_real_t rail = robot->rail > 0 ? q[robot->rail] : 0;
    wh_real_t s;
    wh_real_t c;
    wh_sin_cos(q[WH_AXIS_THETA], &s, &c);
    wh_vec3_t place = wh_vec3(first * c + rail, first * s, q[WH_AXIS_Z]);
    if (has_elbow) {
        wh_sin_cos(q[WH_AXIS_THETA] + q[WH_AXIS_R], &s, &c);
        place.x += robot->links[1] * c;
        place.y += robot->links[1] * s;
    }
    return place;
}

/* True if the arm's end at axes q is within the blend of its place at the point. */
static bool is_end_near(const corner_t *corner, const wh_real_t q[], size_t arm) {
    const wh_vec3_t there = place_of(corner->robot, q, arm);
    const wh_vec3_t point = place_of(corner->robot, corner->point->q, arm);
    const wh_vec3_t apart = wh_vec3_subtract(&there, &point);
    return wh_vec3_norm(&apart) <= corner->point->blend;
}

/* True if each arm's end is near the point where the second leg begins, or where the first one ends. */
static bool is_near(const corner_t *corner, bool is_second) {
    wh_real_t q[WH_CARRIER_AXES] = {0};
    for (size_t axis = 0; axis < corner->robot->axis_count; ++axis) {
        const wh_profile_t *first = &corner->first[axis];
        const wh_real_t left =
            is_second ? wh_profile_position(&corner->second[axis], corner->overlap)
                      : wh_profile_position(first, first->duration - corner->overlap) - first->distance;
        q[axis] = corner->point->q[axis] + left;
    }
    const size_t second = corner->robot->second;
    return is_end_near(corner, q, WH_AXIS_R) && (second == 0 || is_end_near(corner, q, second));
}

/* Both profiles move in one direction. While they overlap, R exceeds the point at most by the rest of the
 * first leg when the second begins, or by the second leg's way when the first ends. */
static bool is_within_reach(const corner_t *corner, size_t arm, size_t axis) {
    const wh_profile_t *first = &corner->first[axis];
    const wh_real_t left = wh_profile_position(first, first->duration - corner->overlap) - first->distance;
    const wh_real_t done = wh_profile_position(&corner->second[axis], corner->overlap);
    const wh_real_t most = corner->point->q[axis] + wh_real_max(left, 0) + wh_real_max(done, 0);
    return !(corner->point->reach[arm] > 0) || most <= corner->point->reach[arm];
}

static bool fits(const corner_t *corner) {
    const size_t second = corner->robot->second;
    bool good = is_near(corner, false) && is_near(corner, true) && is_within_reach(corner, 0, WH_AXIS_R) &&
                (second == 0 || is_within_reach(corner, 1, second));
    for (size_t axis = 0; good && axis < corner->robot->axis_count; ++axis) {
        good = axis_keeps_limits(corner, axis);
    }
    return good;
}

/* Finds the overlap: the leg begins this long before the end of the one before it. */
static wh_real_t find_overlap(const wh_via_t *via, const wh_polar_t *robot, size_t leg,
                              const wh_via_point_t *point) {
    corner_t corner = {.robot = robot, .point = point};
    for (size_t axis = 0; axis < robot->axis_count; ++axis) {
        shape(via, leg - 1, axis, &corner.first[axis]);
        shape(via, leg, axis, &corner.second[axis]);
    }
    const wh_real_t before = via->end[leg - 1] - via->begin[leg - 1];
    const wh_real_t after = via->end[leg] - via->begin[leg];
    const wh_real_t most = (before < after ? before : after) / 2;
    for (int i = OVERLAPS; i > 0 && most > 0 && point->blend > 0; --i) {
        corner.overlap = most * (wh_real_t)i / OVERLAPS;
        if (fits(&corner)) {
            return corner.overlap;
        }
    }
    return 0;
}

/* ----------------------------------------------------------------------------------------------- planning */

/* Plans each leg from 0 to its duration. */
static wh_status_t plan_leg(wh_via_t *via, const wh_polar_t *robot, size_t leg) {
    for (size_t axis = 0; axis < robot->axis_count; ++axis) {
        wh_profile_t alone;
        const wh_status_t status =
            wh_profile_plan(&alone, via->at[leg + 1][axis] - via->at[leg][axis], &robot->limits[axis]);
        if (status != WH_OK) {
            return status;
        }
        via->times[leg][axis][0] = alone.jerk_end;
        via->times[leg][axis][1] = alone.rise_end;
        via->times[leg][axis][2] = alone.duration;
        via->end[leg] = wh_real_max(via->end[leg], alone.duration);
    }
    return WH_OK;
}

static bool are_finite(const wh_via_t *via) {
    bool good = true;
    for (size_t i = 0; i <= via->legs; ++i) {
        for (size_t axis = 0; axis < via->axis_count; ++axis) {
            good = good && wh_real_is_finite(via->at[i][axis]);
        }
    }
    return good;
}

static bool are_blends(const wh_via_point_t points[], size_t count) {
    bool good = count > 0 && count <= WH_VIA_POINTS;
    for (size_t i = 0; good && i < count; ++i) {
        good = points[i].blend >= 0 && points[i].reach[0] >= 0 && points[i].reach[1] >= 0;
    }
    return good;
}

/* Takes the points where legs begin and end. */
static void take_points(wh_via_t *via, size_t axis_count, const wh_real_t from[],
                        const wh_via_point_t points[], size_t count, const wh_real_t to[]) {
    const size_t size = axis_count * sizeof *from;
    memset(via, 0, sizeof *via);
    via->axis_count = axis_count;
    via->legs = count + 1;
    memcpy(via->at[0], from, size);
    for (size_t i = 0; i < count; ++i) {
        memcpy(via->at[i + 1], points[i].q, size);
    }
    memcpy(via->at[count + 1], to, size);
}

static wh_status_t plan_legs(wh_via_t *via, const wh_polar_t *robot, const wh_via_point_t points[]) {
    wh_status_t status = WH_OK;
    for (size_t leg = 0; status == WH_OK && leg < via->legs; ++leg) {
        status = plan_leg(via, robot, leg);
    }
    for (size_t leg = 1; status == WH_OK && leg < via->legs; ++leg) {
        const wh_real_t lasts = via->end[leg];
        via->begin[leg] = via->end[leg - 1] - find_overlap(via, robot, leg, &points[leg - 1]);
        via->end[leg] = via->begin[leg] + lasts;
    }
    return status;
}

wh_status_t wh_via_plan_polar(wh_via_t *via, const wh_polar_t *robot, const wh_real_t from[],
                              const wh_via_point_t points[], size_t count, const wh_real_t to[]) {
    if (!via || !robot || !from || !points || !to) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    if (!wh_polar_is_sound(robot) || !are_blends(points, count)) {
        return WH_STATUS_OUT_OF_RANGE;
    }
    wh_via_t planned;
    take_points(&planned, robot->axis_count, from, points, count, to);
    const wh_status_t status =
        are_finite(&planned) ? plan_legs(&planned, robot, points) : WH_STATUS_NOT_FINITE;
    if (status == WH_OK) {
        *via = planned;
    }
    return status;
}

wh_status_t wh_via_plan(wh_via_t *via, const wh_robot_t *robot, const wh_real_t from[WH_ROBOT_AXES],
                        const wh_via_point_t points[], size_t count, const wh_real_t to[WH_ROBOT_AXES]) {
    if (!robot) {
        return WH_STATUS_NULL_ARGUMENT;
    }
    const wh_polar_t polar = wh_polar_from_robot(robot);
    return wh_via_plan_polar(via, &polar, from, points, count, to);
}

void wh_via_at(const wh_via_t *via, wh_real_t t, wh_real_t q[]) {
    if (t >= wh_via_duration(via)) {
        memcpy(q, via->at[via->legs], via->axis_count * sizeof *q);
        return;
    }
    size_t leg = 0;
    while (leg + 1 < via->legs && t >= via->end[leg]) {
        ++leg;
    }
    for (size_t axis = 0; axis < via->axis_count; ++axis) {
        wh_profile_t profile;
        shape(via, leg, axis, &profile);
        q[axis] = via->at[leg][axis] + wh_profile_position(&profile, t - via->begin[leg]);
        if (leg + 1 < via->legs && t > via->begin[leg + 1]) {
            shape(via, leg + 1, axis, &profile);
            q[axis] += wh_profile_position(&profile, t - via->begin[leg + 1]);
        }
    }
}

void wh_track_take_vias(wh_track_t *track) {
    static const wh_vias_t vias = {wh_via_plan_polar, wh_via_at};
    track->vias = &vias;
}
