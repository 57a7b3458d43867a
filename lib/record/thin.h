/* Thins a signal that comes sample by sample, such as poses: it keeps points such that straight lines
 * between them stay within a tolerance.
 *
 * A sample has up to WH_THIN_WIDTH numbers, linear in time between points. The last four numbers of a pose
 * are a quaternion (x, y, z, w), with the shorter slerp between points. Every point is a sample. Each
 * number of a sample differs by at most the tolerance, a rotation by at most an angle of `turn`; forced
 * samples are exact.
 *
 * Samples come in the order of their slices, and each is read once. The fit keeps the range of slopes from
 * the last point that fit all samples since. When a sample lies outside, the one before it becomes a point.
 * A signal that turns by more than WH_THIN_TURN from sample to sample cannot be thinned.
 */
#ifndef WH_RECORD_THIN_H
#define WH_RECORD_THIN_H

#include <stdint.h>
#include <string.h>

#include "../math/pose.h"
#include "points.h"

#define WH_THIN_WIDTH 7

/* The largest rotation between two points, rad: small enough that the shorter way is certain. */
#define WH_THIN_TURN 2.5

typedef struct {
    int64_t slice;
    double values[WH_THIN_WIDTH];
} wh_thin_sample_t;

/* Read only list, turns, turn, of and last; the rest is internal. */
typedef struct {
    wh_points_t list;      /* the numbers of a pose include the quaternion */
    bool turns;            /* the last four are a quaternion */
    double turn;           /* the tolerance of a rotation, rad */
    int64_t of;            /* samples so far */
    wh_thin_sample_t last; /* the last one */
    bool is_pending;       /* `last` is not among the points */
    bool is_forced;        /* it must become one, unless the signal rests from the last point to it */
    double low[WH_THIN_WIDTH], high[WH_THIN_WIDTH]; /* slopes from the last point that fit later samples */
    double moved[WH_THIN_WIDTH];                    /* of `last` from the last point */
    bool has_moved;                                 /* `moved` is known */
    bool has_rested; /* since the last point, until `last`; then neither it nor the slopes are known */
    wh_pose_t pose;  /* of `last`, if it was added as a pose */
} wh_thin_t;

/* True if two poses have the same bits. By words: a library's memcmp may go by bytes. */
static inline bool wh_thin_is_same_pose(const wh_pose_t *a, const wh_pose_t *b) {
    uint64_t of_a[sizeof *a / sizeof(uint64_t)];
    uint64_t of_b[sizeof *b / sizeof(uint64_t)];
    uint64_t differ = 0;
    memcpy(of_a, a, sizeof of_a);
    memcpy(of_b, b, sizeof of_b);
    for (size_t i = 0; i < sizeof of_a / sizeof of_a[0]; ++i) {
        differ |= of_a[i] ^ of_b[i];
    }
    return differ == 0;
}

/* Opens an empty signal of `width` numbers; with `turn` above 0 it has four more for a quaternion. */
void wh_thin_open(wh_thin_t *thin, size_t width, double tolerance, double turn, size_t limit);

/* Adds a sample, of a later slice than the last one. Cost: about 5 ns at rest, else 20, 100 where a rotation
 * changes. */
void wh_thin_add(wh_thin_t *thin, int64_t slice, const double values[]);

/* Adds a pose: three numbers and a quaternion, with the sign nearer to the last sample's. A pose that stays
 * costs about 10 ns. */
void wh_thin_add_pose(wh_thin_t *thin, int64_t slice, const wh_pose_t *pose);

/* Makes the last sample exact. */
void wh_thin_force(wh_thin_t *thin);

/* Makes the last sample a point, so that the points cover all samples. More samples may follow. */
void wh_thin_finish(wh_thin_t *thin);

/* The signal at a slice; before the first point and after the last one those points' values. Cost: log n. */
void wh_thin_read(const wh_thin_t *thin, int64_t slice, double values[]);
void wh_thin_read_pose(const wh_thin_t *thin, int64_t slice, wh_pose_t *pose);

void wh_thin_close(wh_thin_t *thin);

#endif
