/* Shared within the collision world: moving bodies (world_move.c), lists of near things (world_near.c), the
 * judgement of one pair (world_pair.c), rules of contact (world_rules.c). */
#ifndef WH_COLLISION_WORLD_INTERNAL_H
#define WH_COLLISION_WORLD_INTERNAL_H

#include <float.h>

#include "gap.h"
#include "world.h"

/* The distance beyond the range of clearances within which things are on a moving part's list, mm; less if
 * there are too many. */
#define WH_NEAR_MARGIN WH_REAL(20.0)
#define WH_NEAR_LEAST WH_REAL(0.1)
#define WH_NEAR_CAPACITY 128

/* After this many wafers have been set down elsewhere the tree is built again. */
#define WH_REST_REBUILD 32

/* A body that moves, at both ends of the slice. */
typedef struct {
    wh_pose_t before, now; /* base_from_body */
    bool has_gone;         /* it moves in this slice */
    bool rests;            /* it has moved neither in this slice nor in the last one */
    bool has_parts;        /* something hangs on it; of an arm's bodies only those are moved */
    wh_real_t way;         /* way of its origin, mm */
    wh_real_t turn;        /* turn about its origin, rad; an upper bound */
    wh_real_t lean;        /* the part of the turn that moves points 1 mm from the origin up or down, mm */
} wh_body_t;

/* The slack of pairs with absent parts: no way is as long, mm. */
#define WH_WORLD_NOWHERE WH_REAL(1e30)

/* The slack of a pair that overlaps, or about which nothing is known. Such a pair must still be judged,
 * however far it moves and however sums of ways are rounded: a 0 would count as apart after an error of
 * 1e-13 mm. */
#define WH_WORLD_UNKNOWN WH_REAL(-1e30)

/* Sums of ways are rounded upwards by this share, eight times the greatest error of a sum or a
 * difference. */
#define WH_WORLD_ROUNDING (4 * WH_REAL(DBL_EPSILON))
/* A kept separation may be wrong by this much more with each slice, mm. It holds for parts within
 * WH_GAP_FARTHEST. */
#define WH_WORLD_BLUR WH_REAL(1e-9)

/* The ways of movers are summed up twice: all ways, and those up and down. Arms turn and reach at one
 * height for most of the time. */
typedef enum WH_FOUR_BYTES { WH_GONE_ANYWHERE, WH_GONE_UPRIGHT, WH_GONE_WAYS } wh_gone_t;

/* The clearances that a pair may count for. */
typedef enum WH_FOUR_BYTES {
    WH_WORTH_NOTHING,
    WH_WORTH_WAFER_WAFER,
    WH_WORTH_WAFER_LEDGE,
    WH_WORTH_WAFER_OTHER,
    WH_WORTH_BLADE_WAFER, /* above it or below */
    WH_WORTH_ARM_ITSELF,
    WH_WORTH_ARM_OTHER,
    WH_WORTH_BLADE_OTHER,
    WH_WORTHS
} wh_worth_t;

/* A pair and its state. When the sum of its movers' ways was `since`, the gap was at least `slack`, and so
 * was the separation along `axis` (zero: none yet). A slack of 0 or above is never a guess. */
typedef struct {
    int32_t other;    /* an item of the tree, or a mover */
    wh_worth_t worth; /* index in world->gaps.worth */
    wh_gone_t way;    /* the way by which the pair can come closer: UPRIGHT if the axis is */
    wh_real_t slack, since;
    wh_vec3_t axis;
    wh_real_t parted; /* the separation along the axis at the end of this step of the world */
    uint32_t step;    /* 0: not known */
    wh_real_t exact;  /* `slack` was the gap when the sum of both ways was this; -1: it is a bound */
    uint32_t again;   /* from this step on it is useful to compute the separation of the two again */
} wh_pair_t;

