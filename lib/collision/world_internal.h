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
    wh_real_t way;         /* of its origin, mm */
    wh_real_t turn;        /* about its origin, rad; an upper bound */
} wh_body_t;

/* A pair and its state: after the last slice the gap was at least `slack`, and `axis` (zero: none yet)
 * separated them. */
typedef struct {
    int32_t other; /* an item of the tree, or a mover */
    wh_real_t slack;
    wh_vec3_t axis;
} wh_pair_t;

/* A convex part that moves: one that hangs on a body, or the wafer that a gripper holds. */
typedef struct {
    int32_t part;          /* WH_NONE: this gripper holds none */
    int32_t body;          /* index in world->bodies */
    wh_pose_t before, now; /* base_from_shape, once someone has asked in this slice: is_placed */
    bool is_placed;
    wh_real_t radius; /* of a ball about the body's origin that holds the part */
    wh_real_t motion; /* the most that a point of it moved in this slice, mm */
    wh_real_t bulge;  /* the most that a point left its straight way */
    wh_pair_t *near;  /* things that rest, room for WH_NEAR_CAPACITY */
    size_t near_count;
    wh_real_t reach; /* how much farther it may move before the list must be made again */
    bool crowded;    /* more things are near than the list can hold */
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

struct wh_world {
    const wh_world_config_t *config;
    size_t fixed_count; /* parts that hang on nothing. The tree's items are these, then the wafers */
    wh_tree_t tree;
    wh_box_t *boxes;                                         /* of the tree's items, for building it */
    wh_pose_t *wafers;                                       /* base_from_wafer, as of the last slice */
    size_t set_down;                                         /* wafers set down since the tree was built */
    wh_body_t bodies[WH_ARM_BODIES + 2 * WH_WORLD_GRIPPERS]; /* arm, grippers, what each holds */
    wh_mover_t *movers;
    size_t mover_count;
    wh_mover_pair_t *pairs;
    size_t pair_count;
    wh_pair_t *near;
    int32_t held[WH_WORLD_GRIPPERS];
    wh_left_t left[WH_WORLD_GRIPPERS];
    wh_clearance_t clearances[WH_CLEARANCES];
    bool too_close[WH_CLEARANCES]; /* reported */
    bool struck;                   /* contact was reported and is no longer judged */
    wh_real_t range;               /* a gap above it comes to nothing */
    wh_curves_t curves;
    wh_world_counters_t counters;
};

/* One part of a pair, as the judgement sees it. */
typedef struct {
    int32_t part;
    wh_part_kind_t kind;
    int32_t owner, slot;
    const wh_convex_t *convex;
    const wh_body_t *body; /* null: it rests */
    wh_pose_t before, now; /* base_from_shape */
    wh_real_t motion, bulge;
} wh_side_t;

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

/* The body index of a gripper, and of the wafer that it holds. */
int32_t wh_world_gripper_body(size_t gripper) WH_SYMBOL(wh_world_gripper_body);
int32_t wh_world_held_body(size_t gripper) WH_SYMBOL(wh_world_held_body);

wh_side_t wh_world_side_of_mover(const wh_world_t *world, wh_mover_t *mover)
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

/* Judges one pair for this slice. */
void wh_world_judge(const wh_look_t *look, const wh_side_t *a, const wh_side_t *b, wh_pair_t *near)
    WH_SYMBOL(wh_world_judge);

/* Keeps the smallest gaps at the end of a bin. Changes nothing else. */
void wh_world_draw_curves(const wh_look_t *look) WH_SYMBOL(wh_world_draw_curves);

/* True if the pair need not be judged: config->known. */
bool wh_world_is_known(const wh_world_t *world, int32_t one, int32_t other) WH_SYMBOL(wh_world_is_known);

/* True for parts that never move against each other, or are neighbours by design. */
bool wh_world_belong_together(const wh_part_t *a, const wh_part_t *b) WH_SYMBOL(wh_world_belong_together);

/* True if the two may touch now. */
bool wh_world_may_touch(const wh_look_t *look, const wh_side_t *a, const wh_side_t *b)
    WH_SYMBOL(wh_world_may_touch);

/* The clearance that the pair counts for; WH_CLEARANCES: none. */
wh_clearance_kind_t wh_world_clearance_of(const wh_look_t *look, const wh_side_t *a, const wh_side_t *b)
    WH_SYMBOL(wh_world_clearance_of);

#endif
