/* The grasp table: which gripper holds which wafer, slice by slice.
 *
 * A gripper has one vacuum valve, 0 = open (vacuum on), 1 = closed, a level for a whole slice.
 * wh_grasp_step does once per slice, in this order:
 *   1. read all inputs; if one is invalid, refuse the whole step;
 *   2. release: a wafer whose gripper's valve is now closed stays where its gripper, at this slice's pose,
 *      carries it;
 *   3. carry: a held wafer is at base_from_gripper * gripper_from_wafer, the second fixed at the pick;
 *   4. pick: each open, empty gripper, in the order of their indices, takes the ready and free wafer with
 *      the smallest |dr_proj_z|, then the lowest index. gripper_from_wafer is stored unchanged: the wafer
 *      does not jump.
 * Rotations are corrected before they drift: the rotation of gripper_from_wafer becomes the nearest
 * orthonormal one at the pick, and that of a carried wafer when it no longer passes wh_pose_validate. Each
 * correction changes an entry by a few times WH_ROTATION_TOLERANCE at most, and only by rounding if the
 * inputs are exact. So a wafer passes from one gripper to the next within the step in which the first
 * closes; it is never free in between.
 *
 * Checking is `sampled` (the paper's: at the slice's pose) or `swept`: between two slices in which the valve
 * was open and the gripper empty, its position is taken as linear and its rotation as the quaternion
 * (1-t) 1 + t q, normalised, with q the turn from the earlier to the later pose, by the shorter way. The
 * wafer is taken at the first instant within 0.998 eps_projz and the other two limits (of several wafers:
 * earliest, then |dr_proj_z|, then index), failing that if it is ready at the slice's end, and is then
 * carried to the slice's end. A wafer released in this slice is checked at its end only. The instant is a
 * root of closed forms. On the root of (7) or (8) itself, which are strict, the check may fail by rounding:
 * then it is 2^-20 of the part of the slice within the limits later, and the gripper's pose off by less than
 * 1e-6 of its way in the slice. Only where rounding hides even that, as on a way of 1e-9 mm, it is 2^-10 of
 * that part later, or half of it.
 *
 * The caller owns the memory; nothing is allocated, nothing is static, and the owner may copy or move a
 * table together with its arrays. Calls on one table must not overlap; different tables are independent. A
 * call that fails changes only `counters.refused` in the table.
 *
 * Bytes of stack and of memory on a Cortex-M7 in double and on a Cortex-M4F in float, by gcc 12
 * (tests/verify/footprint; "sampled" is a step without swept checking and without buckets):
 *                                             M7 -O2    -Os  M4F -O2    -Os
 *     stack of wh_grasp_init                   324    232     212    144
 *     stack of wh_grasp_step                   616    776     380    452
 *     stack of wh_grasp_step:sampled_indexed    340    384     324    352
 *     stack of wh_grasp_step:sampled           248    384     232    264
 *     stack of wh_grasp_place                   92    200      76    112
 *     stack of wh_grasp_hash                    44     80      48     80
 *     size of wh_grasp_t                       136            120
 *     size of wh_wafer_t                       104             56
 *     size of wh_gripper_t                     456            264
 *     size of wh_gripper_input_t               104             52
 *     size of wh_event_t                       200            128
 */
#ifndef WH_GRASP_GRASP_H
#define WH_GRASP_GRASP_H

#include "event.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(grasp);

typedef enum WH_FOUR_BYTES { WH_CHECK_SAMPLED, WH_CHECK_SWEPT } wh_check_t;

/* A valve's two levels. */
enum { WH_VALVE_OPEN = 0, WH_VALVE_CLOSED = 1 };

/* Immutable after wh_grasp_init. */
typedef struct {
    wh_tolerance_t tolerance;
    wh_check_t check;
    /* Pulls a wafer onto the pads at the pick, like vacuum does: z of gripper_from_wafer becomes 0 and the
     * wafer turns by the smallest rotation that takes n1 to n2. */
    bool seat;
    /* The neighbourhood for near misses (see WH_EVENT_NEAR_MISS), mm: |dr_proj_z| < near_projz and
     * |dr_proj_xy| < near_projxy; in (0, 1e6]. */
    wh_real_t near_projz, near_projxy;
} wh_grasp_config_t;

/* One wafer. The caller sets base_from_wafer before wh_grasp_init and only reads it afterwards. */
typedef struct {
    wh_pose_t base_from_wafer;
    int32_t holder;      /* the gripper's index, or WH_NONE */
    int32_t released_by; /* used within a step; WH_NONE between steps */
} wh_wafer_t;

/* A wafer that an open, empty gripper is watching. */
typedef struct {
    int32_t wafer;  /* WH_NONE when there is none */
    int32_t holder; /* the holder of a contested wafer; otherwise WH_NONE */
    uint64_t slice; /* the slice of `measured` */
    wh_proximity_t measured;
    wh_face_t face; /* the wafer's face for `measured`; WH_FACE_BACK except with grips.h */
} wh_encounter_t;

