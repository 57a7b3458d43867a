#include "path.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"

/* So many equal samples are a rest. */
#define REST 32

/* To thin again, cubics are compared in so many places, where two may differ by this share of the tolerance: it is the
 * tolerance between them then. So many become one at most. */
#define PLACES 16
#define ROOM 0.95
#define MERGED 64

void wh_path_open(wh_path_t *curve, double tolerance, size_t limit) {
    memset(curve, 0, sizeof *curve);
    curve->tolerance = tolerance;
    curve->limit = limit;
    curve->good = 1;
    curve->next = 2;
}

void wh_path_close(wh_path_t *curve) {
    free(curve->points);
    free(curve->samples);
    memset(curve, 0, sizeof *curve);
}

static bool is_same(double a, double b) {
    return !(a < b) && !(a > b);
}

/* --------------------------------------------------------------------------------------------------- cubics */

/* From a point on: value = v + x (a + x (b + x c)), x from 0 to 1 at the next one. */
typedef struct {
    double from, width;
    double v, a, b, c;
} cubic_t;

static cubic_t cubic_of(int64_t from, double v, double slope, int64_t to, double next, double next_slope) {
    const double width = (double)(to - from);
    const double way = next - v;
    const double a = width * slope;
    const double end = width * next_slope;
    const cubic_t cubic = {(double)from, width, v, a, 3 * way - 2 * a - end, a + end - 2 * way};
    return cubic;
}

static double at_slice(const cubic_t *cubic, int64_t slice, double *slope) {
    const double x = ((double)slice - cubic->from) / cubic->width;
    if (slope) {
        *slope = (cubic->a + x * (2 * cubic->b + 3 * x * cubic->c)) / cubic->width;
    }
    return cubic->v + x * (cubic->a + x * (cubic->b + x * cubic->c));
}

static double last_slope(const wh_path_t *curve) {
    return curve->points[curve->count - 1].slope;
}

/* Whether one cubic goes from the last point to sample `end`, with that slope there, and misses none between them. */
static bool fits(const wh_path_t *curve, size_t end, double slope) {
    const wh_sample_t *samples = curve->samples;
    const cubic_t cubic = cubic_of(samples[0].slice, samples[0].value, last_slope(curve), samples[end].slice,
                                   samples[end].value, slope);
    for (size_t i = 1; i < end; ++i) {
        if (!(fabs(at_slice(&cubic, samples[i].slice, NULL) - samples[i].value) <= curve->tolerance)) {
            return false;
        }
    }
    return true;
}

/* Over the samples on both sides, but flat enough that a jump is not overshot; over one at an end of all. */
static double slope_at(const wh_path_t *curve, size_t i) {
    const wh_sample_t *at = &curve->samples[i];
    const wh_sample_t *before = i > 0 ? at - 1 : at;
    const wh_sample_t *after = i + 1 < curve->sample_count ? at + 1 : at;
    if (after == before) {
        return 0;
    }
    const double slope = (after->value - before->value) / (double)(after->slice - before->slice);
    if (before == at || after == at) {
        return slope;
    }
    const double to = (at->value - before->value) / (double)(at->slice - before->slice);
    const double from = (after->value - at->value) / (double)(after->slice - at->slice);
    const double least = to * from > 0 ? 3 * fmin(fabs(to), fabs(from)) : 0;
    return fabs(slope) <= least ? slope : copysign(least, slope);
}

/* --------------------------------------------------------------------------------------------------- points */

static void add_point(wh_path_t *curve, const wh_sample_t *sample, double slope, bool exact) {
    curve->points = wh_array_grow(curve->points, curve->count, &curve->capacity, sizeof *curve->points);
    const wh_path_point_t point = {sample->slice, sample->value, slope, exact, false};
    curve->points[curve->count++] = point;
    curve->exact_count += exact ? 1 : 0;
}

/* ------------------------------------------------------------------------------------------------- thinning */

static cubic_t cubic_between(const wh_path_point_t *from, const wh_path_point_t *to) {
    return cubic_of(from->slice, from->value, from->slope, to->slice, to->value, to->slope);
}

/* Whether a cubic is near to the one between two neighbouring points. */
static bool follows(const cubic_t *cubic, const wh_path_point_t *from, double room) {
    const cubic_t fine = cubic_between(from, from + 1);
    const int64_t width = (from + 1)->slice - from->slice;
    const int64_t places = width < PLACES ? width : PLACES;
    for (int64_t i = 0; i < places; ++i) {
        const int64_t slice = from->slice + (int64_t)((double)width * (double)i / (double)places);
        if (!(fabs(at_slice(cubic, slice, NULL) - at_slice(&fine, slice, NULL)) <= room)) {
            return false;
        }
    }
    return true;
}

static bool is_rest(const wh_path_point_t *from) {
    const wh_path_point_t *to = from + 1;
    return is_same(from->value, to->value) && is_same(from->slope, 0) && is_same(to->slope, 0);
}

/* Whether one cubic can stand for those from point `i` to point `end`. */
static bool covers(const wh_path_t *curve, size_t i, size_t end) {
    const wh_path_point_t *points = curve->points;
    const cubic_t cubic = cubic_between(&points[i], &points[end]);
    for (size_t k = i; k < end; ++k) {
        const bool stays = k > i && (points[k].exact || points[k].ends || is_rest(&points[k - 1]));
        if (stays || is_rest(&points[k]) || !follows(&cubic, &points[k], ROOM * curve->tolerance)) {
            return false;
        }
    }
    return true;
}

