/* A straight line of a chain's end-effector in base, at constant heading: entries, retractions and strokes.
 *
 * Rail, tilts and flip stand still, so the way lies in the plane that the column carries, and Z takes what
 * leads out of it. A polar arm is planned there as motion/line.h plans it. TRZ has no wrist: its lines lead
 * along the arm, or straight up and down.
 *
 * A SCARA's line is planned as one axis first, with limits that suit the joints' first derivatives along it.
 * Then speed, acceleration and jerk of each joint are computed by the chain rule at 17 instants of each phase
 * of the profile, or at up to 1025 where they change quickly. The largest of each phase is raised by a
 * quarter of the largest second difference, for what may lie between two instants. If a limit is exceeded,
 * the whole line is slowed uniformly.
 *
 * A line is a plain struct without pointers: copy it freely. All functions are reentrant.
 */
#ifndef WH_MOTION_CHAIN_LINE_H
#define WH_MOTION_CHAIN_LINE_H

#include "chain.h"
#include "line.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(chain_line);

/* A planned line. Written by wh_chain_line_plan only; reading from, to and path.slowed is fine. */
typedef struct {
    wh_chain_kind_t kind;
    wh_line_t path; /* polar: the arm's line in the plane; of a SCARA its profile, direction and slowed */
    wh_real_t from[WH_CHAIN_AXES], to[WH_CHAIN_AXES];
    wh_real_t links[2];         /* SCARA */
    wh_real_t start_x, start_y; /* SCARA: the wrist in the plane at the start, seen from the shoulder with
                                    * theta at from's */
} wh_chain_line_t;

/* Plans the line from axes from_q over `travel` (mm in base). The chain must pass wh_chain_validate. `caps`
 * are further limits along it, 0 is none. A line without length takes no time. Limits of all axes hold to
 * 1e-9 (1e-4 in float) of themselves.
 *
 * Errors, *line then unchanged:
 *   WH_STATUS_NULL_ARGUMENT
 *   WH_STATUS_NOT_FINITE
 *   WH_STATUS_OUT_OF_RANGE    a negative cap
 *   WH_STATUS_NOT_ALONG_ARM   TRZ: the line leads aside by more than WH_SLACK_MM
 *   WH_STATUS_OUT_OF_REACH    R or the elbow leaves its travel, or the line its arm's reach, anywhere on
 *                             it; a SCARA's elbow comes closer than 0.01 rad to straight or folded
 *   WH_STATUS_LIMIT_EXCEEDED  another axis leaves its travel
 *   WH_STATUS_BAD_LIMITS      see wh_line_plan
 * Cost: about 0.5 us; 40 us for a SCARA, up to 2 ms past its shoulder. */
wh_status_t wh_chain_line_plan(wh_chain_line_t *line, const wh_chain_t *chain,
                               const wh_real_t from_q[WH_CHAIN_AXES], const wh_vec3_t *travel,
                               const wh_line_caps_t *caps) WH_SYMBOL(wh_chain_line_plan);

/* s, never negative. */
static inline wh_real_t wh_chain_line_duration(const wh_chain_line_t *line) {
    return wh_line_duration(&line->path);
}

/* Writes the axes at `t` seconds after the start: exactly `from` for t <= 0 (and NaN), exactly `to` from the
 * duration on. In between the end-effector is on the line to 1e-9 mm (1e-2 in float), and its heading is kept
 * to 1e-12 rad. All angles run on continuously. No pointer may be null. Cost: about 40 ns; 150 ns for a
 * SCARA. */
void wh_chain_line_at(const wh_chain_line_t *line, wh_real_t t, wh_real_t q[WH_CHAIN_AXES])
    WH_SYMBOL(wh_chain_line_at);

WH_HEADER_END

#endif