/* Slice and face of an encounter as one word, for hashes, snapshots and messages. For a front face the
 * slice's bits are inverted; no slice has such a number. */
static inline uint64_t wh_encounter_stamp(const wh_encounter_t *encounter) {
    return encounter->face == WH_FACE_FRONT ? ~encounter->slice : encounter->slice;
}

/* Sets slice and face of an encounter from that word. */
static inline void wh_encounter_take_stamp(wh_encounter_t *encounter, uint64_t stamp) {
    const bool front = stamp >> 63 != 0;
    encounter->slice = front ? ~stamp : stamp;
    encounter->face = front ? WH_FACE_FRONT : WH_FACE_BACK;
}

/* One gripper, as the last step left it. Read only. */
typedef struct {
    wh_pose_t base_from_gripper;
    wh_pose_t gripper_from_wafer; /* valid while it holds a wafer */
    int32_t wafer;                /* the wafer it holds, or WH_NONE */
    int32_t valve;                /* WH_VALVE_*; closed before the first step */
    wh_encounter_t approach;      /* the closest approach of a free wafer that is near now */
    wh_encounter_t contest;       /* the beginning of a contest that goes on now */
} wh_gripper_t;

/* One gripper's input in a slice. */
typedef struct {
    wh_pose_t base_from_gripper; /* at the slice's end */
    int32_t valve;               /* WH_VALVE_OPEN or WH_VALVE_CLOSED, for the whole slice */
} wh_gripper_input_t;

/* The caller's arrays. They must live as long as the table and belong only to it. Each has up to INT32_MAX
 * entries. `buckets` (wh_grasp_buckets gives their number) hold an index over the wafers, and the distance
 * that each gripper may move before any wafer can matter to it. They change no result, only the cost of a
 * step; null and 0 are always allowed. Their content before wh_grasp_init does not matter; afterwards it
 * belongs to the table. A copy of a table needs buckets of its own, which wh_grasp_restore fills, or null
 * and 0. */
typedef struct {
    wh_wafer_t *wafers;
    size_t wafer_count;
    wh_gripper_t *grippers;
    size_t gripper_count;
    uint32_t *buckets;
    size_t bucket_count;
} wh_grasp_storage_t;

/* Run-time totals; no step depends on them, and they are not in the hash. */
typedef struct {
    uint64_t refused; /* calls refused for an invalid argument */
    uint64_t picked, released, handed_over, near_misses, contested;
} wh_grasp_counters_t;

typedef struct {
    wh_grasp_config_t config;
    wh_grasp_storage_t storage;
    uint64_t slice; /* steps done */
    wh_grasp_counters_t counters;
    uint32_t mark;  /* WH_GRASP_MARK once wh_grasp_init has set the table up */
    uint32_t grips; /* which wh_grips_t steps the table: wh_grips_init counts them; 0: wh_grasp_step does */
} wh_grasp_t;

/* Each call that returns a status refuses a table without this mark (WH_STATUS_NOT_INITIALISED); it reads
 * and changes nothing else of the table. So it refuses a zeroed table, and one in memory with any other
 * content, except one bit pattern in 2^32. The mark does not show that other parts of a table were
 * overwritten later, that the arrays no longer exist, or that a table was copied without its arrays: see
 * wh_grasp_is_consistent. */
#define WH_GRASP_MARK UINT32_C(0x77a6e57d)

/* How many buckets a table of these counts needs: 5 for each wafer, 4 for each gripper and 8. It is 0
 * above INT32_MAX / 16 wafers or grippers, and in a library without an index: such a table can have
 * none. */
size_t wh_grasp_buckets(size_t wafer_count, size_t gripper_count) WH_SYMBOL(wh_grasp_buckets);

/* This number as a constant, for use as an array size. */
#define WH_GRASP_BUCKETS(wafer_count, gripper_count)                                                         \
    (8 + 4 * WH_CAST(size_t, gripper_count) + 5 * WH_CAST(size_t, wafer_count))

/* The paper's tolerance, sampled, no seating; neighbourhood 4.5 mm and 2 eps_projxy. */
wh_grasp_config_t wh_grasp_config_default(void) WH_SYMBOL(wh_grasp_config_default);

/* Sets up a table: all wafers are free at their places in storage->wafers, and all grippers are empty and
 * closed. It refuses, and leaves table and arrays unchanged: null pointers, except for an array whose count
 * is 0 (WH_STATUS_NULL_ARGUMENT); counts above INT32_MAX, and fewer buckets than wh_grasp_buckets gives but
 * not 0 (WH_STATUS_BAD_CAPACITY); a wafer's pose that wh_pose_validate refuses, with its status; an unknown
 * `check` (WH_STATUS_OUT_OF_RANGE); a tolerance, near_projz or near_projxy out of its range or NaN
 * (WH_STATUS_BAD_TOLERANCE); swept checking or buckets if the library was built without them
 * (WH_STATUS_NOT_BUILT); arrays that share bytes with each other or with the table (WH_STATUS_OVERLAP).
 * Cost: linear in wafers and grippers. */
