/* A station's frame from points: the station's pose in base, from touched points whose places on the
 * station are known.
 *
 * The frame is the rotation and shift that bring the known points nearest to the touched ones by least
 * squares. It uses the singular value decomposition of their products (W. Kabsch, 1976; S. Umeyama, 1991,
 * whose sign keeps it from mirroring). A point that contradicts the others is set aside: its distance from
 * its place by the others exceeds WH_FRAME_ASIDE_SDS standard deviations, or more if few points determine
 * these. The others count equally. Standard deviations come from their residuals; there are (3 used - 6)
 * more residuals than unknowns. With three points they are rough, and none can be set aside.
 *
 * Lengths are in mm, angles in rad. */
#ifndef WH_ESTIMATE_FRAME_H
#define WH_ESTIMATE_FRAME_H

#include "../math/pose.h"
#include "value.h"

WH_HEADER_BEGIN

/* The least number of points. */
#define WH_FRAME_POINTS 3

/* A frame is refused if the rms of its residuals exceeds this part of the known points' own rms distance
 * from their centre: points or units were then mixed up. */
#define WH_FRAME_MISFIT 0.05

/* The largest part of the points that may be set aside, and their least distance. */
#define WH_FRAME_ASIDE 0.25
#define WH_FRAME_ASIDE_SDS 6

/* The points count as lying on a line if their rms distance from it is below this number of rms of the
 * residuals, or below this part of their rms distance along it. */
#define WH_FRAME_SPREAD_RMS 10
#define WH_FRAME_SPREAD_PART 1e-3

typedef struct {
    wh_vec3_t touched; /* in base */
    wh_vec3_t known;   /* on the station */
    bool is_set_aside; /* an output */
} wh_frame_point_t;

typedef struct {
    wh_status_t status; /* as wh_frame_estimate returns it; the rest has no meaning unless WH_OK */
    wh_pose_t base_from_station;
    double rpy[3], rpy_sd[3]; /* R = Rz(rpy[2]) * Ry(rpy[1]) * Rx(rpy[0]), rad */
    double at_sd[3];          /* mm, in base */
    size_t used, set_aside;   /* points */
    double rms;               /* of the residuals: root of their mean square length over the points used */
    double largest;           /* the longest residual of them */
    size_t largest_index;
    char reason[WH_ESTIMATE_REASON]; /* reason of a status other than WH_OK; otherwise empty */
} wh_frame_estimate_t;

/* Fits the frame. `points` and `estimate` must not be null; the points' numbers must be finite. Returns
 *   WH_STATUS_NULL_ARGUMENT   nothing is written then
 *   WH_STATUS_TOO_FEW_POINTS  fewer than WH_FRAME_POINTS
 *   WH_STATUS_NOT_DETERMINED  the known points lie on a line, or at one place; or the station is turned
 *                             about y by 90 degrees, where rpy is not unique
 *   WH_STATUS_NO_FIT          see WH_FRAME_MISFIT, or a number is not finite
 * Cost: a quarter of the number of points, squared, times about 0.1 us. */
wh_status_t wh_frame_estimate(wh_frame_point_t *points, size_t count, wh_frame_estimate_t *estimate);

/* The touched point minus its place in the frame, mm in base. */
wh_vec3_t wh_frame_residual(const wh_frame_estimate_t *estimate, const wh_frame_point_t *point);

WH_HEADER_END

#endif