/* One part of a pair, as the judgement uses it. */
typedef struct {
    int32_t part;
    wh_part_kind_t kind;
    int32_t owner, slot;
    const wh_convex_t *convex;
    const wh_body_t *body;         /* null: it rests */
    const wh_pose_t *before, *now; /* base_from_shape */
    wh_real_t motion, bulge;
    wh_real_t gone; /* its way so far, of any kind */
} wh_side_t;

/* A convex part that moves: one that hangs on a body, or the wafer that a gripper holds. */
typedef struct {
    int32_t part; /* WH_NONE: this gripper holds none */
    int32_t body; /* index in world->bodies */
    wh_part_kind_t kind;
    int32_t arm;                  /* the arm that it hangs on, or whose gripper holds it; WH_NONE: none */
    wh_pose_t before, now;        /* base_from_shape, if is_placed */
    bool is_placed, was_placed;   /* it was needed in this slice; in the one before */
    wh_real_t radius;             /* of a ball about the body's origin that contains the part */
    wh_real_t motion;             /* the most that a point of it moved in this slice, mm */
    wh_real_t rise;               /* the most up or down */
    wh_real_t gone[WH_GONE_WAYS]; /* the sums of both */
    wh_real_t bulge;              /* the greatest distance of a point from its straight way */
    wh_pair_t *near;              /* things that rest, room for WH_NEAR_CAPACITY */
    size_t near_count;
    wh_real_t reach; /* the way that it may still move before the list must be made again */
    wh_real_t clear; /* the way that it may still move until a list can have something; 0: not known */
    size_t crowd;    /* the number of near things, if they are more than the list can hold; otherwise 0 */
    wh_side_t side;  /* as it was last asked for */
} wh_mover_t;

/* A pair of movers. */
typedef struct {
    int32_t a, b;
    wh_pair_t near;
} wh_mover_pair_t;

/* The wafer that a gripper released last, until the gripper has moved sideways from there. */
typedef struct {
    int32_t wafer;
    wh_vec3_t at;
} wh_left_t;

/* The start of the search for a pair's gap. Few pairs are near at a time, so they share these places. Each
 * has its place by the numbers of its parts; two with one place take turns. */
#define WH_WORLD_STARTS 256

typedef struct {
    int32_t parts[2];
    wh_gap_start_t points;
} wh_start_t;

/* Most pairs are not due in a slice: so many of them are passed over with one comparison. */
#define WH_WORLD_BLOCK 16

static inline size_t wh_world_blocks(size_t pairs) {
    return (pairs + WH_WORLD_BLOCK - 1) / WH_WORLD_BLOCK;
}

/* Gaps are known better than to this, mm. A gap that is smaller by less than this is not a new minimum. */
#define WH_SAME_GAP WH_REAL(1e-4)

/* Reports so far: none of these comes twice. */
typedef struct {
    bool too_close[WH_CLEARANCES];
    bool hit; /* contact is no longer judged */
    bool undecided;
} wh_world_reported_t;

/* The smallest gaps of the current bin of the curves; of the run if no curves are recorded. */
typedef struct {
    wh_real_t least[WH_CLEARANCES];
    wh_real_t worth[WH_WORTHS]; /* a larger gap is no new `least` */
} wh_world_gaps_t;

/* The pairs of movers that must be judged. */
typedef struct {
    double *of; /* each pair: when `gone` has reached this value; WH_WORLD_NOWHERE: the last block's rest */
    double *soonest; /* the least of each block */
    double gone;     /* not less than the sum of the ways of any two movers, mm */
} wh_world_due_t;

/* Bodies that stand: a slice in which nothing has gone judges no pair. */
typedef struct {
    wh_pose_t told[WH_ARM_BODIES * WH_WORLD_ARMS]; /* the arms' bodies, as the last slice has told them */
    bool has_parts[WH_WORLD_ARMS];                 /* something hangs on the arm: else nobody tells it */
    bool rests[WH_WORLD_ARMS];                     /* so do all its bodies */
    bool is_any_gone;                              /* a body has gone in this slice, or a wafer was taken */
    bool begins;                                   /* one has that rested before, or a wafer was taken */
    bool is_known; /* nothing has gone since the movers were told of all ways */
} wh_world_still_t;

