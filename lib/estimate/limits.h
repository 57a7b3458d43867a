/* An axis's limits of speed, acceleration and jerk from the times that its moves took, as a field log has
 * them.
 *
 * Each time is taken for that of the jerk-limited profile of motion/profile.h over the move's distance.
 * The three limits that come nearest to all times, in the sense of least squares, are searched for from
 * many starts, with robust weights (Tukey's biweight, 4.685 deviations by the median). What is then
 * farther off than 4.685 standard deviations, such as a move with a pause in it, is set aside; the others
 * count alike.
 *
 * A limit is determined only if the moves tell it: no profile without this limit fits them (the squares
 * would grow by more than 25 of their variance), and its standard deviation is below 5 %. For one that is
 * not, the estimate says how large it is at least, and which moves are missing. An axis that never
 * reaches its acceleration has one all the same in a layout: any from "at least" on gives the same times.
 *
 * A delay that is the same in each time (of the line, until the axis has settled) looks much like a low
 * jerk. It is fitted only if asked for. If it is not, and the times have one, they are refused rather
 * than fitted wrongly; so are times that depend on the distance in another way than any profile's.
 *
 * Units: those of the distances (mm, rad or degrees), and seconds. */
#ifndef WH_ESTIMATE_LIMITS_H
#define WH_ESTIMATE_LIMITS_H

#include "../math/config.h"
#include "value.h"

WH_HEADER_BEGIN

/* Moves needed at least, and the most that are looked at. */
#define WH_LIMITS_MOVES 8
#define WH_LIMITS_MOST_MOVES 10000

/* The largest part of the moves that may be set aside. */
#define WH_LIMITS_ASIDE 0.25

/* A move of one axis from rest to rest. */
typedef struct {
    double distance;   /* > 0 */
    double seconds;    /* > 0 */
    bool is_set_aside; /* written */
} wh_timed_move_t;

/* The limits in every list here; the delay is a parameter like them, s. */
enum { WH_LIMIT_SPEED, WH_LIMIT_ACCELERATION, WH_LIMIT_JERK, WH_LIMIT_DELAY, WH_LIMIT_PARAMETERS };

typedef struct {
    wh_status_t status; /* as wh_limits_estimate returns it */
    wh_estimate_value_t values[WH_LIMIT_PARAMETERS];
    double at_least[WH_LIMIT_PARAMETERS]; /* of a limit that is not determined; 0: nothing is known */
    double fitted[WH_LIMIT_PARAMETERS];   /* what wh_limits_seconds takes */
    size_t used, set_aside;
    double rms;                      /* s, of the times that were used */
    double shortest, longest;        /* distance of the moves that were used */
    char reason[WH_ESTIMATE_REASON]; /* what is wrong; or which moves are missing, if one is; else empty */
} wh_limits_estimate_t;

/* Fits the limits. No pointer may be null. Returns
 *   WH_STATUS_NULL_ARGUMENT   nothing is written then
 *   WH_STATUS_BAD_CAPACITY    more than WH_LIMITS_MOST_MOVES
 *   WH_STATUS_OUT_OF_RANGE    a distance or a time is not finite or not > 0
 *   WH_STATUS_TOO_FEW_POINTS  fewer than WH_LIMITS_MOVES, also once some are set aside
 *   WH_STATUS_NO_FIT          too many were set aside, or the times are no profile's: see above
 *   WH_STATUS_NOT_DETERMINED  no limit is determined
 *   WH_OK                     at least one is
 * Cost: about 0.3 ms a move; 300 kB of stack. */
wh_status_t wh_limits_estimate(wh_timed_move_t *moves, size_t count, bool with_delay,
                               wh_limits_estimate_t *estimate);

/* The time that a move over this distance takes by what was fitted: within the distances of the moves
 * that were used it is told even if not all limits are. NaN unless the estimate is WH_OK. */
double wh_limits_seconds(const wh_limits_estimate_t *estimate, double distance);

WH_HEADER_END

#endif
