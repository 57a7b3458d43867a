/* Thins a signal that comes sample by sample: it keeps points such that cubics between them stay within a
 * tolerance.
 *
 * A point has the signal's value and its slope. Between two points is the cubic with their values and
 * slopes. Motion with limited jerk consists of such cubics. A move takes about eight points at any
 * distance, where lines would take hundreds. The slopes are its speeds. Every point is a sample. At every
 * sample the curve differs by at most the tolerance. At forced samples, at both sides of a break and while
 * the signal rests it is exact.
 *
 * Samples come in the order of their slices. The samples since the last point are kept, at most
 * WH_PATH_SPAN, until they are too many for one cubic; a rest takes no room.
 */
#ifndef WH_RECORD_PATH_H
#define WH_RECORD_PATH_H

#include "points.h"

#define WH_PATH_SPAN 4096

typedef struct {
    int64_t slice;
    double value;
} wh_sample_t;

/* Read only list and of; the rest is internal. */
typedef struct {
    wh_points_t list;     /* two numbers each: the value and its slope per slice */
    int64_t of;           /* samples so far */
    wh_sample_t *samples; /* the last point, unless the signal broke off, and those after it */
    size_t sample_count, sample_capacity;
    size_t good, next; /* counts of samples: one cubic reaches `good`; the next test is for `next` */
    size_t equal;      /* the number of equal samples at the end */
    bool is_at_rest;   /* since the last point; one sample stands for all */
    bool is_fresh;     /* the last point's slope is not known yet */
    bool is_forced;    /* the last sample must be exact */
} wh_path_t;

static inline double wh_path_value(const wh_path_t *curve, size_t point) {
    return wh_points_numbers(&curve->list, point)[0];
}

static inline double wh_path_slope(const wh_path_t *curve, size_t point) {
    return wh_points_numbers(&curve->list, point)[1];
}

void wh_path_open(wh_path_t *curve, double tolerance, size_t limit);

/* Adds a sample, of a later slice than the last one. Cost: a few ns at rest, about 50 ns in motion. */
void wh_path_add(wh_path_t *curve, int64_t slice, double value);

/* Makes the last sample exact. */
void wh_path_force(wh_path_t *curve);

/* Makes the last sample a point, so that the points cover all samples. More samples may follow. */
void wh_path_finish(wh_path_t *curve);

/* Finishes, and leaves a gap from here to the next sample. */
void wh_path_break(wh_path_t *curve);

/* Makes an earlier sample exact. It becomes a point unless it is in a break. Samples beside it may then be
 * off by twice the tolerance. */
void wh_path_insert(wh_path_t *curve, int64_t slice, double value);

/* The curve's value at a slice: the last point's value after it, NaN before the first point and in a break.
 * `slope` (per slice) may be null. Cost: log n. */
double wh_path_read(const wh_path_t *curve, int64_t slice, double *slope);

/* The last sample's value, whether it is a point or not. False before the first sample and in a break. */
bool wh_path_last(const wh_path_t *curve, double *value);

void wh_path_close(wh_path_t *curve);

#endif
