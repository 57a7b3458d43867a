#include "path.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"

/* This number of equal samples is a rest. */
#define REST 32

/* The second thinning compares two cubics at this number of places. There they may differ by this share of
 * the tolerance; between the places the difference then stays below the tolerance. At most this number of
 * cubics become one. */
#define PLACES 16
#define ROOM 0.95
#define MERGED 64

void wh_path_open(wh_path_t *curve, double tolerance, size_t limit) {
    memset(curve, 0, sizeof *curve);
    curve->list.width = 2;
    curve->list.tolerance = tolerance;
    curve->list.limit = limit;
    curve->good = 1;
    curve->next = 2;
}

void wh_path_close(wh_path_t *curve) {
    wh_points_close(&curve->list);
    free(curve->samples);
    memset(curve, 0, sizeof *curve);
}

static bool is_same(double a, double b) {
    return !(a < b) && !(a > b);
}

/* ------------------------------------------------------------------------------------------------- cubics */

/* A cubic between two points: value = v + x (a + x (b + x c)), with x from 0 at the first to 1 at the
 * second. */
typedef struct {
    double from, width;
    double v, a, b, c;
} cubic_t;

static cubic_t cubic_of(int64_t from, double v, double slope, int64_t to, double next, double next_slope) {
    const double width = (double)(to - from);
    const double way = next - v;
    const double a = width * slope;
    const double end = width * next_slope;
    return (cubic_t){(double)from, width, v, a, 3 * way - 2 * a - end, a + end - 2 * way};
}

static double at_slice(const cubic_t *cubic, int64_t slice, double *slope) {
    const double x = ((double)slice - cubic->from) / cubic->width;
    if (slope) {
        *slope = (cubic->a + x * (2 * cubic->b + 3 * x * cubic->c)) / cubic->width;
    }
    return cubic->v + x * (cubic->a + x * (cubic->b + x * cubic->c));
}

static double last_slope(const wh_path_t *curve) {
    return wh_path_slope(curve, curve->list.count - 1);
}

/* True if one cubic from the last point to sample `end`, with that slope there, misses no sample between
 * them. */
static bool fits(const wh_path_t *curve, size_t end, double slope) {
    const wh_sample_t *samples = curve->samples;
    const cubic_t cubic = cubic_of(samples[0].slice, samples[0].value, last_slope(curve), samples[end].slice,
                                   samples[end].value, slope);
    for (size_t i = 1; i < end; ++i) {
        if (!(fabs(at_slice(&cubic, samples[i].slice, NULL) - samples[i].value) <= curve->list.tolerance)) {
            return false;
        }
    }
    return true;
}

/* The slope over the samples on both sides, limited so that the cubic does not overshoot a jump; at either
 * end over one side. */
static double slope_at(const wh_path_t *curve, size_t i) {
    const wh_sample_t *at = &curve->samples[i];
    const wh_sample_t *before = i > 0 ? at - 1 : at;
    const wh_sample_t *after = i + 1 < curve->sample_count ? at + 1 : at;
    if (after == before) {
        return 0;
    }
    const double whole = (double)(after->slice - before->slice);
    const double chord = (after->value - before->value) / whole;
    if (before == at || after == at) {
        return chord;
    }
    const double width = (double)(at->slice - before->slice), next = (double)(after->slice - at->slice);
    const double to = (at->value - before->value) / width;
    const double from = (after->value - at->value) / next;
    /* Where samples are missing on one side, the nearer one tells more. */
    const double slope = is_same(width, next) ? chord : (next * to + width * from) / whole;
    const double least = to * from > 0 ? 3 * fmin(fabs(to), fabs(from)) : 0;
    return fabs(slope) <= least ? slope : copysign(least, slope);
}

/* ----------------------------------------------------------------------------------------------- thinning */

/* The cubic from one point to another. */
static cubic_t cubic_between(const wh_path_t *curve, size_t from, size_t to) {
    return cubic_of(curve->list.points[from].slice, wh_path_value(curve, from), wh_path_slope(curve, from),
                    curve->list.points[to].slice, wh_path_value(curve, to), wh_path_slope(curve, to));
}

/* True if a cubic is near to the one between point `i` and the next. */
static bool follows(const wh_path_t *curve, const cubic_t *cubic, size_t i) {
    const cubic_t fine = cubic_between(curve, i, i + 1);
    const int64_t from = curve->list.points[i].slice;
    const int64_t width = curve->list.points[i + 1].slice - from;
    const int64_t places = width < PLACES ? width : PLACES;
    for (int64_t k = 0; k < places; ++k) {
        const int64_t slice = from + (int64_t)((double)width * (double)k / (double)places);
        if (!(fabs(at_slice(cubic, slice, NULL) - at_slice(&fine, slice, NULL)) <=
              ROOM * curve->list.tolerance)) {
            return false;
        }
    }
    return true;
}

