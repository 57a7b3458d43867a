/* Curves: of a signal that comes sample by sample, the points between which cubics stay within a tolerance.
 *
 * A point has the signal's value and its slope, and between two points the cubic that has both of both counts. What moves with
 * limited jerk is made of such cubics: a move takes about eight points however far it goes, where lines would take
 * hundreds, and the slopes are its speeds. Every point is a sample. At every sample the curve is off by at most the tolerance, at
 * forced ones, at a break's sides and while the signal rests not at all.
 *
 * Samples come in the order of their slices. Those since the last point are kept, at most WH_CURVE_SPAN, until they are too
 * many for one cubic; a rest takes no room. When there are more points than `limit`, beside those that are exact, the
 * tolerance is doubled and they are thinned again: so memory is bounded, but for a signal that jumps without end. Host code:
 * aborts when memory is out.
 */
#ifndef WH_RECORD_PATH_H
#define WH_RECORD_PATH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WH_CURVE_SPAN 4096

typedef struct {
    int64_t slice;
    double value;
    double slope; /* a slice */
    bool exact;   /* on purpose, not for the tolerance's sake */
    bool ends;    /* until the next point there is no signal */
} wh_path_point_t;

typedef struct {
    int64_t slice;
    double value;
} wh_sample_t;

/* Read points, count, tolerance and of; the rest is its own. */
typedef struct {
    double tolerance;
    size_t limit;
    wh_path_point_t *points;
    size_t count, capacity, exact_count;
    int64_t of;           /* samples so far */
    wh_sample_t *samples; /* the last point, unless the signal broke off, and those after it */
    size_t sample_count, sample_capacity;
    size_t good, next; /* of these: one cubic goes to `good`; whether to `next` is asked next */
    size_t equal;      /* of these: so many, the last ones */
    bool is_at_rest;   /* since the last point; one sample stands for all */
    bool is_fresh;     /* the last point's slope is not known yet */
    bool is_forced;    /* the last sample is wanted exactly */
} wh_path_t;

void wh_path_open(wh_path_t *curve, double tolerance, size_t limit);

/* One more sample, of a later slice than the last one. Cost: a few ns at rest, about 50 ns in motion. */
void wh_path_add(wh_path_t *curve, int64_t slice, double value);

/* The last sample is exact. */
void wh_path_force(wh_path_t *curve);

/* The last sample becomes a point, so that the points cover all. More samples may follow. */
void wh_path_finish(wh_path_t *curve);

/* The same, and there is no signal from here to the next sample. */
void wh_path_break(wh_path_t *curve);

/* A sample that has been, and is wanted exactly after all. It becomes a point unless it is in a break; the samples beside it
 * may then be off by twice the tolerance. */
void wh_path_insert(wh_path_t *curve, int64_t slice, double value);

/* What the points say of a slice: the last one's value after it, NaN before the first one and in a break. `slope` (a
 * slice) may be null. Cost: log n. */
double wh_path_read(const wh_path_t *curve, int64_t slice, double *slope);

void wh_path_close(wh_path_t *curve);

#endif
