/* Grips: a step of the grasp table in which each gripper has vacuum, an edge grip or passive pads, and
 * wafers may lie and be held face down.
 *
 * wh_grips_step replaces wh_grasp_step (grasp.h). If all grippers have vacuum and all wafers show them
 * their backs, a table goes through equal bits with both. Each slice:
 *   1. Read all inputs; if one is invalid, refuse the whole step.
 *   2. Plungers move, wafers are carried and released, by gripper, in the order of their indices:
 *      vacuum   as in grasp.h.
 *      edge     With the valve closed the plunger goes back by speed * dt, not beyond `retracted`, and a
 *               wafer is let go at once: it stays where its gripper, at this slice's pose, carries it. With
 *               the valve open a CLOSING plunger goes on by speed * dt, as far as it can (edge.h), an OPENING
 *               one goes back as above. A carried wafer moves over the blade as edge.h says, its angle and
 *               its height over the blade are kept. When the plunger stands: held, it is CLOSED. Else the
 *               wafer is let go there, if it was carried; MISSED in the window overtravel, JAMMED elsewhere.
 *               At the end of its stroke a plunger stands, seated or not: what is not held there is MISSED,
 *               for `end` is in the window overtravel. With a speed of 0 (`speeds`) it stays where it is, and
 *               in its phase: CLOSING and OPENING go on later, CLOSED does not let go.
 *      passive  A carried wafer is left on the support with the lowest index that takes it over, by
 *               wh_passive_step; otherwise it moves on with the pads. The valve has no effect.
 *   3. Pick, by gripper, in the order of their indices. A gripper that began the slice with a wafer does not
 *      pick. Vacuum and edge may take a wafer that was released in this slice: a hand-over.
 *      vacuum   as in grasp.h, with the faces towards the gripper at the slice's end.
 *      edge     With the valve open, an OPEN gripper begins to close: from the next slice on its plunger
 *               moves. It meets a free wafer if (6) and (8) hold between the gripper and the face towards
 *               it, and |x| and |y| of that face's centre in the gripper's frame are <= 50 mm and <= R0 / 2.
 *               With several it meets the one with the smallest |dr_proj_z|, then the lowest index. If
 *               sqrt(x^2 + y^2) <= clearance, the gripper takes it: the wafer is carried from now
 *               on. Otherwise the wafer stays free, and its present place over the blade determines where
 *               the plunger meets it. With swept checking, too, all this is tested at the slice's end.
 *      passive  The pads take a free wafer that was not released in this slice, if wh_passive_step takes it
 *               between the pads of the last slice and of this one, over the wafer's support
 *               (wh_grips_support). With several they take the one with the largest lift at the begin, then
 *               the lowest index. Before a table's first step the pads are where they are after it.
 *   4. Releases are reported; then near misses and contests of grippers with vacuum, as in grasp.h, with
 *      the faces towards them. A contested wafer may be on any gripper.
 * So a wafer is carried by one gripper, or by none; only a support can take it off passive pads.
 *
 * Events are those of grasp.h, with `face`. `measured` is of that face, the one towards the gripper at the
 * end of slice `measured_slice`, and of the pose in that slice. For a swept pick by vacuum it is of the
 * pick's instant. For a wafer that passive pads take it is as the wafer lies on them. It is judged by the
 * table's tolerance, also by (7) where that does not count. A jam and a miss are not events: wh_grip_state_t
 * has them. `seat` is only for vacuum.
 *
 * All state is in the table's arrays of wafers and grippers, its `slice`, and `states`. If these are copied
 * out and back between two steps, a run continues with equal bits.
 *
 * The caller owns the memory; nothing is allocated, nothing is static. A firmware that does not call
 * wh_grips_init does not link any of it, and its wh_grasp_step costs no more.
 *
 * Bytes of stack and of memory on a Cortex-M7 in double and on a Cortex-M4F in float, by gcc 12
 * (tests/verify/footprint):
 *                                             M7 -O2    -Os  M4F -O2    -Os
 *     stack of wh_grips_init                   432    528     352    336
 *     stack of wh_grips_step                  1952   2008    1120   1152
 *     stack of wh_grips_support                416    480     232    268
 *     stack of wh_grips_hash                   156    184     152    184
 *     size of wh_grip_t                         88             88
 *     size of wh_grip_state_t                  104             96
 *     size of wh_grips_t                        64             64
 */