static bool is_rest(const wh_path_t *curve, size_t from) {
    return is_same(wh_path_value(curve, from), wh_path_value(curve, from + 1)) &&
           is_same(wh_path_slope(curve, from), 0) && is_same(wh_path_slope(curve, from + 1), 0);
}

/* True if one cubic can replace those from point `i` to point `end`. */
static bool covers(const wh_path_t *curve, size_t i, size_t end) {
    const wh_point_t *points = curve->list.points;
    const cubic_t cubic = cubic_between(curve, i, end);
    for (size_t k = i; k < end; ++k) {
        const bool stays = k > i && (points[k].exact || points[k].ends || is_rest(curve, k - 1));
        if (stays || is_rest(curve, k) || !follows(curve, &cubic, k)) {
            return false;
        }
    }
    return true;
}

/* Drops points that a cubic between their neighbours can replace. The curve may then be off by up to the
 * tolerance once more. */
static void thin_again(void *fit) {
    wh_path_t *curve = fit;
    wh_points_t *list = &curve->list;
    size_t kept = 0;
    size_t i = 0;
    while (i + 1 < list->count) {
        size_t end = i + 1;
        while (end + 1 < list->count && end - i < MERGED && !list->points[i].ends &&
               covers(curve, i, end + 1)) {
            ++end;
        }
        list->points[++kept] = list->points[end];
        memmove(wh_points_numbers(list, kept), wh_points_numbers(list, end), 2 * sizeof *list->numbers);
        i = end;
    }
    list->count = kept + 1;
    list->tolerance *= 2;
}

/* Makes the sample the last point. */
static void add_point(wh_path_t *curve, const wh_sample_t *sample, double slope, bool exact) {
    const double numbers[] = {sample->value, slope};
    wh_points_insert(&curve->list, curve->list.count, sample->slice, numbers, exact);
}

/* Makes sample `i` a point. It forgets the samples before. */
static void keep(wh_path_t *curve, size_t i, double slope, bool exact) {
    add_point(curve, &curve->samples[i], slope, exact);
    curve->sample_count -= i;
    memmove(curve->samples, curve->samples + i, curve->sample_count * sizeof *curve->samples);
    curve->equal = curve->equal < curve->sample_count ? curve->equal : curve->sample_count;
    curve->is_at_rest = false;
    curve->good = 1;
    curve->next = 2;
    wh_points_keep_to_limit(&curve->list, thin_again, curve);
}

/* ------------------------------------------------------------------------------------------------- search */

/* The last sample that one cubic reaches, found by bisection between a sample that it reaches and one that
 * it does not. */
static size_t bisect(const wh_path_t *curve, size_t good, size_t bad) {
    while (bad - good > 1) {
        const size_t middle = good + (bad - good) / 2;
        if (fits(curve, middle, slope_at(curve, middle))) {
            good = middle;
        } else {
            bad = middle;
        }
    }
    return good;
}

/* Adds the points that the samples up to `end` require. Their slopes are known, because a sample follows
 * each. */
static void advance(wh_path_t *curve, size_t end) {
    while (curve->next <= end) {
        if (!fits(curve, curve->next, slope_at(curve, curve->next))) {
            const size_t reached = bisect(curve, curve->good, curve->next);
            end -= reached;
            keep(curve, reached, slope_at(curve, reached), false);
        } else if (2 * curve->next > WH_PATH_SPAN) {
            end -= curve->next;
            keep(curve, curve->next, slope_at(curve, curve->next), false);
        } else {
            curve->good = curve->next;
            curve->next *= 2;
        }
    }
}

/* Makes sample `end` a point, after the other points that the tolerance requires. */
static void settle(wh_path_t *curve, size_t end, double slope, bool exact) {
    while (!fits(curve, end, slope)) {
        const size_t reached = bisect(curve, curve->good < end ? curve->good : 1, end);
        end -= reached;
        keep(curve, reached, slope_at(curve, reached), false);
    }
    keep(curve, end, slope, exact);
}

/* ------------------------------------------------------------------------------------------------ samples */

/* Makes the rest's first sample a point. Only its last sample is kept, so a rest takes no room. */
static void come_to_rest(wh_path_t *curve) {
    const size_t last = curve->sample_count - 1;
    size_t first = curve->sample_count - curve->equal;
    first += first == 0 && !is_same(last_slope(curve), 0) ? 1 : 0;
    const wh_sample_t sample = curve->samples[last];
    if (first > 0) {
        settle(curve, first, 0, false);
    }
    curve->samples[1] = sample;
    curve->sample_count = curve->equal = 2;
    curve->is_at_rest = true;
}