struct wh_world {
    const wh_world_config_t *config;
    size_t fixed_count; /* parts that hang on nothing. The tree's items are these, then the wafers */
    wh_tree_t tree;
    wh_box_t *boxes;   /* boxes of the tree's items, for building it */
    wh_pose_t *wafers; /* base_from_wafer in the last slice */
    wh_pose_t *shapes; /* of wafers at rest: base_from_shape */
    uint32_t step;     /* the current one, from 1 */
    size_t set_down;   /* wafers set down since the tree was built */
    /* of the arms, then of the grippers, then of the wafers that they hold, then of the doors */
    wh_body_t bodies[WH_ARM_BODIES * WH_WORLD_ARMS + 2 * WH_WORLD_GRIPPERS + WH_WORLD_DOORS];
    wh_world_still_t still;
    wh_mover_t *movers;
    size_t mover_count;
    wh_mover_pair_t *pairs;
    size_t pair_count;
    wh_start_t starts[WH_WORLD_STARTS];
    wh_world_due_t due;
    wh_pair_t *near;
    int32_t held[WH_WORLD_GRIPPERS];
    wh_left_t left[WH_WORLD_GRIPPERS];
    wh_clearance_t clearances[WH_CLEARANCES];
    wh_world_reported_t reported;
    uint64_t slice; /* the last slice */
    wh_world_gaps_t gaps;
    wh_curves_t curves;
    wh_world_counters_t counters;
};

static inline uint32_t wh_world_next_step(const wh_world_t *world) {
    return world->step < UINT32_MAX ? world->step + 1 : 2;
}

/* A sum of ways plus one more; never below the true sum. */
static inline wh_real_t wh_world_add(wh_real_t sum, wh_real_t way) {
    return sum + (way + WH_WORLD_ROUNDING * (sum + way));
}

/* The sum of both ways, of the kind that counts for the pair. `b` is null if the other one rests. */
static inline wh_real_t wh_world_gone(const wh_pair_t *near, const wh_mover_t *a, const wh_mover_t *b) {
    return a->gone[near->way] + (b ? b->gone[near->way] : 0);
}

/* A lower bound of the present gap of two movers. */
static inline wh_real_t wh_world_slack(const wh_mover_pair_t *pair, const wh_mover_t movers[]) {
    const wh_pair_t *near = &pair->near;
    const wh_real_t gone = movers[pair->a].gone[near->way] + movers[pair->b].gone[near->way];
    return near->slack - (gone - near->since);
}

/* The value of `since` for a pair that has gone this far. It is slightly less, so that no difference is
 * rounded below the way, and this slice's way may be subtracted. */
static inline wh_real_t wh_world_since(wh_real_t gone) {
    return gone - 2 * WH_WORLD_ROUNDING * gone;
}

/* Call it when slack and axis are those at the end of this slice. */
static inline void wh_world_remember(wh_pair_t *near, const wh_mover_t *a, const wh_mover_t *b) {
    near->way =
        near->axis.x == 0 && near->axis.y == 0 && near->axis.z != 0 ? WH_GONE_UPRIGHT : WH_GONE_ANYWHERE;
    near->since = wh_world_since(wh_world_gone(near, a, b));
}

/* Forgets what was known about the separation of the two. */
static inline void wh_world_lose(wh_pair_t *near) {
    near->slack = WH_WORLD_UNKNOWN;
    near->exact = -1;
}

/* Forgets everything that was known about a pair. A pair with an absent part need not be judged. */
static inline void wh_world_forget(const wh_world_t *world, wh_mover_pair_t *pair) {
    const bool is_there = world->movers[pair->a].part != WH_NONE && world->movers[pair->b].part != WH_NONE;
    wh_world_lose(&pair->near);
    pair->near.slack = is_there ? pair->near.slack : WH_WORLD_NOWHERE;
    pair->near.since = 0;
    pair->near.axis = wh_vec3(0, 0, 0);
    const size_t index = (size_t)(pair - world->pairs);
    world->due.of[index] = world->due.soonest[index / WH_WORLD_BLOCK] = 0;
}

