/* Grips: a step of the grasp table in which each gripper has vacuum, an edge grip or passive pads, and wafers
 * may lie and be held face down.
 *
 * wh_grips_step stands in the place of wh_grasp_step (grasp.h). A table whose grippers all have vacuum and
 * whose wafers all show them their backs goes through the same bits with both. Each slice:
 *   1. Read all inputs; if one is invalid, refuse the whole step.
 *   2. Plungers move, wafers are carried, and let go of, by gripper, in the order of their indices:
 *      vacuum   as in grasp.h.
 *      edge     With the valve closed the plunger goes back by speed * dt, not beyond `retracted`, and a
 *               wafer is let go at once: it stays where its gripper, at this slice's pose, carries it. With
 *               the valve open a CLOSING plunger goes on by speed * dt, as far as it can (edge.h), an OPENING
 *               one goes back as above. A carried wafer moves over the blade as edge.h says, its angle and
 *               its height over the blade are kept. When the plunger stands: held, it is CLOSED. Else the
 *               wafer is let go there, if it was carried; MISSED in the window overtravel, JAMMED elsewhere.
 *               A plunger with a speed of 0 (`speeds`) stays where it is: CLOSED it does not let go.
 *      passive  A carried wafer is left on the support with the lowest index that takes it over, by
 *               wh_passive_step; else it goes on with the pads. The valve does not count.
 *   3. Pick, by gripper, in the order of their indices. A gripper that began the slice with a wafer does not
 *      pick. A wafer that was let go in this slice may be taken in it by vacuum and edge: a hand-over.
 *      vacuum   as in grasp.h, of the faces that look at the gripper at the slice's end.
 *      edge     With the valve open, an OPEN gripper begins to close: from the next slice on its plunger
 *               moves. Of the wafers that nobody holds, with (6) and (8) between gripper and the face that
 *               looks at it, and |x| and |y| of that face's centre in the gripper's frame <= 50 mm and <= R0
 *               / 2, it meets the one with the smallest |dr_proj_z|, of equal ones the lowest index. If
 *               sqrt(x^2 + y^2) <= clearance, it takes it: the wafer is carried from now on. Else the
 *               wafer stays free, and its place over the blade of now tells where the plunger meets it.
 *               Where checking is swept, too, all this is asked of the slice's end.
 *      passive  Of the wafers that nobody holds, and that were not let go in this slice, those that
 *               wh_passive_step takes, between the pads of the last slice and of this one and over the
 *               wafer's support (wh_grips_support). It takes the one whose lift at the begin was the
 *               largest, of equal ones the lowest index. Before a table's first step the pads are where they
 *               are after it.
 *   4. Releases are reported; then near misses and contests of grippers with vacuum, as in grasp.h, of the
 *      faces that look at them. A contested wafer may be on any gripper.
 * So a wafer is carried by one gripper, or by none; it is never taken off passive pads but by a support.
 *
 * Events are those of grasp.h, with `face`. `measured` is of that face and the slice's pose, or a swept
 * pick's by vacuum, judged by the table's tolerance, (7) too where it does not count; of a wafer that passive
 * pads take, as it lies on them. A jam and a miss are no events: wh_grip_state_t has them. `seat` is for
 * vacuum alone.
 *
 * All state is in the table's arrays of wafers and grippers, its `slice`, and `states`: copied out and back
 * between two steps, a run goes on with the same bits.
 *
 * Memory is the caller's; nothing is allocated, nothing is static. A firmware that does not call
 * wh_grips_init does not link any of it, and wh_grasp_step costs what it costs without.
 *
 * Bytes of stack and of memory on a Cortex-M7 in double and on a Cortex-M4F in float, by gcc 12
 * (tests/verify/footprint):
 *                                             M7 -O2    -Os  M4F -O2    -Os
 *     stack of wh_grips_init                   152    216     232    224
 *     stack of wh_grips_step                  1840   1912    1424   1384
 *     stack of wh_grips_support                416    424     232    244
 *     stack of wh_grips_hash                   156    180     148    176
 *     size of wh_grip_t                         88             88
 *     size of wh_grip_state_t                  104             96
 *     size of wh_grips_t                        56             56
 */
#ifndef WH_GRASP_GRIPS_H
#define WH_GRASP_GRIPS_H

#include "edge.h"
#include "grasp.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(grips);

typedef enum WH_FOUR_BYTES { WH_GRIP_VACUUM, WH_GRIP_EDGE, WH_GRIP_PASSIVE } wh_grip_kind_t;

/* One gripper's grip. Immutable during a run. */
typedef struct {
    wh_grip_kind_t kind;
    wh_edge_t edge; /* with WH_GRIP_EDGE alone */
} wh_grip_t;

/* Where an edge grip is; vacuum and passive pads are OPEN for ever. */
typedef enum WH_FOUR_BYTES {
    WH_GRIP_OPEN,    /* the plunger is retracted */
    WH_GRIP_CLOSING, /* on its way forwards */
    WH_GRIP_CLOSED,  /* it holds its wafer */
    WH_GRIP_JAMMED,  /* it stands, and holds nothing: a wafer is in the way, or far too large */
    WH_GRIP_MISSED,  /* the same, with no wafer in reach, or one far too small */
    WH_GRIP_OPENING  /* on its way back */
} wh_grip_phase_t;

