/* The interface of a peer in a race: peer_NAME.so exports one of these as `bench_peer`, or
 * colliders as `bench_cell`. A peer copies the wafers into the structure that is best for it; this
 * is not timed. */
#ifndef WH_TESTS_BENCH_PEERS_H
#define WH_TESTS_BENCH_PEERS_H

#include <waferhand.h>

#include "collision/convex.h"

#ifdef __cplusplus
#define BENCH_PEER extern "C" __attribute__((visibility("default"))) const
#else
#define BENCH_PEER __attribute__((visibility("default"))) const
#endif

enum { BENCH_VARIANTS = 8 };

/* The check, or the peer's substitute for it. `count` returns how many pairs of wafer and gripper
 * are ready (in contact). */
typedef struct {
    const char *name;
    void *(*build)(const wh_pose_t *wafers, size_t count, const wh_tolerance_t *tolerance);
    uint64_t (*count)(void *built, const wh_pose_t *grippers, size_t gripper_count);
    void (*drop)(void *built);
} bench_check_variant_t;

/* The list of variants ends with one that has no name. */
typedef struct {
    bench_check_variant_t variants[BENCH_VARIANTS];
} bench_check_peer_t;

/* The number of wafers near each gripper, and of ready ones: 2^32 for a ready one, 1 for a near one. */
typedef struct {
    const char *name;
    void *(*build)(const wh_pose_t *wafers, size_t count, const wh_grasp_config_t *config);
    uint64_t (*look)(void *built, const wh_pose_t *grippers, size_t gripper_count);
    void (*drop)(void *built);
} bench_index_peer_t;

/* A slice of a world in which `wafers` discs lie apart from each other, and one gripper moves. */
typedef struct {
    const char *name;
    void *(*build)(size_t wafers);
    uint64_t (*step)(void *world, const wh_pose_t *gripper);
    void (*drop)(void *world);
} bench_world_t;

typedef struct {
    bench_world_t worlds[BENCH_VARIANTS];
} bench_step_peer_t;

/* A cell's shapes, all at rest. Two neighbours (count x count) are never checked against each other. */
typedef struct {
    const wh_convex_t *const *convex;
    const wh_pose_t *base_from_shape;
    const bool *neighbours;
    const bool *moves; /* true: the shape may move at some time */
    size_t count;
} bench_cell_t;

/* A shape that moves, at both ends of a slice. The shapes of one group are rigid, and are not
 * checked against each other. */
typedef struct {
    int32_t shape, group;
    wh_pose_t before, now;
} bench_mover_t;

/* The moving shapes. All other shapes rest at their last place. */
typedef struct {
    const bench_mover_t *movers;
    size_t count;
} bench_slice_t;

/* A pair with a moving shape that touches or overlaps; or the nearest pair with its gap, mm. */
typedef struct {
    int32_t a, b;
    double gap;
} bench_near_t;

typedef struct {
    const char *name;
    bool is_nearest; /* `look` gives the nearest pair, if one is within 20 mm; else those that touch */
    void *(*build)(const bench_cell_t *cell);
    size_t (*look)(void *built, const bench_slice_t *slice, bench_near_t found[], size_t capacity);
    void (*drop)(void *built);
} bench_collider_t;

/* The duration of a synchronised move from rest to rest of `axes` axes. */
typedef struct {
    const char *name;
    void *(*build)(size_t axes, const wh_limits_t limits[]);
    double (*plan)(void *planner, const double from[], const double to[]);
    void (*drop)(void *planner);
} bench_profile_peer_t;

#endif
