#include "thin.h"

#include <math.h>
#include <string.h>

#include "../math/vector.h"
#include "quaternion.h"

/* If the ends of two slerps are at most d apart, the slerps are at most d / cos(angle / 4) apart: 1.24 d
 * for WH_THIN_TURN. So the second thinning may use only this share of the tolerance's growth. */
#define TURN_SHARE 0.8

/* A box's half diagonal is the square root of 3 times its half edge. */
#define EDGE_OF_BALL 0.57735026918962573

static size_t linear_width(const wh_thin_t *thin) {
    return thin->list.width - (thin->turns ? 4 : 0);
}

/* The number of numbers in `moved`: a turn counts as three. */
static size_t slope_count(const wh_thin_t *thin) {
    return thin->list.width - (thin->turns ? 1 : 0);
}

static bool rests(const wh_thin_t *thin, const double a[], const double b[]) {
    return memcmp(a, b, thin->list.width * sizeof *a) == 0;
}

/* The last point's numbers. Samples are measured from it. */
static const double *anchor(const wh_thin_t *thin) {
    return wh_points_numbers(&thin->list, thin->list.count - 1);
}

void wh_thin_open(wh_thin_t *thin, size_t width, double tolerance, double turn, size_t limit) {
    memset(thin, 0, sizeof *thin);
    thin->turns = turn > 0;
    thin->turn = turn;
    thin->list.width = width + (thin->turns ? 4 : 0);
    thin->list.tolerance = tolerance;
    thin->list.limit = limit;
}

void wh_thin_close(wh_thin_t *thin) {
    wh_points_close(&thin->list);
}

/* ------------------------------------------------------------------------------------------------- points */

static void keep(wh_thin_t *thin, bool exact) {
    wh_points_insert(&thin->list, thin->list.count, thin->last.slice, thin->last.values, exact);
    thin->is_pending = false;
    thin->is_forced = false;
    thin->has_moved = false;
    thin->has_rested = true;
    for (size_t i = 0; i < WH_THIN_WIDTH; ++i) {
        thin->low[i] = -HUGE_VAL;
        thin->high[i] = HUGE_VAL;
    }
}

/* The coarser fit adds its tolerance to the error before: the sum is the new tolerance, twice the old
 * one. */
static void thin_again(void *fit) {
    wh_thin_t *thin = fit;
    wh_thin_t coarse;
    wh_thin_open(&coarse, linear_width(thin), thin->list.tolerance, TURN_SHARE * thin->turn, SIZE_MAX);
    coarse.turns = thin->turns;
    for (size_t i = 0; i < thin->list.count; ++i) {
        wh_thin_add(&coarse, thin->list.points[i].slice, wh_points_numbers(&thin->list, i));
        if (thin->list.points[i].exact) {
            wh_thin_force(&coarse);
        }
    }
    wh_thin_finish(&coarse);
    coarse.list.limit = thin->list.limit;
    coarse.list.tolerance = 2 * thin->list.tolerance;
    wh_points_close(&thin->list);
    thin->list = coarse.list;
    thin->turn *= 2;
}

/* ------------------------------------------------------------------------------------------------- slopes */

static double turned(const wh_thin_t *thin) {
    const double *turn = thin->moved + linear_width(thin);
    return thin->turns ? wh_real_sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]) : 0;
}

/* The difference of the sample from the last point. */
static void move(wh_thin_t *thin, const double values[]) {
    const double *from = anchor(thin);
    const size_t linear = linear_width(thin);
    for (size_t i = 0; i < linear; ++i) {
        thin->moved[i] = values[i] - from[i];
    }
    if (thin->turns) {
        wh_quaternion_turn(from + linear, values + linear, thin->moved + linear);
    }
    thin->has_moved = true;
}

static bool fits(const wh_thin_t *thin, double slices) {
    const size_t count = slope_count(thin);
    for (size_t i = 0; i < count; ++i) {
        const double slope = thin->moved[i] / slices;
        if (!(slope >= thin->low[i] && slope <= thin->high[i])) {
            return false;
        }
    }
    return turned(thin) <= WH_THIN_TURN;
}

static void narrow(wh_thin_t *thin, double slices) {
    const size_t linear = linear_width(thin);
    const size_t count = slope_count(thin);
    for (size_t i = 0; i < count; ++i) {
        const double room = i < linear ? thin->list.tolerance : EDGE_OF_BALL * thin->turn;
        const double low = (thin->moved[i] - room) / slices;
        const double high = (thin->moved[i] + room) / slices;
        thin->low[i] = low > thin->low[i] ? low : thin->low[i];
        thin->high[i] = high < thin->high[i] ? high : thin->high[i];
    }
}

