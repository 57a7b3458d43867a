/* The cell's bodies, and the pairs that come near to each other, slice by slice.
 *
 * A world is made of convex parts. Fixed parts (FOUPs, ledges, walls) are in base. The robot's parts hang
 * on its arm, the grippers' on the grippers; each wafer is one more part. After each step of the grasp
 * table the caller tells the world the place of everything. It then reports any forbidden contact, also
 * between the last slice and this one. It keeps the smallest gap of each watched kind of pair, with the
 * slice in which it occurred.
 *
 * Between two slices each body's origin moves straight, and the body turns at a constant rate about it.
 * Nothing passes through unnoticed. A pair counts as apart only if that is proved for the whole slice. The
 * proof is a plane between the two, or the gaps at both ends against the distance that their points moved.
 * Otherwise the slice is divided until it is proved, contact is found, or the check gives up and says so
 * (WH_EVENT_UNDECIDED). Contact is defined in collision/gap.h: touching within 1e-3 mm is not a hit.
 *
 * Only these may touch:
 *   - a gripper's parts and the wafer that it holds, is about to take or has just let go: within the
 *     tolerance sideways and near_projz in height, with an open valve, an edge grip, or from another gripper
 *     or a chuck, and until the gripper has gone 1 mm sideways;
 *   - a wafer and the ledges of its slot, or the chuck that it lies on;
 *   - neighbours in the chain of an arm; two arms of one robot where they meet: their upper arms, and at one
 *     wrist the hands, and a hand and the other one's blade;
 *   - parts that do not move against each other;
 *   - a door's parts and standing parts other than wafers: a door moves in its frame.
 *
 * It uses no heap; the memory belongs to the caller. A world reads wafers and grippers and never changes
 * them.
 */
#ifndef WH_COLLISION_WORLD_H
#define WH_COLLISION_WORLD_H

#include "../cell/station.h"
#include "arm.h"
#include "gap.h"
#include "tree.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(world);

/* The most grippers of a world, and the most arms: six robots with two each. */
#define WH_WORLD_GRIPPERS 16
#define WH_WORLD_ARMS 12
#define WH_WORLD_NO_ARM 255 /* for a gripper that is on no robot */
#define WH_WORLD_DOORS 28   /* the most doors */
#define WH_WORLD_MOVING 192 /* the most parts of robots, grippers and doors together */

/* The kind of a part, for the rules of contact. */
typedef enum WH_FOUR_BYTES {
    WH_PART_FIXED, /* walls, tables, shells; `owner` is the caller's */
    WH_PART_LEDGE, /* of station `owner`, slot `slot` */
    WH_PART_ARM,   /* part of an arm's body: `owner` is the arm times WH_ARM_BODIES, plus a wh_arm_body_t */
    WH_PART_BLADE, /* of gripper `owner`, which is on a robot */
    WH_PART_CHUCK, /* of gripper `owner`, which is a chuck */
    WH_PART_DOOR,  /* of door `owner` */
    WH_PART_WAFER  /* wafer `owner` */
} wh_part_kind_t;

/* convex.body_from_shape is in base for fixed parts and ledges, otherwise in the frame of the body that the
 * part hangs on. */
typedef struct {
    wh_part_kind_t kind;
    int32_t owner;
    int32_t slot; /* of a ledge, from 1 */
    wh_convex_t convex;
} wh_part_t;

/* An arm. A robot with two arms has two sets of bodies from the upper arm on; one with two wrists has two
 * hands. Parts of shared bodies hang on the first arm. */
typedef struct {
    int32_t robot;     /* equal for the arms of one robot only */
    wh_arm_body_t own; /* the first body that it does not share with an earlier arm */
} wh_world_arm_t;

/* Kinds of pairs whose smallest gap is recorded. */
typedef enum WH_FOUR_BYTES {
    /* a blade and a wafer above it that it does not hold and is not about to take */
    WH_CLEARANCE_BLADE_WAFER_ABOVE,
    WH_CLEARANCE_BLADE_WAFER_BELOW,
    WH_CLEARANCE_BLADE_OTHER, /* a blade and ledges, chucks, fixed parts or another robot's blade */
    WH_CLEARANCE_WAFER_WAFER, /* a held wafer and another one */
    WH_CLEARANCE_WAFER_LEDGE, /* a held wafer and a ledge of a slot that it does not lie in */
    WH_CLEARANCE_WAFER_OTHER, /* a held wafer and fixed parts or chucks */
    WH_CLEARANCE_ARM_OTHER,   /* an arm and fixed parts, ledges, chucks, wafers or another robot */
    WH_CLEARANCE_ARM_ITSELF,  /* a robot's arms, its own blades and held wafers */
    WH_CLEARANCES
} wh_clearance_kind_t;