#ifndef WH_GRASP_GRIPS_H
#define WH_GRASP_GRIPS_H

#include "edge.h"
#include "grasp.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(grips);

typedef enum WH_FOUR_BYTES { WH_GRIP_VACUUM, WH_GRIP_EDGE, WH_GRIP_PASSIVE } wh_grip_kind_t;

/* One gripper's grip. It must not change during a run. */
typedef struct {
    wh_grip_kind_t kind;
    wh_edge_t edge; /* only with WH_GRIP_EDGE */
} wh_grip_t;

/* The phase of an edge grip; vacuum and passive pads are always OPEN. */
typedef enum WH_FOUR_BYTES {
    WH_GRIP_OPEN,    /* the plunger is retracted */
    WH_GRIP_CLOSING, /* the plunger moves forwards */
    WH_GRIP_CLOSED,  /* it holds its wafer */
    WH_GRIP_JAMMED,  /* the plunger stands, and holds nothing: a wafer is in the way, or far too large */
    WH_GRIP_MISSED,  /* the plunger stands, with no wafer in reach, or one far too small */
    WH_GRIP_OPENING  /* the plunger moves back */
} wh_grip_phase_t;

/* One gripper after the last step. It is read only. */
typedef struct {
    wh_grip_phase_t phase;
    int32_t wafer;         /* the wafer that the closing plunger met or will meet; WH_NONE */
    double s;              /* of the plunger, mm (edge.h) */
    double excess;         /* JAMMED: mm beyond the clearance, 0 for a wafer that is too large; else 0 */
    wh_edge_wafer_t lying; /* that wafer, as it lay on the blade when the plunger started */
    wh_real_t x, y;        /* of gripper_from_wafer at that time; 0 if it was not taken */
} wh_grip_state_t;

/* The data that a table needs in addition to its own arrays. The arrays belong to the caller, live as long
 * as the table and serve only it; const arrays do not change. */
typedef struct {
    wh_real_t thickness;           /* of each wafer, mm, 0 to WH_FACE_THICKEST; 0: only backs are seen */
    double dt;                     /* of a slice, s, above 0, up to 3600 */
    const wh_grip_t *grips;        /* one for each gripper */
    const wh_edge_wafer_t *shapes; /* one for each wafer, with the notch's axis in its frame and x and y 0;
                                    * null if no gripper has an edge grip */
    const wh_pose_t *supports;     /* planes on which wafers lie, e3 upwards: base_from_support */
    size_t support_count;          /* up to INT32_MAX */
    wh_grip_state_t *states;       /* one for each gripper */
    wh_wafer_t *seen;              /* one for each wafer: for a step's own use */
    const double *speeds; /* one for each gripper: the limit of its plunger's speed in the next step, mm/s,
                           * 0 or more; null: the edge grip's own speed */
} wh_grips_parts_t;

typedef struct {
    wh_grips_parts_t parts;
    wh_grasp_t *table;
    uint32_t mark;   /* WH_GRIPS_MARK once wh_grips_init has set it up */
    uint32_t number; /* the table's `grips`, if these grips step it */
} wh_grips_t;

#define WH_GRIPS_MARK UINT32_C(0x6b0f7a35)

/* A wafer that is lower than its support's plane by less than this, mm, lies on it: rounding. */
#if defined(WH_FLOAT)
#define WH_GRIPS_FLAT WH_REAL(1e-3)
#else
#define WH_GRIPS_FLAT WH_REAL(1e-6)
#endif

