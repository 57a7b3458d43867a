/* Shared within the collision world: bodies that move (world_move.c), lists of what is near (world_near.c),
 * the judgement of one pair (world_pair.c), what may touch what (world_rules.c). */
#ifndef WH_COLLISION_WORLD_INTERNAL_H
#define WH_COLLISION_WORLD_INTERNAL_H

#include "gap.h"
#include "world.h"

/* How far beyond the range of clearances things are put on a moving part's list, mm; less if too many are
 * there. */
#define WH_NEAR_MARGIN WH_REAL(20.0)
#define WH_NEAR_LEAST WH_REAL(0.1)
#define WH_NEAR_CAPACITY 128

/* After this many wafers have been set down elsewhere the tree is built again. */
#define WH_REST_REBUILD 32

/* A body that moves, at both ends of the slice. */
typedef struct {
    wh_pose_t before, now; /* base_from_body */
    bool has_gone;         /* in this slice */
    wh_real_t way;         /* of its origin, mm */
    wh_real_t turn;        /* about its origin, rad; an upper bound */
    wh_real_t lean;        /* how much of that brings points 1 mm from the origin up or down, mm */
} wh_body_t;

/* The slack of pairs with what is not there: no way is as long, mm. */
#define WH_WORLD_NOWHERE WH_REAL(1e30)

/* The ways that movers have gone are summed up twice: all of them, and those up and down. Arms turn and reach
 * at one height for most of the time. */
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

/* A pair and its state: when its movers had gone `since` together, the gap was at least `slack`, and so was
 * the separation along `axis` (zero: none yet, and no slack above 0). */
typedef struct {
    int32_t other;    /* an item of the tree, or a mover */
    wh_worth_t worth; /* which of world->worth */
    wh_gone_t way;    /* by which the pair can come closer: UPRIGHT if the axis is */
    wh_real_t slack, since;
    wh_vec3_t axis;
    wh_real_t parted; /* how far apart along the axis the two were at the end of this step of the world */
    uint32_t step;    /* 0: not known */
    wh_real_t exact;  /* `slack` was the gap when both had gone so far in any way; -1: it is a bound */
    uint32_t again;   /* from this step on it is worth while to ask how far apart the two are by now */
} wh_pair_t;

/* One part of a pair, as the judgement sees it. */
typedef struct {
    int32_t part;
    wh_part_kind_t kind;
    int32_t owner, slot;
    const wh_convex_t *convex;
    const wh_body_t *body;         /* null: it rests */
    const wh_pose_t *before, *now; /* base_from_shape */
    wh_real_t motion, bulge;
    wh_real_t gone; /* so far, in whatever way */
} wh_side_t;

/* A convex part that moves: one that hangs on a body, or the wafer that a gripper holds. */
typedef struct {
    int32_t part; /* WH_NONE: this gripper holds none */
    int32_t body; /* index in world->bodies */
    wh_part_kind_t kind;
    int32_t arm;                  /* that it hangs on, or whose gripper holds it; WH_NONE: on none */
    wh_pose_t before, now;        /* base_from_shape, if is_placed */
    bool is_placed, was_placed;   /* someone has asked in this slice; in the one before */
    wh_real_t radius;             /* of a ball about the body's origin that holds the part */
    wh_real_t motion;             /* the most that a point of it moved in this slice, mm */
    wh_real_t rise;               /* the same, up or down */
    wh_real_t gone[WH_GONE_WAYS]; /* the sums of both */
    wh_real_t bulge;              /* the most that a point left its straight way */
    wh_pair_t *near;              /* things that rest, room for WH_NEAR_CAPACITY */
    size_t near_count;
    wh_real_t reach; /* how much farther it may move before the list must be made again */
    bool crowded;    /* more things are near than the list can hold */
    wh_side_t side;  /* as it was asked for last */
} wh_mover_t;

/* A pair of movers. */
typedef struct {
    int32_t a, b;
    wh_pair_t near;
} wh_mover_pair_t;

/* The wafer that a gripper let go last, until the gripper has gone sideways from there. */
typedef struct {
    int32_t wafer;
    wh_vec3_t at;
} wh_left_t;

/* With which the search for a pair's gap begins. Few pairs are near at a time: they share these, each its
 * own place by the numbers of its parts, and take turns where two have the same. */
#define WH_WORLD_STARTS 256

typedef struct {
    int32_t parts[2];
    wh_gap_start_t points;
} wh_start_t;