/* Larger gaps are not recorded, mm: such parts are not near. */
#define WH_CLEARANCE_RANGE WH_REAL(20.0)

/* The smallest gap of one kind so far. `gap` is WH_CLEARANCE_RANGE until something was nearer; it is 0 for
 * touching or hit. It is exact to 1e-3 mm at the ends of slices. */
typedef struct {
    wh_real_t gap;
    uint64_t slice;
    int32_t parts[2]; /* WH_NONE until then */
    wh_vec3_t at;     /* between the two, base */
} wh_clearance_t;

/* The input of a world in a slice: from a grasp table after its step, or from a received state. There are
 * wafer_count wafers and gripper_count grippers, as in the config. */
typedef struct {
    uint64_t slice; /* steps so far */
    const wh_wafer_t *wafers;
    const wh_gripper_t *grippers;
    /* WH_ARM_BODIES for each arm, from collision/arm.h; read during the call */
    const wh_pose_t *base_from_arm;
    const wh_pose_t *base_from_door; /* door_count of them, as the config has; may be null without doors */
} wh_world_input_t;

/* A description; it must not change while a world uses it. */
typedef struct {
    const wh_part_t *parts; /* fixed parts and ledges first, then parts that hang on something */
    size_t part_count;
    wh_convex_t wafer; /* in a wafer's frame; wafer w is part part_count + w */
    size_t gripper_count, wafer_count, door_count;
    /* The arms, and for each gripper the arm that carries it, or WH_WORLD_NO_ARM. Count 0: there is one
     * arm, and neither array is read. */
    size_t arm_count;
    const wh_world_arm_t *arms;
    const uint8_t *carried_by;
    const wh_cell_t *cell;
    /* its tolerance gives the reach of a gripper to a wafer that it may take */
    const wh_grasp_config_t *grasp;
    uint32_t edges; /* bit g: gripper g has an edge grip, which comes to a wafer with its plunger open */
    wh_real_t limits[WH_CLEARANCES]; /* a gap below it gives WH_EVENT_TOO_CLOSE; 0: none */
    /* For each part, then for each wafer: true if it moves as in a run with known events. Two such parts
     * are not judged as a pair, and clearances and curves are not recorded: only the events count. Null:
     * all are judged. */
    const bool *known;
} wh_world_config_t;

typedef struct wh_world wh_world_t;

/* True if a measured gap keeps a limit, mm. A gap is a lower bound, exact to WH_GAP_TIGHT. So a gap that is
 * at its limit keeps it, however its last digits are rounded. */
static inline bool wh_clearance_is_kept(wh_real_t gap, wh_real_t limit) {
    return !(gap + WH_GAP_TIGHT < limit);
}

/* The kind's name, such as "blade_wafer_above": a constant, never null. */
const char *wh_clearance_name(wh_clearance_kind_t kind) WH_SYMBOL(wh_clearance_name);

/* Returns WH_OK, or the error in the description: WH_STATUS_NULL_ARGUMENT; WH_STATUS_BAD_CAPACITY for too
 * many grippers, arms, doors or parts that hang on something; WH_STATUS_OUT_OF_RANGE for an owner, a slot,
 * an arm that carries a gripper, or parts out of order; otherwise the result of wh_convex_validate. `part`
 * (may be null) is then the index of the part, or WH_NONE. */
wh_status_t wh_world_validate(const wh_world_config_t *config, int32_t *part) WH_SYMBOL(wh_world_validate);

/* Bytes that wh_world_init needs. */
size_t wh_world_bytes(const wh_world_config_t *config) WH_SYMBOL(wh_world_bytes);

