/* The cell's bodies, and which of them come near to each other, slice by slice.
 *
 * A world is made of convex parts. Fixed ones (FOUPs, ledges, walls) stand in base; the robot's hang on its
 * arm, the grippers' on the grippers; each wafer is one more part. After each step of the grasp table the
 * world is told where everything is. It then says if anything touched that must not, between the last slice
 * and this one as well. It keeps the smallest gap of each watched kind of pair, with the slice in which it
 * occurred.
 *
 * Between two slices each body's origin moves straight, and the body turns at a constant rate about it.
 * Nothing tunnels. A pair counts as apart only if that is proved for the whole slice: by a plane between the
 * two, or by the gaps at both ends against the distance that their points moved. Else the slice is divided
 * until it is proved, contact is found, or the check gives up and says so (WH_EVENT_UNDECIDED). Contact is
 * that of collision/gap.h: touching within 1e-3 mm is not a hit.
 *
 * These may touch, and nothing else:
 *   - a gripper's parts and the wafer that it holds, is about to take or has just let go: within the
 *     tolerance sideways and near_projz in height, with an open valve, an edge grip, or from another gripper
 *     or a chuck, and until the gripper has gone 1 mm sideways;
 *   - a wafer and the ledges of its slot, or the chuck that it lies on;
 *   - neighbours in the chain of an arm; two arms of one robot where they meet: their upper arms, and at one
 *     wrist the hands, and a hand and the other one's blade;
 *   - parts that do not move against each other;
 *   - a door's parts and what stands, but for wafers: a door goes in its frame.
 *
 * No heap; the memory is the caller's. A world reads wafers and grippers and never changes them.
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
#define WH_WORLD_NO_ARM 255 /* of a gripper that is on no robot */
#define WH_WORLD_DOORS 8    /* the most doors */
#define WH_WORLD_MOVING 192 /* the most parts of robots, grippers and doors together */

/* The kind of a part, for the rules of what may touch what. */
typedef enum WH_FOUR_BYTES {
    WH_PART_FIXED, /* walls, tables, shells; `owner` is the caller's */
    WH_PART_LEDGE, /* of station `owner`, slot `slot` */
    WH_PART_ARM,   /* of an arm's body: `owner` is the arm times WH_ARM_BODIES, and a wh_arm_body_t */
    WH_PART_BLADE, /* of gripper `owner`, which is on a robot */
    WH_PART_CHUCK, /* of gripper `owner`, which is a chuck */
    WH_PART_DOOR,  /* of door `owner` */
    WH_PART_WAFER  /* wafer `owner` */
} wh_part_kind_t;

/* convex.body_from_shape is in base for fixed parts and ledges, else in the frame of the body that the part
 * hangs on. */
typedef struct {
    wh_part_kind_t kind;
    int32_t owner;
    int32_t slot; /* of a ledge, from 1 */
    wh_convex_t convex;
} wh_part_t;

/* An arm. A robot with two arms has the second one's bodies from its upper arm on twice, one with two wrists
 * its hand: parts hang on those of the first arm before. */
typedef struct {
    int32_t robot;     /* the same for the arms of one robot, and for no others */
    wh_arm_body_t own; /* the first body that it does not share with an arm before it */
} wh_world_arm_t;

/* Kinds of pairs whose smallest gap is kept. */
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

/* Larger gaps are not kept, mm: such parts are not near. */
#define WH_CLEARANCE_RANGE WH_REAL(20.0)

/* The smallest gap of one kind so far. `gap` is WH_CLEARANCE_RANGE until something was nearer; 0 for touching
 * or hit. Exact to 1e-3 mm at the ends of slices. */
typedef struct {
    wh_real_t gap;
    uint64_t slice;
    int32_t parts[2]; /* WH_NONE until then */
    wh_vec3_t at;     /* between the two, base */
} wh_clearance_t;

/* What a world reads in a slice: of a grasp table after its step, or of a received state. There are
 * wafer_count wafers and gripper_count grippers, as in the config. */
typedef struct {
    uint64_t slice; /* steps so far */
    const wh_wafer_t *wafers;
    const wh_gripper_t *grippers;
    /* WH_ARM_BODIES for each arm, from collision/arm.h; read during the call */
    const wh_pose_t *base_from_arm;
    const wh_pose_t *base_from_door; /* door_count of them, as the config has; may be null without doors */
} wh_world_input_t;

/* A description; immutable while a world uses it. */
typedef struct {
    const wh_part_t *parts; /* fixed ones and ledges first, then those that hang on something */
    size_t part_count;
    wh_convex_t wafer; /* in a wafer's frame; wafer w is part part_count + w */
    size_t gripper_count, wafer_count, door_count;
    /* The arms, and by gripper which of them carries it, or WH_WORLD_NO_ARM. Count 0: there is one arm, and
     * no array is read. */
    size_t arm_count;
    const wh_world_arm_t *arms;
    const uint8_t *carried_by;
    const wh_cell_t *cell;
    /* its tolerance says how near a gripper comes to a wafer that it may take */
    const wh_grasp_config_t *grasp;
    uint32_t edges; /* bit g: gripper g has an edge grip, which comes to a wafer with its plunger open */
    wh_real_t limits[WH_CLEARANCES]; /* a gap below it gives WH_EVENT_TOO_CLOSE; 0: none */
    /* For each part, then for each wafer: it goes where it went in a run of which the events are known. Pairs
     * of two such are not judged, and clearances and curves not kept: the events alone count. Null: all are
     * judged. */
    const bool *known;
} wh_world_config_t;