/* Takes the result of wh_gap_measure, which was asked whether the gap is more than `enough`. */
static inline void wh_world_take_gap(wh_pair_t *near, const wh_side_t *a, const wh_side_t *b,
                                     const wh_gap_t *gap, wh_real_t enough) {
    near->slack = gap->state == WH_GAP_CLEAR ? gap->gap : WH_WORLD_UNKNOWN;
    near->exact = gap->state == WH_GAP_CLEAR && gap->gap <= enough ? a->gone + b->gone : -1;
    near->axis = gap->axis;
    near->step = 0;
}

/* The start of the search for the gap of two parts. */
static inline wh_gap_start_t *wh_world_start(wh_world_t *world, int32_t a, int32_t b) {
    wh_start_t *start = &world->starts[((size_t)a * 31 + (size_t)b) % WH_WORLD_STARTS];
    if (start->parts[0] != a || start->parts[1] != b) {
        start->parts[0] = a;
        start->parts[1] = b;
        start->points.count = 0;
    }
    return &start->points;
}

/* The arguments of a step. */
typedef struct {
    wh_world_t *world;
    const wh_world_input_t *input;
    wh_event_list_t *list;
} wh_look_t;

/* From the tree's items to part numbers and back. The order of part numbers: fixed parts, hanging parts,
 * wafers. */
int32_t wh_world_part_of_item(const wh_world_t *world, int32_t item) WH_SYMBOL(wh_world_part_of_item);
int32_t wh_world_item_of_wafer(const wh_world_t *world, int32_t wafer) WH_SYMBOL(wh_world_item_of_wafer);
const wh_convex_t *wh_world_convex(const wh_world_t *world, int32_t part) WH_SYMBOL(wh_world_convex);

static inline size_t wh_world_arms(const wh_world_config_t *config) {
    return config->arm_count > 0 ? config->arm_count : 1;
}

/* The number of movers that hang on something; those of held wafers, by gripper, come after them. */
static inline size_t wh_world_hanging(const wh_world_t *world) {
    return world->config->part_count - world->fixed_count;
}

/* The body index of a gripper, of the wafer that it holds, and of a door. */
int32_t wh_world_gripper_body(size_t gripper) WH_SYMBOL(wh_world_gripper_body);
int32_t wh_world_held_body(size_t gripper) WH_SYMBOL(wh_world_held_body);
int32_t wh_world_door_body(size_t door) WH_SYMBOL(wh_world_door_body);

/* Call it when a wafer at rest has been put elsewhere. */
void wh_world_place_shape(wh_world_t *world, size_t wafer) WH_SYMBOL(wh_world_place_shape);

/* The side of a mover now; it is valid until something moves. */
const wh_side_t *wh_world_side_of_mover(const wh_world_t *world, wh_mover_t *mover)
    WH_SYMBOL(wh_world_side_of_mover);
wh_side_t wh_world_side_of_item(const wh_world_t *world, int32_t item) WH_SYMBOL(wh_world_side_of_item);

/* The box around its present place. */
wh_box_t wh_world_box(const wh_side_t *side) WH_SYMBOL(wh_world_box);

/* Takes the present places of everything. Wafers that were taken or released change between mover and
 * tree. */
void wh_world_move(const wh_look_t *look) WH_SYMBOL(wh_world_move);

/* Call it after the pairs were judged: released wafers rest from now on. */
void wh_world_settle(const wh_look_t *look) WH_SYMBOL(wh_world_settle);

/* Makes the mover's list of things at rest again. */
void wh_world_list_anew(wh_world_t *world, wh_mover_t *mover) WH_SYMBOL(wh_world_list_anew);

/* How far from the mover its list looks, mm, if that is not too much for its room. */
static inline wh_real_t wh_world_margin(const wh_mover_t *mover) {
    return WH_CLEARANCE_RANGE + mover->motion + WH_NEAR_MARGIN;
}