/* Gaps are known better than this, mm. A gap that is smaller by less is not a new minimum. */
#define WH_SAME_GAP WH_REAL(1e-4)

struct wh_world {
    const wh_world_config_t *config;
    size_t fixed_count; /* parts that hang on nothing. The tree's items are these, then the wafers */
    wh_tree_t tree;
    wh_box_t *boxes;   /* of the tree's items, for building it */
    wh_pose_t *wafers; /* base_from_wafer, as of the last slice */
    wh_pose_t *shapes; /* of wafers that rest: base_from_shape */
    uint32_t step;     /* this one, from 1 */
    size_t set_down;   /* wafers set down since the tree was built */
    /* of the arms, then the grippers', then of what each holds, then the doors' */
    wh_body_t bodies[WH_ARM_BODIES * WH_WORLD_ARMS + 2 * WH_WORLD_GRIPPERS + WH_WORLD_DOORS];
    wh_mover_t *movers;
    size_t mover_count;
    wh_mover_pair_t *pairs;
    size_t pair_count;
    wh_start_t starts[WH_WORLD_STARTS];
    double *due; /* of each pair: when `gone` is that, something can come of it */
    double gone; /* at least as far as any two movers have gone together, mm */
    wh_pair_t *near;
    int32_t held[WH_WORLD_GRIPPERS];
    wh_left_t left[WH_WORLD_GRIPPERS];
    wh_clearance_t clearances[WH_CLEARANCES];
    bool too_close[WH_CLEARANCES]; /* reported */
    bool struck;                   /* a hit was reported; contact is no longer judged */
    bool undecided;                /* that was reported */
    uint64_t slice;                /* the last one */
    /* The smallest gaps of the bin of the curves that is not finished; of the run if no curves are kept. */
    wh_real_t least[WH_CLEARANCES];
    wh_real_t worth[WH_WORTHS]; /* a gap above it comes to nothing: it is no new `least` */
    wh_curves_t curves;
    wh_world_counters_t counters;
};

/* How far both have gone, in the way that counts for the pair. `b` is null if the other one rests. */
static inline wh_real_t wh_world_gone(const wh_pair_t *near, const wh_mover_t *a, const wh_mover_t *b) {
    return a->gone[near->way] + (b ? b->gone[near->way] : 0);
}

/* A lower bound of the gap of two movers by now. */
static inline wh_real_t wh_world_slack(const wh_mover_pair_t *pair, const wh_mover_t movers[]) {
    const wh_pair_t *near = &pair->near;
    const wh_real_t gone = movers[pair->a].gone[near->way] + movers[pair->b].gone[near->way];
    return near->slack - (gone - near->since);
}

/* To be called when slack and axis are those at the end of this slice. */
static inline void wh_world_remember(wh_pair_t *near, const wh_mover_t *a, const wh_mover_t *b) {
    near->way =
        near->axis.x == 0 && near->axis.y == 0 && near->axis.z != 0 ? WH_GONE_UPRIGHT : WH_GONE_ANYWHERE;
    near->since = wh_world_gone(near, a, b);
}

/* Forgets all that was known of a pair. A pair with what is not there needs no look. */
static inline void wh_world_forget(const wh_world_t *world, wh_mover_pair_t *pair) {
    const bool is_there = world->movers[pair->a].part != WH_NONE && world->movers[pair->b].part != WH_NONE;
    pair->near.slack = is_there ? 0 : WH_WORLD_NOWHERE;
    pair->near.since = 0;
    pair->near.axis = wh_vec3(0, 0, 0);
    pair->near.exact = -1;
    world->due[pair - world->pairs] = 0;
}

/* Takes over what wh_gap_measure has found, which was asked whether the gap is more than `enough`. */
static inline void wh_world_take_gap(wh_pair_t *near, const wh_side_t *a, const wh_side_t *b,
                                     const wh_gap_t *gap, wh_real_t enough) {
    near->slack = gap->state == WH_GAP_CLEAR ? gap->gap : 0;
    near->exact = gap->state == WH_GAP_CLEAR && gap->gap <= enough ? a->gone + b->gone : -1;
    near->axis = gap->axis;
    near->step = 0;
}

/* Where the search for the gap of two parts begins. */
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

/* From the tree's items to part numbers and back. Parts are numbered: fixed parts, those that hang,
 * wafers. */
