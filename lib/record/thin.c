#include "thin.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../math/vector.h"
#include "../text/array.h"
#include "quaternion.h"

/* Two slerps whose ends are apart by no more than d are apart between them by up to d / cos(angle / 4), 1.24 d for
 * WH_THIN_TURN: thinned again with this share of what the tolerance grew by, the sum stays below the tolerance. */
#define TURN_SHARE 0.8

/* A box's half diagonal is the square root of 3 times its half edge. */
#define EDGE_OF_BALL 0.57735026918962573

static size_t linear_width(const wh_thin_t *thin) {
    return thin->turns ? thin->width - 4 : thin->width;
}

/* Numbers in `moved`: of a turn three. */
static size_t slope_count(const wh_thin_t *thin) {
    return thin->turns ? thin->width - 1 : thin->width;
}

static bool rests(const wh_thin_t *thin, const double a[], const double b[]) {
    return memcmp(a, b, thin->width * sizeof *a) == 0;
}

void wh_thin_open(wh_thin_t *thin, size_t width, double tolerance, double turn, size_t limit) {
    memset(thin, 0, sizeof *thin);
    thin->turns = turn > 0;
    thin->width = width + (thin->turns ? 4 : 0);
    thin->tolerance = tolerance;
    thin->turn = turn;
    thin->limit = limit;
}

void wh_thin_close(wh_thin_t *thin) {
    free(thin->points);
    thin->points = NULL;
    thin->count = thin->capacity = 0;
}

/* --------------------------------------------------------------------------------------------------- points */

static void keep(wh_thin_t *thin, bool exact) {
    thin->points = wh_array_grow(thin->points, thin->count, &thin->capacity, sizeof *thin->points);
    thin->anchor = thin->last;
    thin->anchor.exact = exact;
    thin->points[thin->count++] = thin->anchor;
    thin->exact_count += exact ? 1 : 0;
    thin->is_pending = false;
    thin->is_forced = false;
    for (size_t i = 0; i < WH_THIN_WIDTH; ++i) {
        thin->low[i] = -HUGE_VAL;
        thin->high[i] = HUGE_VAL;
    }
}

/* Thinned again; the tolerance is what the slopes below ask for, the caller's sum is in `thin`. */
static void thin_again(wh_thin_t *thin) {
    wh_thin_t coarse;
    wh_thin_open(&coarse, linear_width(thin), thin->tolerance, TURN_SHARE * thin->turn, SIZE_MAX);
    coarse.turns = thin->turns;
    for (size_t i = 0; i < thin->count; ++i) {
        const wh_thin_point_t *point = &thin->points[i];
        wh_thin_add(&coarse, point->slice, point->values);
        if (point->exact) {
            wh_thin_force(&coarse);
        }
    }
    wh_thin_finish(&coarse);
    free(thin->points);
    thin->points = coarse.points;
    thin->count = coarse.count;
    thin->capacity = coarse.capacity;
    thin->exact_count = coarse.exact_count;
    thin->tolerance *= 2;
    thin->turn *= 2;
}

/* A signal that turns too far from sample to sample cannot be thinned: it gets its room, or each sample would cost all of
 * them. */
static void keep_to_limit(wh_thin_t *thin) {
    for (int i = 0; i < 3 && thin->count - thin->exact_count > thin->limit; ++i) {
        thin_again(thin);
    }
    if (thin->count - thin->exact_count > thin->limit) {
        thin->limit *= 2;
    }
}

/* --------------------------------------------------------------------------------------------------- slopes */

static double turned(const wh_thin_t *thin) {
    const double *turn = thin->moved + linear_width(thin);
    return thin->turns ? wh_real_sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]) : 0;
}

/* How far the sample is from the last point. */
static void move(wh_thin_t *thin, const double values[]) {
    const double *from = thin->anchor.values;
    const size_t linear = linear_width(thin);
    for (size_t i = 0; i < linear; ++i) {
        thin->moved[i] = values[i] - from[i];
    }
    if (thin->turns) {
        wh_quaternion_turn(from + linear, values + linear, thin->moved + linear);
    }
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
        const double room = i < linear ? thin->tolerance : EDGE_OF_BALL * thin->turn;
        const double low = (thin->moved[i] - room) / slices;
        const double high = (thin->moved[i] + room) / slices;
        thin->low[i] = low > thin->low[i] ? low : thin->low[i];
        thin->high[i] = high < thin->high[i] ? high : thin->high[i];
    }
}

static double slices_to(const wh_thin_t *thin, int64_t slice) {
    return (double)(slice - thin->anchor.slice);
}

/* --------------------------------------------------------------------------------------------------- samples */

static void take(wh_thin_t *thin, int64_t slice, const double values[]) {
    thin->last.slice = slice;
    memcpy(thin->last.values, values, thin->width * sizeof *values);
    thin->is_pending = true;
}

/* A forced sample from which the signal moves on must become a point before the next one comes. */
static void settle(wh_thin_t *thin, const double values[]) {
    if (thin->is_pending && thin->is_forced && !rests(thin, thin->last.values, values)) {
        keep(thin, true);
        keep_to_limit(thin);
    }
}

void wh_thin_add(wh_thin_t *thin, int64_t slice, const double values[]) {
    ++thin->of;
    if (thin->count > 0) {
        settle(thin, values);
    }
    if (thin->count == 0) {
        take(thin, slice, values);
        keep(thin, true);
        return;
    }
    move(thin, values);
    if (thin->is_pending && !fits(thin, slices_to(thin, slice))) {
        keep(thin, thin->is_forced);
        keep_to_limit(thin);
        move(thin, values);
    }
    narrow(thin, slices_to(thin, slice));
    take(thin, slice, values);
}

static void make_exact(wh_thin_t *thin, wh_thin_point_t *point) {
    thin->exact_count += point->exact ? 0 : 1;
    point->exact = true;
}

void wh_thin_force(wh_thin_t *thin) {
    if (thin->count == 0) {
        return;
    }
    wh_thin_point_t *point = &thin->points[thin->count - 1];
    if (!thin->is_pending) {
        make_exact(thin, point);
    } else if (rests(thin, point->values, thin->last.values)) {
        /* Both ends of the rest then say it. */
        make_exact(thin, point);
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

/* --------------------------------------------------------------------------------------------------- reading */

/* The last point at or before the slice. */
static size_t find(const wh_thin_t *thin, int64_t slice) {
    size_t low = 0;
    size_t high = thin->count;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (thin->points[middle].slice <= slice) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

void wh_thin_read(const wh_thin_t *thin, int64_t slice, double values[]) {
    const wh_thin_point_t *from = &thin->points[find(thin, slice)];
    const bool last = from == &thin->points[thin->count - 1];
    const wh_thin_point_t *to = last || slice <= from->slice ? from : from + 1;
    const double share = to == from ? 0 : (double)(slice - from->slice) / (double)(to->slice - from->slice);
    const size_t linear = linear_width(thin);
    for (size_t i = 0; i < linear; ++i) {
        values[i] = from->values[i] + share * (to->values[i] - from->values[i]);
    }
    if (thin->turns) {
        wh_quaternion_slerp(from->values + linear, to->values + linear, share, values + linear);
    }
}
