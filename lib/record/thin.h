/* Thinning of poses, and of any signal that lines are to show: of a signal that comes sample by sample, the
 * points between which straight lines stay within a tolerance.
 *
 * A sample has up to WH_THIN_WIDTH numbers, read between points as linear in time; of a pose the last four
 * are a quaternion (x, y, z, w), read as the shorter slerp. Every point is a sample. Each number of a sample,
 * and of a rotation the angle that is missing, is off by at most the tolerance; forced samples are not off at
 * all.
 *
 * Samples come in the order of their slices, nothing is looked at twice: from the last point the slopes are
 * kept that miss no sample since, and the sample that has none among them comes after a new point. A signal
 * that turns by more than WH_THIN_TURN from sample to sample cannot be thinned. Host code: aborts if out of
 * memory.
 */
#ifndef WH_RECORD_THIN_H
#define WH_RECORD_THIN_H

#include "../math/pose.h"
#include "points.h"

#define WH_THIN_WIDTH 7

/* A rotation between two points is at most this, rad, so that there is no doubt which way is the shorter
 * one. */
#define WH_THIN_TURN 2.5

typedef struct {
    int64_t slice;
    double values[WH_THIN_WIDTH];
} wh_thin_sample_t;

/* Read list, turns, turn, of and last; the rest is its own. */
typedef struct {
    wh_points_t list;      /* of a pose the quaternion is among the numbers */
    bool turns;            /* the last four are a quaternion */
    double turn;           /* the tolerance of a rotation, rad */
    int64_t of;            /* samples so far */
    wh_thin_sample_t last; /* the last one */
    bool is_pending;       /* `last` is not among the points */
    bool is_forced;        /* and must be, unless the signal rests from the last point to it */
    double low[WH_THIN_WIDTH], high[WH_THIN_WIDTH]; /* slopes that miss no sample since the last point */
    double moved[WH_THIN_WIDTH];                    /* of `last` from the last point */
} wh_thin_t;

/* An empty signal of `width` numbers; with `turn` above 0 four more for a quaternion. */
void wh_thin_open(wh_thin_t *thin, size_t width, double tolerance, double turn, size_t limit);

/* One more sample, of a later slice than the last one. Cost: about 20 ns, 100 ns where a rotation changes. */
void wh_thin_add(wh_thin_t *thin, int64_t slice, const double values[]);

/* The same of a pose: three numbers and a quaternion, of the two the one that is nearer to the last
 * sample's. */
void wh_thin_add_pose(wh_thin_t *thin, int64_t slice, const wh_pose_t *pose);

/* The last sample is exact. */
void wh_thin_force(wh_thin_t *thin);

/* The last sample becomes a point, so that the points cover all. More samples may follow. */
void wh_thin_finish(wh_thin_t *thin);

/* What the points say of a slice; the first point's values before it, the last one's after it. Cost: log
 * n. */
void wh_thin_read(const wh_thin_t *thin, int64_t slice, double values[]);
void wh_thin_read_pose(const wh_thin_t *thin, int64_t slice, wh_pose_t *pose);

void wh_thin_close(wh_thin_t *thin);

#endif