int32_t wh_world_part_of_item(const wh_world_t *world, int32_t item) WH_SYMBOL(wh_world_part_of_item);
int32_t wh_world_item_of_wafer(const wh_world_t *world, int32_t wafer) WH_SYMBOL(wh_world_item_of_wafer);
const wh_convex_t *wh_world_convex(const wh_world_t *world, int32_t part) WH_SYMBOL(wh_world_convex);

static inline size_t wh_world_arms(const wh_world_config_t *config) {
    return config->arm_count > 0 ? config->arm_count : 1;
}

/* How many movers hang on something; those of held wafers, by gripper, come behind them. */
static inline size_t wh_world_hanging(const wh_world_t *world) {
    return world->config->part_count - world->fixed_count;
}

/* The body index of a gripper, of the wafer that it holds, and of a door. */
int32_t wh_world_gripper_body(size_t gripper) WH_SYMBOL(wh_world_gripper_body);
int32_t wh_world_held_body(size_t gripper) WH_SYMBOL(wh_world_held_body);
int32_t wh_world_door_body(size_t door) WH_SYMBOL(wh_world_door_body);

/* To be called when a wafer that rests has been put elsewhere. */
void wh_world_place_shape(wh_world_t *world, size_t wafer) WH_SYMBOL(wh_world_place_shape);

/* What is near is as the world is: valid until something moves. */
const wh_side_t *wh_world_side_of_mover(const wh_world_t *world, wh_mover_t *mover)
    WH_SYMBOL(wh_world_side_of_mover);
wh_side_t wh_world_side_of_item(const wh_world_t *world, int32_t item) WH_SYMBOL(wh_world_side_of_item);

/* The box around it where it is now. */
wh_box_t wh_world_box(const wh_side_t *side) WH_SYMBOL(wh_world_box);

/* Takes over where everything is now. Wafers that were taken or let go change between mover and tree. */
void wh_world_move(const wh_look_t *look) WH_SYMBOL(wh_world_move);

/* Called after the pairs were judged: what was let go rests from now on. */
void wh_world_settle(const wh_look_t *look) WH_SYMBOL(wh_world_settle);

/* Makes the mover's list again if it has moved as far as the list reaches. */
void wh_world_list_near(wh_world_t *world, wh_mover_t *mover) WH_SYMBOL(wh_world_list_near);

/* Reports contact as undecided: more is near to this mover than its list can hold. */
void wh_world_report_crowd(const wh_look_t *look, const wh_side_t *a) WH_SYMBOL(wh_world_report_crowd);

/* True if nothing can come of the pair in this slice: it stays apart, and by more than its smallest gaps so
 * far. `b` is null if the other one rests. */
bool wh_world_is_far(const wh_world_t *world, wh_pair_t *near, const wh_mover_t *a, const wh_mover_t *b)
    WH_SYMBOL(wh_world_is_far);

/* Judges one pair for this slice. */
void wh_world_judge(const wh_look_t *look, const wh_side_t *a, const wh_side_t *b, wh_pair_t *near)
    WH_SYMBOL(wh_world_judge);

/* Finishes the bin of the curves if this slice is its end, and begins the next one. */
void wh_world_draw_curves(const wh_look_t *look) WH_SYMBOL(wh_world_draw_curves);

/* The arm of a part of this kind and owner, which is on a robot; of a held wafer as of a blade, its
 * gripper being the owner. WH_NONE: on none. */
int32_t wh_world_arm_of(const wh_world_config_t *config, wh_part_kind_t kind, int32_t owner)
    WH_SYMBOL(wh_world_arm_of);

/* What a mover's gaps to something count for. `arm` is the other one's; WH_NONE: it is on none. */
wh_worth_t wh_world_worth_of(const wh_world_config_t *config, const wh_mover_t *mover, wh_part_kind_t kind,
                             int32_t arm) WH_SYMBOL(wh_world_worth_of);

/* The largest of those of the gaps, by clearance, that may count. */
wh_real_t wh_world_most_of(wh_worth_t worth, const wh_real_t gaps[]) WH_SYMBOL(wh_world_most_of);

/* Keeps a gap that is the run's smallest of its kind. */
void wh_world_keep_clearance(const wh_look_t *look, wh_clearance_kind_t kind, const wh_side_t *a,
                             const wh_side_t *b, const wh_gap_t *gap) WH_SYMBOL(wh_world_keep_clearance);

/* Writes world->worth anew, after one of world->least has changed. */
void wh_world_weigh(wh_world_t *world) WH_SYMBOL(wh_world_weigh);

/* True if the pair need not be judged: config->known. */
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