/* Sets a world up in `memory`, aligned like malloc's, with everything at its place at the begin of a run.
 * `config`, which has passed wh_world_validate, and `memory` must outlive it; `input` need not. Returns
 * null if `bytes` are too few. Cost: n log n in fixed parts and wafers. */
wh_world_t *wh_world_init(const wh_world_config_t *config, const wh_world_input_t *input, void *memory,
                          size_t bytes) WH_SYMBOL(wh_world_init);

/* One slice: judges everything that moved since the last call. Appends events to `list`, which may be null,
 * while there is room. A run has at most one WH_EVENT_HIT, the first, after which contact is no longer
 * judged. It has at most one WH_EVENT_UNDECIDED, and one WH_EVENT_TOO_CLOSE for each kind of clearance.
 * Cost: a few nanoseconds for each near pair, some tens of microseconds for one that is measured; things at
 * rest elsewhere cost nothing. */
void wh_world_step(wh_world_t *world, const wh_world_input_t *input, wh_event_list_t *list)
    WH_SYMBOL(wh_world_step);

/* Slices were left out in which nothing was taken or let go: everything is here now, and nobody judges the
 * way there. Cost: linear in the parts that may move. */
void wh_world_jump(wh_world_t *world, const wh_world_input_t *input) WH_SYMBOL(wh_world_jump);

/* Tells the world that a wafer that nobody holds was put there between two steps. */
void wh_world_place(wh_world_t *world, int32_t wafer, const wh_pose_t *base_from_wafer)
    WH_SYMBOL(wh_world_place);

/* The smallest gaps so far, by kind: WH_CLEARANCES of them. For moving parts they are known at the end of
 * each slice. For parts that may move but stand still they are known from the first bin of the curves that
 * ends. A hit between two slices is a gap of 0. */
const wh_clearance_t *wh_world_clearances(const wh_world_t *world) WH_SYMBOL(wh_world_clearances);

/* The smallest gaps over time. A run is divided into bins of equal numbers of slices. When all bins are
 * full, two become one, and bins hold twice as many slices. A bin has the smallest gaps from its begin to
 * its end, at the ends of slices, exact to 1e-3 mm. */
#define WH_CURVE_BINS 600

typedef struct {
    /* The slice before the first bin: bin i ends with slice first + (i + 1) * slices. */
    uint64_t first;
    uint64_t slices; /* slices in a bin */
    size_t count;    /* finished bins */
    uint64_t last;   /* 0 during the run; then its last slice, with which the last bin ends */
    /* WH_CLEARANCE_RANGE: nothing was nearer. */
    wh_real_t gaps[WH_CLEARANCES][WH_CURVE_BINS];
} wh_curves_t;

const wh_curves_t *wh_world_curves(const wh_world_t *world) WH_SYMBOL(wh_world_curves);

/* Writes the curves of a run that has ended, up to its last slice; the last bin may be shorter. */
void wh_world_copy_curves(const wh_world_t *world, wh_curves_t *curves) WH_SYMBOL(wh_world_copy_curves);

/* The slice with which a bin ends. */
static inline uint64_t wh_curves_end(const wh_curves_t *curves, size_t bin) {
    const uint64_t end = curves->first + (bin + 1) * curves->slices;
    return curves->last > 0 && end > curves->last ? curves->last : end;
}

/* Counts of how the pairs of all slices were decided, to find out where the time goes. */
typedef struct {
    uint64_t pairs;    /* pairs near enough to be on a list */
    uint64_t planes;   /* pairs decided by a plane between the two */
    uint64_t measured; /* pairs measured */
    uint64_t divided;  /* slices divided */
    uint64_t relisted; /* lists made again */
} wh_world_counters_t;

const wh_world_counters_t *wh_world_counters(const wh_world_t *world) WH_SYMBOL(wh_world_counters);

/* Checks everything at rest, as `waferhand layout` does before a run. Returns the number of pairs of parts
 * that overlap and must not, and writes the first `capacity` of them to `pairs`: wafers first, in their
 * order, then parts that hang on arm and grippers. It looks at no more than 256 things near one part. Cost:
 * n log n. */
size_t wh_world_check_rest(wh_world_t *world, const wh_world_input_t *input, int32_t pairs[][2],
                           size_t capacity) WH_SYMBOL(wh_world_check_rest);

WH_HEADER_END

#endif
