/* Thinning of poses, and of any signal that lines are to show: of a signal that comes sample by sample, the points between
 * which straight lines stay within a tolerance.
 *
 * A sample has up to WH_THIN_WIDTH numbers, read between points as linear in time; of a pose the last four are a
 * quaternion (x, y, z, w), read as the shorter slerp. Every point is a sample. Each number of a sample, and of a
 * rotation the angle that is missing, is off by at most the tolerance; forced samples are not off at all.
 *
 * Samples come in the order of their slices, nothing is looked at twice: from the last point the slopes are kept that
 * miss no sample since, and the sample that has none among them comes after a new point. When there are more points than
 * `limit`, beside those that are exact, the tolerance is doubled and they are thinned again: so memory is bounded, but for
 * a signal that turns by more than WH_THIN_TURN from sample to sample, or jumps without end. Host code: aborts when memory is out.
 */
#ifndef WH_RECORD_THIN_H
#define WH_RECORD_THIN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WH_THIN_WIDTH 7

/* A rotation between two points is at most this, rad, so that there is no doubt which way is the shorter one. */
#define WH_THIN_TURN 2.5

typedef struct {
    int64_t slice;
    double values[WH_THIN_WIDTH];
    bool exact; /* on purpose, not for the tolerance's sake */
} wh_thin_point_t;

/* Read points, count, tolerance, turn and of; the rest is its own. */
typedef struct {
    size_t width;           /* numbers of a sample, quaternion included */
    bool turns;             /* the last four are a quaternion */
    double tolerance, turn; /* of each number, in its unit; of a rotation, rad */
    size_t limit;
    wh_thin_point_t *points;
    size_t count, capacity, exact_count;
    int64_t of;             /* samples so far */
    wh_thin_point_t anchor; /* the last of the points */
    wh_thin_point_t last;   /* the last sample */
    bool is_pending;        /* `last` is not among the points */
    bool is_forced;         /* and must be, unless the signal rests from the last point to it */
    double low[WH_THIN_WIDTH], high[WH_THIN_WIDTH]; /* slopes that miss no sample since the last point */
    double moved[WH_THIN_WIDTH];                    /* of `last` from the last point */
} wh_thin_t;

/* An empty signal of `width` numbers; with `turn` above 0 four more for a quaternion. */
void wh_thin_open(wh_thin_t *thin, size_t width, double tolerance, double turn, size_t limit);

/* One more sample, of a later slice than the last one. Cost: about 20 ns, 100 ns where a rotation changes. */
void wh_thin_add(wh_thin_t *thin, int64_t slice, const double values[]);

/* The last sample is exact. */
void wh_thin_force(wh_thin_t *thin);

/* The last sample becomes a point, so that the points cover all. More samples may follow. */
void wh_thin_finish(wh_thin_t *thin);

/* What the points say of a slice; the first point's values before it, the last one's after it. Cost: log n. */
void wh_thin_read(const wh_thin_t *thin, int64_t slice, double values[]);

void wh_thin_close(wh_thin_t *thin);

#endif