typedef struct wh_world wh_world_t;

/* True if a gap, as it was found, keeps a limit, mm. A gap is known from below, to WH_GAP_TIGHT: so one
 * that is at its limit keeps it, however its last digits are rounded. */
static inline bool wh_clearance_is_kept(wh_real_t gap, wh_real_t limit) {
    return !(gap + WH_GAP_TIGHT < limit);
}

/* The kind's name, such as "blade_wafer_above": a constant, never null. */
const char *wh_clearance_name(wh_clearance_kind_t kind) WH_SYMBOL(wh_clearance_name);

/* WH_OK, or what is wrong with the description: WH_STATUS_NULL_ARGUMENT; WH_STATUS_BAD_CAPACITY for too
 * many grippers, arms, doors or parts that hang on something; WH_STATUS_OUT_OF_RANGE for an owner, a slot,
 * an arm that carries a gripper, or parts out of order; else what wh_convex_validate says. `part` (may be
 * null) is then the index of the part, or WH_NONE. */
wh_status_t wh_world_validate(const wh_world_config_t *config, int32_t *part) WH_SYMBOL(wh_world_validate);

/* Bytes that wh_world_init needs. */
size_t wh_world_bytes(const wh_world_config_t *config) WH_SYMBOL(wh_world_bytes);

/* Sets a world up in `memory`, aligned as malloc's, from where everything is when a run begins. `config`,
 * which has passed wh_world_validate, and `memory` must outlive it; `input` need not. Returns null if `bytes`
 * are too few. Cost: n log n in fixed parts and wafers. */
wh_world_t *wh_world_init(const wh_world_config_t *config, const wh_world_input_t *input, void *memory,
                          size_t bytes) WH_SYMBOL(wh_world_init);

/* One slice: judges all that moved since the last call. Appends to `list`, which may be null, while there
 * is room: at most one WH_EVENT_HIT in a run, the first, after which contact is no longer judged, one
 * WH_EVENT_UNDECIDED, and one WH_EVENT_TOO_CLOSE for each kind of clearance. Cost: a few nanoseconds for
 * each pair that is near, some tens of microseconds for one that has to be measured; independent of what
 * rests elsewhere. */
void wh_world_step(wh_world_t *world, const wh_world_input_t *input, wh_event_list_t *list)
    WH_SYMBOL(wh_world_step);

/* Tells the world that a wafer that nobody holds was put there between two steps. */
void wh_world_place(wh_world_t *world, int32_t wafer, const wh_pose_t *base_from_wafer)
    WH_SYMBOL(wh_world_place);

/* The smallest gaps so far, by kind: WH_CLEARANCES of them. Of what moves they are known at the end of
 * each slice, of what may move but stands with the first bin of the curves that ends; a hit between two
 * slices is a gap of 0. */
const wh_clearance_t *wh_world_clearances(const wh_world_t *world) WH_SYMBOL(wh_world_clearances);

/* The smallest gaps over time. A run is divided into bins of equal numbers of slices. When all bins are full,
 * two become one, and bins hold twice as many slices. A bin has the smallest gaps from its
 * begin to its end, at the ends of slices, exact to 1e-3 mm. */
#define WH_CURVE_BINS 600

typedef struct {
    /* The slice before the first bin: bin i ends with slice first + (i + 1) * slices. */
    uint64_t first;
    uint64_t slices; /* in a bin */
    size_t count;    /* finished bins */
    uint64_t last;   /* 0 while the run goes on; then its last slice, with which the last bin ends */
    /* WH_CLEARANCE_RANGE: nothing nearer. */
    wh_real_t gaps[WH_CLEARANCES][WH_CURVE_BINS];
} wh_curves_t;

const wh_curves_t *wh_world_curves(const wh_world_t *world) WH_SYMBOL(wh_world_curves);

/* Writes the curves of a run that has ended: with a last bin, which may be shorter, up to its last slice. */
void wh_world_copy_curves(const wh_world_t *world, wh_curves_t *curves) WH_SYMBOL(wh_world_copy_curves);

/* The slice with which a bin ends. */
static inline uint64_t wh_curves_end(const wh_curves_t *curves, size_t bin) {
    const uint64_t end = curves->first + (bin + 1) * curves->slices;
    return curves->last > 0 && end > curves->last ? curves->last : end;
}

/* How the pairs of all slices were decided, for those who ask where the time goes. */
typedef struct {
    uint64_t pairs;    /* pairs near enough to be on a list */
    uint64_t planes;   /* pairs decided by a plane between the two */
    uint64_t measured; /* pairs measured */
    uint64_t divided;  /* slices divided */
    uint64_t relisted; /* lists made again */
} wh_world_counters_t;

const wh_world_counters_t *wh_world_counters(const wh_world_t *world) WH_SYMBOL(wh_world_counters);

/* Checks everything that rests, as `waferhand layout` does before a run. Returns how many pairs of parts
 * overlap and must not, and writes the first `capacity` of them to `pairs`: wafers first, in their order,
 * then what hangs on arm and grippers. At most 256 things near one part are looked at. Cost: n log n. */
size_t wh_world_check_rest(wh_world_t *world, const wh_world_input_t *input, int32_t pairs[][2],
                           size_t capacity) WH_SYMBOL(wh_world_check_rest);

WH_HEADER_END

#endif