/* Points of which the others say enough go; off by the tolerance once more. */
static void thin_again(wh_path_t *curve) {
    size_t kept = 0;
    size_t i = 0;
    while (i + 1 < curve->count) {
        size_t end = i + 1;
        while (end + 1 < curve->count && end - i < MERGED && !curve->points[i].ends &&
               covers(curve, i, end + 1)) {
            ++end;
        }
        curve->points[++kept] = curve->points[end];
        i = end;
    }
    curve->count = kept + 1;
    curve->tolerance *= 2;
}

/* A signal that jumps without end cannot be thinned: it gets its room, or each sample would cost all of them. */
static void keep_to_limit(wh_path_t *curve) {
    for (int i = 0; i < 3 && curve->count - curve->exact_count > curve->limit; ++i) {
        thin_again(curve);
    }
    if (curve->count - curve->exact_count > curve->limit) {
        curve->limit *= 2;
    }
}

/* Sample `i` becomes a point, and the first of those that are kept. */
static void keep(wh_path_t *curve, size_t i, double slope, bool exact) {
    add_point(curve, &curve->samples[i], slope, exact);
    curve->sample_count -= i;
    memmove(curve->samples, curve->samples + i, curve->sample_count * sizeof *curve->samples);
    curve->equal = curve->equal < curve->sample_count ? curve->equal : curve->sample_count;
    curve->is_at_rest = false;
    curve->good = 1;
    curve->next = 2;
    keep_to_limit(curve);
}

/* --------------------------------------------------------------------------------------------------- search */

/* The last sample between `good` and `bad` that was seen to be in reach. */
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

/* Points for the samples up to `end`, whose slopes are known. */
static void advance(wh_path_t *curve, size_t end) {
    while (curve->next <= end) {
        if (!fits(curve, curve->next, slope_at(curve, curve->next))) {
            const size_t reached = bisect(curve, curve->good, curve->next);
            end -= reached;
            keep(curve, reached, slope_at(curve, reached), false);
        } else if (2 * curve->next > WH_CURVE_SPAN) {
            end -= curve->next;
            keep(curve, curve->next, slope_at(curve, curve->next), false);
        } else {
            curve->good = curve->next;
            curve->next *= 2;
        }
    }
}

/* Sample `end` becomes a point, and before it as many as that takes. */
static void settle(wh_path_t *curve, size_t end, double slope, bool exact) {
    while (!fits(curve, end, slope)) {
        const size_t reached = bisect(curve, curve->good < end ? curve->good : 1, end);
        end -= reached;
        keep(curve, reached, slope_at(curve, reached), false);
    }
    keep(curve, end, slope, exact);
}

/* -------------------------------------------------------------------------------------------------- samples */

/* A point where the rest began, and of the rest the last sample alone. */
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
    const wh_sample_t sample = {slice, value};
    curve->samples[curve->sample_count++] = sample;
}

static void begin(wh_path_t *curve, int64_t slice, double value) {
    push(curve, slice, value);
    add_point(curve, &curve->samples[0], 0, true);
    curve->is_fresh = true;
}

void wh_path_add(wh_path_t *curve, int64_t slice, double value) {
    ++curve->of;
    if (curve->sample_count == 0) {
        begin(curve, slice, value);
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
        curve->points[curve->count - 1].slope = slope_at(curve, 0);
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

static void make_exact(wh_path_t *curve, size_t i) {
    curve->exact_count += curve->points[i].exact ? 0 : 1;
    curve->points[i].exact = true;
}

void wh_path_force(wh_path_t *curve) {
    if (curve->sample_count == 0) {
        return;
    }
    if (curve->sample_count == 1 || curve->is_at_rest) {
        /* Of a rest both ends then say it. */
        make_exact(curve, curve->count - 1);
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
        make_exact(curve, curve->count - 1);
        curve->points[curve->count - 1].ends = true;
        curve->sample_count = 0;
        curve->equal = 0;
        curve->is_fresh = false;
    }
}

/* -------------------------------------------------------------------------------------------------- reading */

/* The last point at or before the slice. */
static size_t find(const wh_path_t *curve, int64_t slice) {
    size_t low = 0;
    size_t high = curve->count;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (curve->points[middle].slice <= slice) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

double wh_path_read(const wh_path_t *curve, int64_t slice, double *slope) {
    const double none = (double)NAN;
    if (curve->count == 0 || slice < curve->points[0].slice) {
        return none;
    }
    const size_t at = find(curve, slice);
    const wh_path_point_t *from = &curve->points[at];
    if (slope) {
        *slope = slice == from->slice ? from->slope : 0;
    }
    if (slice == from->slice) {
        return from->value;
    }
    if (from->ends || at + 1 == curve->count) {
        return from->ends ? none : from->value;
    }
    const cubic_t cubic = cubic_between(from, from + 1);
    return at_slice(&cubic, slice, slope);
}

void wh_path_insert(wh_path_t *curve, int64_t slice, double value) {
    const bool forced = curve->is_forced;
    wh_path_finish(curve);
    curve->is_forced = forced && curve->sample_count > 1;
    if (curve->count == 0 || slice < curve->points[0].slice ||
        slice > curve->points[curve->count - 1].slice) {
        return;
    }
    const size_t at = find(curve, slice);
    if (curve->points[at].slice == slice || curve->points[at].ends) {
        if (curve->points[at].slice == slice) {
            make_exact(curve, at);
        }
        return;
    }
    wh_path_point_t made = {slice, value, 0, true, false};
    (void)wh_path_read(curve, slice, &made.slope);
    curve->points = wh_array_grow(curve->points, curve->count, &curve->capacity, sizeof *curve->points);
    memmove(&curve->points[at + 2], &curve->points[at + 1], (curve->count - at - 1) * sizeof made);
    curve->points[at + 1] = made;
    ++curve->count;
    ++curve->exact_count;
}