/* The way that a list which looks so far is valid for. */
static inline wh_real_t wh_world_reach(const wh_mover_t *mover, wh_real_t margin) {
    return margin - mover->motion - WH_CLEARANCE_RANGE;
}

/* Does so if it has moved as far as the list is valid. A list that was empty within more than its margin is
 * empty again; its next one is due when it would be. */
static inline void wh_world_list_near(wh_world_t *world, wh_mover_t *mover) {
    if (mover->reach > 0) {
        return;
    }
    if (mover->clear > 0) {
        mover->reach = wh_world_reach(mover, wh_world_margin(mover));
        ++world->counters.relisted;
    } else {
        wh_world_list_anew(world, mover);
    }
}

/* Reports contact as undecided, because this mover has more near things than its list can hold. */
void wh_world_report_crowd(const wh_look_t *look, const wh_side_t *a, size_t crowd)
    WH_SYMBOL(wh_world_report_crowd);

/* True if the pair cannot matter in this slice: it stays apart, and by more than its smallest gaps so far.
 * `b` is null if the other one rests. */
bool wh_world_is_far(const wh_world_t *world, wh_pair_t *near, const wh_mover_t *a, const wh_mover_t *b)
    WH_SYMBOL(wh_world_is_far);

/* Judges one pair for this slice. */
void wh_world_judge(const wh_look_t *look, const wh_side_t *a, const wh_side_t *b, wh_pair_t *near)
    WH_SYMBOL(wh_world_judge);

/* Finishes the bin of the curves if this slice is its end, and begins the next one. */
void wh_world_draw_curves(const wh_look_t *look) WH_SYMBOL(wh_world_draw_curves);

/* The arm of a part of this kind and owner, which is on a robot. A held wafer counts as a blade, with its
 * gripper as owner. WH_NONE: it is on no arm. */
int32_t wh_world_arm_of(const wh_world_config_t *config, wh_part_kind_t kind, int32_t owner)
    WH_SYMBOL(wh_world_arm_of);

/* The clearances for which a mover's gaps to something count. `arm` is that of the other one; WH_NONE: it
 * is on none. */
wh_worth_t wh_world_worth_of(const wh_world_config_t *config, const wh_mover_t *mover, wh_part_kind_t kind,
                             int32_t arm) WH_SYMBOL(wh_world_worth_of);

/* The largest of the gaps, by clearance, that may count. */
wh_real_t wh_world_most_of(wh_worth_t worth, const wh_real_t gaps[]) WH_SYMBOL(wh_world_most_of);

/* Keeps a gap that is the smallest of its kind in the run. */
void wh_world_keep_clearance(const wh_look_t *look, wh_clearance_kind_t kind, const wh_side_t *a,
                             const wh_side_t *b, const wh_gap_t *gap) WH_SYMBOL(wh_world_keep_clearance);

/* Writes world->gaps.worth again, after a change in world->gaps.least. */
void wh_world_weigh(wh_world_t *world) WH_SYMBOL(wh_world_weigh);

/* True if the pair need not be judged, by config->known. */
bool wh_world_is_known(const wh_world_t *world, int32_t one, int32_t other) WH_SYMBOL(wh_world_is_known);

/* True for parts that never move against each other, or are neighbours by design. */
bool wh_world_belong_together(const wh_world_config_t *config, const wh_part_t *a, const wh_part_t *b)
    WH_SYMBOL(wh_world_belong_together);

/* True if the two may touch now. */
bool wh_world_may_touch(const wh_look_t *look, const wh_side_t *a, const wh_side_t *b)
    WH_SYMBOL(wh_world_may_touch);

/* The clearance that the pair counts for; WH_CLEARANCES: none. */
wh_clearance_kind_t wh_world_clearance_of(const wh_look_t *look, const wh_side_t *a, const wh_side_t *b)
    WH_SYMBOL(wh_world_clearance_of);

#endif