/* One gripper, as the last step left it. Read only. */
typedef struct {
    wh_grip_phase_t phase;
    int32_t wafer;         /* that the plunger met or is to meet since it closes; WH_NONE */
    double s;              /* of the plunger, mm (edge.h) */
    double excess;         /* JAMMED: mm beyond the clearance, 0 for a wafer that is too large; else 0 */
    wh_edge_wafer_t lying; /* that wafer, as it lay on the blade when the plunger set off */
    wh_real_t x, y;        /* of gripper_from_wafer then */
} wh_grip_state_t;

/* What a table needs beside its own arrays. The arrays are the caller's, live as long as the table and belong
 * to it alone; those behind const do not change. */
typedef struct {
    wh_real_t thickness;           /* of each wafer, mm, 0 to WH_FACE_THICKEST; 0: backs alone are seen */
    double dt;                     /* of a slice, s, above 0, up to 3600 */
    const wh_grip_t *grips;        /* one for each gripper */
    const wh_edge_wafer_t *shapes; /* one for each wafer, the notch's axis in its frame, x and y 0; null
                                      where no gripper has an edge grip */
    const wh_pose_t *supports;     /* planes on which wafers lie, e3 upwards: base_from_support */
    size_t support_count;          /* up to INT32_MAX */
    wh_grip_state_t *states;       /* one for each gripper */
    wh_wafer_t *seen;              /* one for each wafer: for a step's own use */
    const double *speeds; /* one for each gripper: its plunger goes no faster in the next step, mm/s, 0
                                      or more; null: each goes as fast as its edge grip says */
} wh_grips_parts_t;

typedef struct {
    wh_grips_parts_t parts;
    wh_grasp_t *table;
    uint32_t mark; /* WH_GRIPS_MARK once wh_grips_init has set it up */
} wh_grips_t;

#define WH_GRIPS_MARK UINT32_C(0x6b0f7a35)

/* A wafer that is lower than its support's plane by less than this, mm, lies on it: rounding. */
#if defined(WH_FLOAT)
#define WH_GRIPS_FLAT WH_REAL(1e-3)
#else
#define WH_GRIPS_FLAT WH_REAL(1e-6)
#endif

/* Sets up the grips of an initialised table without buckets whose grippers hold nothing: plungers retracted.
 * Refused, nothing changed: null pointers, but for an array whose count is 0 and for shapes as said above
 * (WH_STATUS_NULL_ARGUMENT); a table that is not initialised (WH_STATUS_NOT_INITIALISED); buckets, too many
 * supports (WH_STATUS_BAD_CAPACITY); a gripper that holds a wafer (WH_STATUS_HELD); a thickness or dt that is
 * NaN or infinite (WH_STATUS_NOT_FINITE) or out of its range, a kind that is none (WH_STATUS_OUT_OF_RANGE);
 * what wh_edge_validate refuses of an edge grip, wh_edge_wafer_validate of a shape beside it, and
 * wh_pose_validate of a support. Cost: linear in grippers, wafers and supports, and in wafers for each edge
 * grip. */
wh_status_t wh_grips_init(wh_grips_t *grips, const wh_grips_parts_t *parts, wh_grasp_t *table)
    WH_SYMBOL(wh_grips_init);

/* One slice, as described at the top. Refused as by wh_grasp_step, and grips that are null or not initialised
 * (WH_STATUS_NULL_ARGUMENT, WH_STATUS_NOT_INITIALISED). Cost: that of wh_grasp_step without buckets; each
 * gripper with vacuum adds a look at each wafer, and a copy of all if one shows it its front; a plunger that
 * moves adds wh_edge_at; empty passive pads add wh_passive_step for each wafer that nobody holds, and those
 * with a wafer for each support. */
wh_status_t wh_grips_step(wh_grips_t *grips, const wh_gripper_input_t *inputs, wh_event_list_t *list)
    WH_SYMBOL(wh_grips_step);

/* The support that a wafer lies on, or WH_NONE: for one that is carried, or lies on none. Its height over it
 * (passive.h) is at least -WH_GRIPS_FLAT and below eps_projz, and (7) and (8) hold between the face that
 * looks at the support and the support. Of several the one with the smallest height, then the lowest index.
 * Nothing is checked. Cost: linear in supports. */
int32_t wh_grips_support(const wh_grips_t *grips, size_t wafer) WH_SYMBOL(wh_grips_support);

/* Completes states that came from elsewhere, such as a message, and looks if a step can have left them
 * beside these grippers. Of each state phase, wafer, s and excess count, and while it closes on a wafer x,
 * y and of `lying` the place and the notch's axis. The rest is filled in: the wafer's shape, and all of a
 * state that is OPEN. Returns WH_OK; WH_STATUS_OUT_OF_RANGE for a phase that is none or that the grip does
 * not have, a wafer that is none or another than the gripper's own, one that is carried where the phase
 * says otherwise, an s beside the stroke, an excess below 0, above 1000 or of another phase than JAMMED;
 * WH_STATUS_NOT_FINITE; or what wh_edge_wafer_validate says. Refused, some states may be completed. Cost:
 * linear in grippers. */
wh_status_t wh_grips_complete(const wh_grips_parts_t *parts, const wh_gripper_t grippers[],
                              size_t gripper_count, size_t wafer_count, wh_grip_state_t states[])
    WH_SYMBOL(wh_grips_complete);

/* wh_grasp_hash, and where a gripper has another grip than vacuum its words after it: the grip's kind, phase,
 * wafer, s and excess, and while it closes x and y and the eight numbers of `lying`, in the order of their
 * structs. Nothing is checked. */
uint64_t wh_grips_hash(const wh_grips_t *grips) WH_SYMBOL(wh_grips_hash);

WH_HEADER_END

#endif