/* Sets up the grips of an initialised table without buckets whose grippers hold nothing: plungers are
 * retracted. From then on only these grips step the table, until it is set up again or gets others:
 * wh_grasp_step and earlier grips are refused. It refuses, and changes nothing: null pointers, except for an
 * array whose count is 0 and for shapes as described above (WH_STATUS_NULL_ARGUMENT); a table that is not
 * initialised (WH_STATUS_NOT_INITIALISED); buckets, too many supports (WH_STATUS_BAD_CAPACITY); a gripper
 * that holds a wafer (WH_STATUS_HELD); a thickness or dt that is NaN or infinite (WH_STATUS_NOT_FINITE) or
 * out of its range, an unknown kind (WH_STATUS_OUT_OF_RANGE); an edge grip that wh_edge_validate refuses, a
 * shape with it that wh_edge_wafer_validate refuses, and a support that wh_pose_validate refuses; grips,
 * states, `seen` or an array of the table that shares bytes with another one of these or with the other
 * arrays (WH_STATUS_OVERLAP). Cost: linear in grippers, wafers and supports, and in wafers for each edge
 * grip. */
wh_status_t wh_grips_init(wh_grips_t *grips, const wh_grips_parts_t *parts, wh_grasp_t *table)
    WH_SYMBOL(wh_grips_init);

/* One slice, as described at the top. It refuses like wh_grasp_step. It also refuses grips that are null,
 * not initialised or no longer the table's (WH_STATUS_NULL_ARGUMENT, WH_STATUS_NOT_INITIALISED), and, as a
 * gripper's bad input, a speed of `speeds` that is NaN, infinite (WH_STATUS_NOT_FINITE) or below 0
 * (WH_STATUS_OUT_OF_RANGE). Cost: that of wh_grasp_step without buckets; each gripper with vacuum adds a
 * check of each wafer, and a copy of all if one shows it its front; a plunger that moves adds wh_edge_at;
 * passive pads add wh_passive_step for each free wafer in reach, or with one on them for each support in
 * reach, and a few products for each of the others. */
wh_status_t wh_grips_step(wh_grips_t *grips, const wh_gripper_input_t *inputs, wh_event_list_t *list)
    WH_SYMBOL(wh_grips_step);

/* The support that a wafer lies on, or WH_NONE if it is carried or lies on none. Its height over it
 * (passive.h) is at least -WH_GRIPS_FLAT and below eps_projz, and (7) and (8) hold between the support and
 * the face towards it. If there are several, it is the one with the smallest height, then the lowest index.
 * Nothing is checked. Cost: linear in supports. */
int32_t wh_grips_support(const wh_grips_t *grips, size_t wafer) WH_SYMBOL(wh_grips_support);

/* Completes states that came from elsewhere, such as from a message, and checks whether a step can have
 * left them with these grippers. It uses of each state phase, wafer, s and excess, and while the plunger
 * closes on a wafer x, y and, in `lying`, the place and the notch's axis. It fills in the rest: the
 * wafer's shape, and all of a state that is OPEN. Returns WH_OK, WH_STATUS_NOT_FINITE, or the status of
 * wh_edge_wafer_validate. Returns WH_STATUS_OUT_OF_RANGE for these: vacuum that carries a wafer with a
 * closed valve; an unknown phase or one that the grip does not have; a wafer that does not exist or is not
 * the gripper's own, or is carried where the phase says otherwise; an s outside of the stroke; an excess
 * below 0, above 1000 or with another phase than JAMMED. If it refuses, some states may be completed.
 * Cost: linear in grippers. */
wh_status_t wh_grips_complete(const wh_grips_parts_t *parts, const wh_gripper_t grippers[],
                              size_t gripper_count, size_t wafer_count, wh_grip_state_t states[])
    WH_SYMBOL(wh_grips_complete);

/* wh_grasp_hash, continued with the words of each gripper with another grip than vacuum: the grip's kind,
 * phase, wafer, s and excess, and while it closes x and y and the eight numbers of `lying`, in the order of
 * their structs. Nothing is checked. */
uint64_t wh_grips_hash(const wh_grips_t *grips) WH_SYMBOL(wh_grips_hash);

WH_HEADER_END

#endif