static void push(wh_path_t *curve, int64_t slice, double value) {
    const size_t count = curve->sample_count;
    curve->equal = count > 0 && is_same(curve->samples[count - 1].value, value) ? curve->equal + 1 : 1;
    curve->samples = wh_array_grow(curve->samples, count, &curve->sample_capacity, sizeof *curve->samples);
    curve->samples[curve->sample_count++] = (wh_sample_t){slice, value};
}

static void begin_curve(wh_path_t *curve, int64_t slice, double value) {
    push(curve, slice, value);
    add_point(curve, &curve->samples[0], 0, true);
    curve->is_fresh = true;
}

void wh_path_add(wh_path_t *curve, int64_t slice, double value) {
    ++curve->of;
    if (curve->sample_count == 0) {
        begin_curve(curve, slice, value);
        return;
    }
    if (curve->is_at_rest && is_same(curve->samples[1].value, value)) {
        curve->samples[1].slice = slice;
        return;
    }
    if (curve->is_at_rest) {
        keep(curve, 1, 0, curve->is_forced);
        curve->is_forced = false;
    }
    push(curve, slice, value);
    if (curve->is_fresh) {
        wh_points_numbers(&curve->list, curve->list.count - 1)[1] = slope_at(curve, 0);
        curve->is_fresh = false;
    }
    const size_t known = curve->sample_count - 2;
    if (curve->is_forced && known > 0) {
        settle(curve, known, slope_at(curve, known), true);
    } else {
        advance(curve, known);
    }
    curve->is_forced = false;
    if (curve->equal > REST) {
        come_to_rest(curve);
    }
}

void wh_path_force(wh_path_t *curve) {
    if (curve->sample_count == 0) {
        return;
    }
    if (curve->sample_count == 1 || curve->is_at_rest) {
        /* A rest is exact if both its ends are exact. */
        wh_points_make_exact(&curve->list, curve->list.count - 1);
    }
    curve->is_forced = curve->sample_count > 1;
}

void wh_path_finish(wh_path_t *curve) {
    if (curve->sample_count > 1) {
        const size_t last = curve->sample_count - 1;
        settle(curve, last, curve->is_at_rest ? 0 : slope_at(curve, last), true);
    }
    curve->is_forced = false;
}

void wh_path_break(wh_path_t *curve) {
    if (curve->sample_count > 0) {
        wh_path_finish(curve);
        wh_points_make_exact(&curve->list, curve->list.count - 1);
        curve->list.points[curve->list.count - 1].ends = true;
        curve->sample_count = 0;
        curve->equal = 0;
        curve->is_fresh = false;
    }
}

/* ------------------------------------------------------------------------------------------------ reading */

double wh_path_read(const wh_path_t *curve, int64_t slice, double *slope) {
    const wh_points_t *list = &curve->list;
    if (list->count == 0 || slice < list->points[0].slice) {
        return (double)NAN;
    }
    const size_t at = wh_points_find(list, slice);
    const bool is_point = slice == list->points[at].slice;
    if (slope) {
        *slope = is_point ? wh_path_slope(curve, at) : 0;
    }
    if (is_point) {
        return wh_path_value(curve, at);
    }
    if (list->points[at].ends || at + 1 == list->count) {
        return list->points[at].ends ? (double)NAN : wh_path_value(curve, at);
    }
    const cubic_t cubic = cubic_between(curve, at, at + 1);
    return at_slice(&cubic, slice, slope);
}

bool wh_path_last(const wh_path_t *curve, double *value) {
    if (curve->sample_count == 0) {
        return false;
    }
    *value = curve->samples[curve->sample_count - 1].value;
    return true;
}

void wh_path_insert(wh_path_t *curve, int64_t slice, double value) {
    wh_points_t *list = &curve->list;
    const bool forced = curve->is_forced;
    wh_path_finish(curve);
    curve->is_forced = forced && curve->sample_count > 1;
    if (list->count == 0 || slice < list->points[0].slice || slice > list->points[list->count - 1].slice) {
        return;
    }
    const size_t at = wh_points_find(list, slice);
    if (list->points[at].slice == slice) {
        wh_points_make_exact(list, at);
    } else if (!list->points[at].ends) {
        double numbers[] = {value, 0};
        (void)wh_path_read(curve, slice, &numbers[1]);
        wh_points_insert(list, at + 1, slice, numbers, true);
    }
}