wh_status_t wh_grasp_init(wh_grasp_t *table, const wh_grasp_config_t *config,
                          const wh_grasp_storage_t *storage) WH_SYMBOL(wh_grasp_init);

/* One slice, as described at the top. `inputs` has one entry for each gripper. `list` receives the events,
 * in the order picks and hand-overs, releases, both by gripper, and then gripper by gripper its near miss and
 * its contest; null: not wanted.
 * Refused, and the table left as it was: a null table, null inputs unless there is no gripper, a list with
 * a capacity and null events (WH_STATUS_NULL_ARGUMENT), a table with grips (WH_STATUS_HAS_GRIPS: grips.h),
 * a list with room for fewer than
 * WH_EVENTS_PER_GRIPPER events for each gripper (WH_STATUS_BAD_CAPACITY), a pose that does not pass
 * wh_pose_validate, a valve that is neither 0 nor 1; the last two also yield the one event
 * WH_EVENT_BAD_INPUT, the others leave the list empty. Cost: linear in grippers. Each open, empty gripper
 * adds a test of each other gripper's wafer and a check of every wafer, two if one is near, at 3 products
 * each for a wafer too high or too low. With buckets it adds less than a dozen products instead while it is
 * within its horizon. Beyond it, it adds two searches of the wafers around it, which do not depend on the
 * number of wafers elsewhere. All wafers are checked only if it moves very far in one slice or most wafers
 * are around it. A release adds a search through the wafers of one cell. */
wh_status_t wh_grasp_step(wh_grasp_t *table, const wh_gripper_input_t *inputs, wh_event_list_t *list)
    WH_SYMBOL(wh_grasp_step);

/* Puts a free wafer at another place, as a test or an operator may. It refuses a held wafer
 * (WH_STATUS_HELD), an index out of range, null pointers and an invalid pose. Its near misses so far are
 * forgotten. Cost: linear in grippers, and with buckets a search through the wafers of one cell. */
wh_status_t wh_grasp_place(wh_grasp_t *table, size_t wafer, const wh_pose_t *base_from_wafer)
    WH_SYMBOL(wh_grasp_place);

/* The place of a wafer and its holder; either result pointer may be null. Returns WH_STATUS_OUT_OF_RANGE
 * for a bad index. */
wh_status_t wh_grasp_wafer(const wh_grasp_t *table, size_t wafer, wh_pose_t *base_from_wafer, int32_t *holder)
    WH_SYMBOL(wh_grasp_wafer);

/* The wafer that a gripper holds (WH_NONE: none). Returns WH_STATUS_OUT_OF_RANGE for a bad index. */
wh_status_t wh_grasp_held(const wh_grasp_t *table, size_t gripper, int32_t *wafer) WH_SYMBOL(wh_grasp_held);

/* True if the table is consistent, as it is between any two calls (Frama-C proves it:
 * tests/proof/README.md):
 *   - a wafer's holder is WH_NONE, or a gripper that names this wafer: no wafer has two holders;
 *   - a gripper's wafer is WH_NONE, or a wafer whose holder is this gripper: no gripper has two wafers;
 *   - `approach` and `contest` of each gripper name a wafer of the table or WH_NONE;
 *   - `released_by` of each wafer is WH_NONE.
 * It is false if the table is not initialised. It is for tests, and for a firmware that suspects that other
 * code writes into its memory. Cost: linear in wafers and grippers. With -DWH_DEBUG_TABLE each call that
 * changes a table asserts it at the end of the call. */
bool wh_grasp_is_consistent(const wh_grasp_t *table) WH_SYMBOL(wh_grasp_is_consistent);

/* 64 bits over everything that the next step depends on, so equal hashes mean equal runs from then on. They
 * cover the number of steps; for each wafer its pose (R row by row, r) and holder; for each gripper its
 * pose, valve, wafer, gripper_from_wafer while it holds one, then approach and contest: wafer, and while
 * there is one also holder, slice and dr, n1_proj_n2, dr_proj_z, dr_proj_xy, dr_proj_xy_norm.
 * Configuration, counters and buckets are left out. Nothing is checked. Each number enters as a 64-bit word
 * w, reals by the bits of their type, integers in two's complement:
 *
 *     h = 0x6a09e667f3bcc908
 *     for each w:  h = (h ^ w) * 0x9e3779b97f4a7c15;  h = h ^ (h >> 32)
 *
 * The slice of an encounter with a wafer's front (grips.h) enters with all its bits turned over.
 *
 * Cost: about 2 ns a word, 13 words for each wafer and up to 50 for each gripper. */
uint64_t wh_grasp_hash(const wh_grasp_t *table) WH_SYMBOL(wh_grasp_hash);

WH_HEADER_END

#endif