static double slices_to(const wh_thin_t *thin, int64_t slice) {
    return (double)(slice - thin->list.points[thin->list.count - 1].slice);
}

/* ------------------------------------------------------------------------------------------------ samples */

static void take(wh_thin_t *thin, int64_t slice, const double values[]) {
    thin->last.slice = slice;
    memcpy(thin->last.values, values, thin->list.width * sizeof *values);
    thin->is_pending = true;
}

/* If the last sample is forced and the signal changes after it, it becomes a point before the next one
 * comes. */
static void settle(wh_thin_t *thin, const double values[]) {
    if (thin->is_pending && thin->is_forced && !rests(thin, thin->last.values, values)) {
        keep(thin, true);
        wh_points_keep_to_limit(&thin->list, thin_again, thin);
    }
}

/* Each sample of a rest narrows the slopes, and the last one more than all before it: it alone is taken. */
static void end_rest(wh_thin_t *thin) {
    thin->has_rested = false;
    if (thin->is_pending) {
        move(thin, thin->last.values);
        narrow(thin, slices_to(thin, thin->last.slice));
    }
}

/* A sample that may be elsewhere than the last point. */
static void add_moved(wh_thin_t *thin, int64_t slice, const double values[]) {
    if (thin->has_rested) {
        end_rest(thin);
    }
    if (!thin->has_moved || !rests(thin, thin->last.values, values)) {
        move(thin, values);
    }
    if (thin->is_pending && !fits(thin, slices_to(thin, slice))) {
        keep(thin, thin->is_forced);
        wh_points_keep_to_limit(&thin->list, thin_again, thin);
        thin->has_rested = false;
        move(thin, values);
    }
    narrow(thin, slices_to(thin, slice));
    take(thin, slice, values);
}

void wh_thin_add(wh_thin_t *thin, int64_t slice, const double values[]) {
    ++thin->of;
    if (thin->list.count > 0) {
        settle(thin, values);
    }
    if (thin->list.count == 0) {
        take(thin, slice, values);
        keep(thin, true);
    } else if (thin->has_rested && rests(thin, anchor(thin), values)) {
        take(thin, slice, values);
    } else {
        add_moved(thin, slice, values);
    }
}

/* A pose that stays has the quaternion that it had. */
void wh_thin_add_pose(wh_thin_t *thin, int64_t slice, const wh_pose_t *pose) {
    double values[7] = {pose->r.x, pose->r.y, pose->r.z};
    if (thin->of > 0 && wh_thin_is_same_pose(pose, &thin->pose)) {
        memcpy(values, thin->last.values, sizeof values);
    } else {
        wh_quaternion_from_matrix(&pose->R, thin->of > 0 ? thin->last.values + 3 : NULL, values + 3);
        thin->pose = *pose;
    }
    wh_thin_add(thin, slice, values);
}

void wh_thin_force(wh_thin_t *thin) {
    if (thin->list.count == 0) {
        return;
    }
    const size_t last = thin->list.count - 1;
    if (!thin->is_pending) {
        wh_points_make_exact(&thin->list, last);
    } else if (rests(thin, anchor(thin), thin->last.values)) {
        /* A rest is exact if both its ends are exact. */
        wh_points_make_exact(&thin->list, last);
        thin->is_forced = true;
    } else {
        keep(thin, true);
    }
}

void wh_thin_finish(wh_thin_t *thin) {
    if (thin->is_pending) {
        keep(thin, true);
    }
}

/* ------------------------------------------------------------------------------------------------ reading */

void wh_thin_read(const wh_thin_t *thin, int64_t slice, double values[]) {
    const wh_points_t *list = &thin->list;
    const size_t at = wh_points_find(list, slice);
    const int64_t begin = list->points[at].slice;
    const size_t next = at + 1 == list->count || slice <= begin ? at : at + 1;
    const double share =
        next == at ? 0 : (double)(slice - begin) / (double)(list->points[next].slice - begin);
    const double *from = wh_points_numbers(list, at);
    const double *to = wh_points_numbers(list, next);
    const size_t linear = linear_width(thin);
    for (size_t i = 0; i < linear; ++i) {
        values[i] = from[i] + share * (to[i] - from[i]);
    }
    if (thin->turns) {
        wh_quaternion_slerp(from + linear, to + linear, share, values + linear);
    }
}

void wh_thin_read_pose(const wh_thin_t *thin, int64_t slice, wh_pose_t *pose) {
    double values[7] = {0};
    wh_thin_read(thin, slice, values);
    pose->r = wh_vec3(values[0], values[1], values[2]);
    wh_quaternion_to_matrix(values + 3, &pose->R);
}
