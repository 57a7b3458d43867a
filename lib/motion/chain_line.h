/* A straight line of a chain's end-effector in base, at constant heading: entries, retractions and strokes.
 *
 * Rail, tilts and flip stand still, so the path lies in the plane that the column carries, and Z takes the
 * part out of it. A polar arm is planned there as motion/line.h plans it. TRZ has no wrist: its lines go
 * along the arm, or straight up and down.
 *
 * A SCARA's line is planned as one axis first, with limits that suit the joints' first derivatives along
 * it. Then speed, acceleration and jerk of each joint are computed by the chain rule at 17 instants of each
 * phase of the profile, or at up to 1025 where they change quickly. The largest value of each phase is
 * raised by a quarter of the largest second difference, to cover values between two instants. If a limit is
 * exceeded, the whole line is slowed uniformly.
 *
 * A line is a plain struct without pointers: copy it freely. All functions are reentrant.
 */
#ifndef WH_MOTION_CHAIN_LINE_H
#define WH_MOTION_CHAIN_LINE_H

#include "chain.h"
#include "line.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(chain_line);

/* The least sine of a SCARA's elbow on a line: closer to straight or folded, no joint speed follows it. */
#define WH_CHAIN_LEAST_SINE WH_REAL(0.01)

/* A planned line. Only wh_chain_line_plan writes it; callers may read from, to and path.slowed. */
typedef struct {
    wh_chain_kind_t kind;
    wh_line_t path; /* polar: the arm's line in the plane; SCARA: its profile, direction and slowed */
    wh_real_t from[WH_CHAIN_AXES], to[WH_CHAIN_AXES];
    wh_real_t links[2];         /* SCARA */
    wh_real_t start_x, start_y; /* SCARA: the wrist in the plane at the start, seen from the shoulder with
                                    * theta at from's */
} wh_chain_line_t;

/* Plans the line from axes from_q over `travel` (mm in base). The chain must pass wh_chain_validate. `caps`
 * are further limits along it; 0 means none. A line without length takes no time. Limits of all axes hold
 * to a relative 1e-9 (1e-4 in float).
 *
 * Errors, which leave *line unchanged:
 *   WH_STATUS_NULL_ARGUMENT
 *   WH_STATUS_NOT_FINITE
 *   WH_STATUS_OUT_OF_RANGE    a negative cap
 *   WH_STATUS_NOT_ALONG_ARM   TRZ: the line leaves the arm's direction by more than WH_SLACK_MM
 *   WH_STATUS_OUT_OF_REACH    R or the elbow leaves its travel, or the line its arm's reach, anywhere on
 *                             it
 *   WH_STATUS_LIMIT_EXCEEDED  another axis leaves its travel; the links of a SCARA reach all of the line, but
 *                             its elbow comes closer to straight or folded than WH_CHAIN_LEAST_SINE says. A
 *                             line straight up or down may be there, since no joint turns on it
 *   WH_STATUS_BAD_LIMITS      see wh_line_plan
 * Cost: about 0.5 us; 40 us for a SCARA, up to 2 ms past its shoulder. */
wh_status_t wh_chain_line_plan(wh_chain_line_t *line, const wh_chain_t *chain,
                               const wh_real_t from_q[WH_CHAIN_AXES], const wh_vec3_t *travel,
                               const wh_line_caps_t *caps) WH_SYMBOL(wh_chain_line_plan);

/* s, never negative. */
static inline wh_real_t wh_chain_line_duration(const wh_chain_line_t *line) {
    return wh_line_duration(&line->path);
}

/* Writes the axes at `t` seconds after the start: exactly `from` for t <= 0 (and NaN), exactly `to` from
 * the duration on. In between the end-effector is on the line to 1e-9 mm (1e-2 in float), and its heading
 * is kept to 1e-12 rad. All angles are continuous. No pointer may be null. Cost: about 40 ns; 150 ns for a
 * SCARA. */
void wh_chain_line_at(const wh_chain_line_t *line, wh_real_t t, wh_real_t q[WH_CHAIN_AXES])
    WH_SYMBOL(wh_chain_line_at);

WH_HEADER_END

#endif
