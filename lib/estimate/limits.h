/* An axis's limits of speed, acceleration and jerk from the durations of its moves, as a field log has
 * them.
 *
 * Each time counts as that of the jerk-limited profile of motion/profile.h over the move's distance. The
 * search finds the three limits that come nearest to all times by least squares. It begins at many starts,
 * with robust weights (Tukey's biweight, 4.685 deviations by the median). A move that then deviates by more
 * than 4.685 standard deviations, such as one with a pause in it, is set aside; the others count equally.
 *
 * A limit is determined only if the moves tell it: no profile without this limit fits them (the squares
 * would grow by more than 25 of their variance), and its standard deviation is below 5 %. For one that is
 * not, the estimate says how large it surely is at least, and which moves are missing. Such a bound is no
 * value for a layout: times by it may be worse by those 25 variances. An axis that never reaches its
 * acceleration has one all the same in a layout: any from sqrt(speed * jerk) on gives the same times, and the
 * reason tells that number.
 *
 * A constant delay in each time (of the line, until the axis has settled) looks much like a low jerk. It is
 * fitted only on request. Without that, times with a delay are refused and not fitted wrongly. Times that
 * depend on the distance in another way than any profile's are refused, too.
 *
 * Units are those of the distances (mm, rad or degrees), and seconds. */
#ifndef WH_ESTIMATE_LIMITS_H
#define WH_ESTIMATE_LIMITS_H

#include "../math/config.h"
#include "value.h"

WH_HEADER_BEGIN

/* The least number of moves, and the most that are used. */
#define WH_LIMITS_MOVES 8
#define WH_LIMITS_MOST_MOVES 10000

/* The largest part of the moves that may be set aside. */
#define WH_LIMITS_ASIDE 0.25

/* A move of one axis from rest to rest. */
typedef struct {
    double distance;   /* > 0 */
    double seconds;    /* > 0 */
    bool is_set_aside; /* an output */
} wh_timed_move_t;

/* The limits in every list here; the delay is a parameter, too, s. */
enum { WH_LIMIT_SPEED, WH_LIMIT_ACCELERATION, WH_LIMIT_JERK, WH_LIMIT_DELAY, WH_LIMIT_PARAMETERS };

typedef struct {
    wh_status_t status; /* as wh_limits_estimate returns it */
    wh_estimate_value_t values[WH_LIMIT_PARAMETERS];
    double at_least[WH_LIMIT_PARAMETERS]; /* lower bound of an undetermined limit; 0: nothing is known */
    double fitted[WH_LIMIT_PARAMETERS];   /* input of wh_limits_seconds */
    size_t used, set_aside;
    double rms;                      /* s, of the times that were used */
    double shortest, longest;        /* distance of the moves that were used */
    char reason[WH_ESTIMATE_REASON]; /* the error; or the missing moves, if any; else empty */
} wh_limits_estimate_t;

/* Fits the limits. No pointer may be null. Returns
 *   WH_STATUS_NULL_ARGUMENT   nothing is written then
 *   WH_STATUS_BAD_CAPACITY    more than WH_LIMITS_MOST_MOVES
 *   WH_STATUS_OUT_OF_RANGE    a distance or a time is not finite or not > 0
 *   WH_STATUS_TOO_FEW_POINTS  fewer than WH_LIMITS_MOVES, also once some are set aside
 *   WH_STATUS_NO_FIT          too many were set aside, or the times are no profile's: see above
 *   WH_STATUS_NOT_DETERMINED  no limit is determined
 *   WH_OK                     at least one is
 * Cost: about 0.3 ms for each move; 300 kB of stack. */
wh_status_t wh_limits_estimate(wh_timed_move_t *moves, size_t count, bool with_delay,
                               wh_limits_estimate_t *estimate);

/* The time of a move over this distance by the fitted values. Within the distances of the used moves it is
 * valid even if not all limits are determined. It is NaN unless the estimate is WH_OK. */
double wh_limits_seconds(const wh_limits_estimate_t *estimate, double distance);

WH_HEADER_END

#endif
