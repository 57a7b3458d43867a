/* Pairs of all shapes overlap or just touch before anything moves, stand, and part. Others come to
 * touch, stand, part and meet in the end. The world's hits, smallest gaps and curves are compared
 * with a plain loop that measures each slice. Pairs stand for any number of slices, so that a bin
 * of the curves ends at every phase. */
#include "collision/gap.h"
#include "collision/world.h"
#include "math/trig.h"
#include "support/pose.h"
#include "support/support.h"

enum { RUNS = 900 / WH_TEST_SHARE, MOST_SLICES = 120, POINTS = 9, INSTANTS = 16 };

/* The verdict on contact is open between these depths along the pair's axis: WH_GAP_TOUCH and 1.74
 * times it, plus rounding. */
#define SHALLOW 0.9e-3
#define DEEP 3e-3

/* The kind of body that the blade of gripper 0 meets. */
typedef enum { A_FIXED, A_BLADE, A_DOOR, AN_ARM, A_WAFER, OTHERS } other_t;

/* All inputs that a world reads. */
typedef struct {
    other_t other;
    wh_part_t parts[2];
    wh_vec3_t points[2][POINTS];
    wh_world_config_t config;
    wh_cell_t cell;
    wh_grasp_config_t grasp;
    wh_wafer_t wafers[1];
    wh_gripper_t grippers[2];
    wh_pose_t arms[2 * WH_ARM_BODIES], doors[1];
    wh_pose_t kiss[2]; /* the poses of both bodies, when the shapes just touch */
    wh_vec3_t axis;    /* from the blade to the other one, along which they part */
    wh_real_t share;   /* the blade's share of the way */
    wh_vec3_t aside;   /* the way aside for each mm of the way */
} scene_t;

/* The end of one slice, as the plain loop sees it. */
typedef struct {
    wh_pose_t bodies[2];
    wh_gap_state_t state;
    wh_real_t gap, along;
} look_t;

/* Counts over all runs. */
typedef struct {
    int hits, parted, open;
} counts_t;

/* ---------------------------------------------------------------------------------------------- the scene */

static wh_pose_t any_pose(double far) {
    wh_pose_t pose =
        wh_test_at(wh_test_uniform(-far, far), wh_test_uniform(-far, far), wh_test_uniform(-far, far));
    if (wh_test_below(3) != 0) {
        pose.R = wh_mat3_from_rpy_deg(wh_test_uniform(-180, 180), wh_test_uniform(-80, 80),
                                      wh_test_uniform(-180, 180));
    }
    return pose;
}

static wh_convex_t any_shape(wh_vec3_t points[]) {
    wh_convex_t shape = {.kind = (wh_convex_kind_t)wh_test_below(4), .body_from_shape = any_pose(60)};
    shape.half = wh_vec3(wh_test_uniform(1, 120), wh_test_uniform(1, 120), wh_test_uniform(1, 120));
    for (int i = 0; i < POINTS; ++i) {
        points[i] = wh_vec3(wh_test_uniform(-90, 90), wh_test_uniform(-90, 90), wh_test_uniform(-90, 90));
    }
    shape.points = points;
    shape.point_count = POINTS;
    return shape;
}

static wh_part_t other_part(other_t other) {
    static const wh_part_t parts[OTHERS] = {{.kind = WH_PART_FIXED, .owner = WH_NONE},
                                            {.kind = WH_PART_BLADE, .owner = 1},
                                            {.kind = WH_PART_DOOR, .owner = 0},
                                            {.kind = WH_PART_ARM, .owner = WH_ARM_BODIES + WH_ARM_HAND},
                                            {.kind = WH_PART_WAFER, .owner = 0}};
    return parts[other];
}

/* The blade's part stands second, behind a body that does not move. */
static void describe(scene_t *scene) {
    static const wh_world_arm_t arms[2] = {{0, WH_ARM_BASE}, {1, WH_ARM_BASE}};
    static const uint8_t carried_by[2] = {0, 1};
    const size_t blade = scene->other == A_FIXED ? 1 : 0;
    scene->parts[blade] =
        (wh_part_t){.kind = WH_PART_BLADE, .owner = 0, .convex = any_shape(scene->points[0])};
    scene->parts[1 - blade] = other_part(scene->other);
    scene->parts[1 - blade].convex = any_shape(scene->points[1]);
    scene->grasp = wh_grasp_config_default();
    scene->config = (wh_world_config_t){.parts = scene->parts,
                                        .part_count = scene->other == A_WAFER ? 1 : 2,
                                        .gripper_count = 2,
                                        .wafer_count = 1,
                                        .door_count = 1,
                                        .arm_count = 2,
                                        .arms = arms,
                                        .carried_by = carried_by,
                                        .cell = &scene->cell,
                                        .grasp = &scene->grasp};
    scene->config.wafer = (wh_convex_t){.kind = WH_CONVEX_CYLINDER, .half = {150, 0, 0.3875}};
    scene->config.wafer.body_from_shape = wh_test_at(0, 0, 0.3875);
    if (scene->other == A_WAFER) {
        scene->parts[1].convex = scene->config.wafer;
    }
}

static const wh_convex_t *shape_of(const scene_t *scene, size_t i) {
    const size_t blade = scene->other == A_FIXED ? 1 : 0;
    return &scene->parts[i == 0 ? blade : 1 - blade].convex;
}

static look_t look_at(const scene_t *scene, const wh_pose_t bodies[2]) {
    look_t look = {.bodies = {bodies[0], bodies[1]}};
    wh_pose_t at[2];
    wh_gap_t gap;
    for (size_t i = 0; i < 2; ++i) {
        at[i] = wh_pose_compose(&bodies[i], &shape_of(scene, i)->body_from_shape);
    }
    wh_gap_measure(shape_of(scene, 0), &at[0], shape_of(scene, 1), &at[1], WH_CLEARANCE_RANGE, scene->axis,
                   &gap);
    look.state = gap.state;
    look.gap = gap.gap;
    look.along = wh_gap_along(shape_of(scene, 0), &at[0], shape_of(scene, 1), &at[1], scene->axis);
    return look;
}

/* Moves the blade to the other body until they just touch. A body that does not move has its own
 * frame. False if they do not touch. */
static bool find_kiss(scene_t *scene) {
    const bool stands = scene->other == A_FIXED;
    scene->kiss[1] = stands ? wh_pose_identity() : any_pose(wh_test_decades(1, 5000));
    scene->kiss[0] = scene->kiss[1];
    scene->kiss[0].r.x += 400;
    scene->kiss[0].R = wh_mat3_from_rpy_deg(0, 0, wh_test_uniform(-180, 180));
    for (int i = 0; i < 6; ++i) {
        wh_pose_t at[2];
        wh_gap_t gap;
        for (size_t k = 0; k < 2; ++k) {
            at[k] = wh_pose_compose(&scene->kiss[k], &shape_of(scene, k)->body_from_shape);
        }
        wh_gap_measure(shape_of(scene, 0), &at[0], shape_of(scene, 1), &at[1], 1e6, wh_vec3(0, 0, 0), &gap);
        if (gap.state != WH_GAP_CLEAR) {
            return gap.state == WH_GAP_TOUCHING && i > 0;
        }
        const wh_vec3_t way = wh_vec3_scale(gap.gap, &gap.axis);
        scene->kiss[0].r = wh_vec3_add(&scene->kiss[0].r, &way);
        scene->axis = gap.axis;
    }
    return false;
}

/* Both bodies when the shapes are this far apart along the axis. */
static void place(const scene_t *scene, wh_real_t apart, wh_pose_t bodies[2]) {
    const bool stands = scene->other == A_FIXED || scene->other == A_WAFER;
    const wh_real_t share = stands ? 1 : scene->share;
    const wh_vec3_t back = wh_vec3_scale(-share * apart, &scene->axis);
    const wh_vec3_t on = wh_vec3_scale((1 - share) * apart, &scene->axis);
    const wh_vec3_t aside = wh_vec3_scale(apart, &scene->aside);
    bodies[0] = scene->kiss[0];
    bodies[1] = scene->kiss[1];
    bodies[0].r = wh_vec3_add(&bodies[0].r, &back);
    bodies[0].r = wh_vec3_add(&bodies[0].r, &aside);
    bodies[1].r = wh_vec3_add(&bodies[1].r, &on);
}

/* ------------------------------------------------------------------------------------------------ the way */

static size_t stand(wh_real_t way[], size_t count, uint32_t most) {
    const size_t end = count + wh_test_below(most + 1);
    for (; count < end; ++count) {
        way[count] = way[count - 1];
    }
    return count;
}

static size_t go(wh_real_t way[], size_t count, wh_real_t to, uint32_t most) {
    const size_t slices = 1 + wh_test_below(most);
    const wh_real_t from = way[count - 1];
    for (size_t i = 1; i <= slices; ++i) {
        way[count++] = i == slices ? to : from + (to - from) * (wh_real_t)i / (wh_real_t)slices;
    }
    return count;
}

/* Their distance when they just touch. */
static wh_real_t any_kiss(void) {
    static const wh_real_t kisses[] = {0, 0, 1e-13, -1e-13, 0.5e-3, -0.5e-3};
    return kisses[wh_test_below(6)];
}

/* The distance of the two along the axis in each slice; the first is the start of the run. */
static size_t plan(wh_real_t way[]) {
    const uint32_t how = wh_test_below(4);
    size_t count = 1;
    way[0] = how == 0 ? any_kiss() : how == 1 ? wh_test_decades(0.01, 60) : -wh_test_decades(4e-3, 12);
    count = stand(way, count, 48);
    if (how == 1) {
        count = go(way, count, any_kiss(), 8);
        count = stand(way, count, 24);
    }
    count = go(way, count, wh_test_decades(0.02, 30), 8);
    if (how < 2) {
        count = stand(way, count, 8);
        count = go(way, count, -wh_test_decades(4e-3, 3), 8);
    }
    return count;
}

/* ------------------------------------------------------------------------------------------------ the run */

static wh_world_input_t show(scene_t *scene, const wh_pose_t bodies[2], uint64_t slice) {
    scene->grippers[0].base_from_gripper = bodies[0];
    scene->grippers[1].base_from_gripper = scene->other == A_BLADE ? bodies[1] : wh_test_at(0, 0, 9000);
    scene->doors[0] = scene->other == A_DOOR ? bodies[1] : wh_pose_identity();
    for (size_t i = 0; i < 2 * (size_t)WH_ARM_BODIES; ++i) {
        scene->arms[i] = scene->other == AN_ARM ? bodies[1] : wh_pose_identity();
    }
    scene->wafers[0].base_from_wafer = scene->other == A_WAFER ? bodies[1] : wh_test_at(0, 0, -9000);
    return (wh_world_input_t){slice, scene->wafers, scene->grippers, scene->arms, scene->doors};
}

static bool set_up(scene_t *scene) {
    memset(scene, 0, sizeof *scene);
    scene->other = (other_t)wh_test_below(OTHERS);
    scene->share = wh_test_below(2) == 0 ? 1 : wh_test_uniform(0, 1);
    scene->aside =
        wh_test_below(2) == 0 ? wh_vec3(0, 0, 0) : wh_vec3(wh_test_uniform(-1, 1), wh_test_uniform(-1, 1), 0);
    describe(scene);
    scene->grippers[0].wafer = scene->grippers[1].wafer = WH_NONE;
    scene->grippers[0].valve = scene->grippers[1].valve = WH_VALVE_CLOSED;
    scene->wafers[0].holder = scene->wafers[0].released_by = WH_NONE;
    return wh_world_validate(&scene->config, NULL) == WH_OK && find_kiss(scene);
}

static bool is_deep(const look_t *look) {
    return look->state == WH_GAP_HIT && look->along < -DEEP;
}

static bool is_free(const look_t *look) {
    return (look->state == WH_GAP_CLEAR || look->state == WH_GAP_TOUCHING) && look->along > -SHALLOW;
}

/* True if the two come this near between two slices, both of which are free. */
static bool dips(const scene_t *scene, const look_t *from, const look_t *to) {
    bool near = false;
    for (int i = 1; i < INSTANTS; ++i) {
        wh_pose_t bodies[2] = {to->bodies[0], to->bodies[1]};
        for (size_t k = 0; k < 2; ++k) {
            const wh_vec3_t way = wh_vec3_subtract(&to->bodies[k].r, &from->bodies[k].r);
            const wh_vec3_t part = wh_vec3_scale((wh_real_t)i / (wh_real_t)INSTANTS, &way);
            bodies[k].r = wh_vec3_add(&from->bodies[k].r, &part);
        }
        const look_t look = look_at(scene, bodies);
        near = near || !is_free(&look) || (look.gap < 0.02 && from->gap > 0.02 && to->gap > 0.02);
    }
    return near;
}

/* The smallest gap to the bodies that the blade may meet, over all kinds. */
static wh_real_t least_of(const wh_world_t *world) {
    wh_real_t least = WH_CLEARANCE_RANGE;
    for (int kind = 0; kind < WH_CLEARANCES; ++kind) {
        const wh_real_t gap = wh_world_clearances(world)[kind].gap;
        least = gap < least ? gap : least;
    }
    return least;
}

static wh_real_t last_bin(const wh_curves_t *curves) {
    wh_real_t least = WH_CLEARANCE_RANGE;
    for (int kind = 0; kind < WH_CLEARANCES; ++kind) {
        const wh_real_t gap = curves->gaps[kind][curves->count - 1];
        least = gap < least ? gap : least;
    }
    return least;
}

/* The smallest gaps so far: of bodies that have moved, and of this bin of the curves. */
typedef struct {
    wh_real_t least, bin, now;
} gaps_t;

static void compare(const wh_world_t *world, uint64_t slice, const look_t *now, bool moves, gaps_t *gaps) {
    const wh_curves_t *curves = wh_world_curves(world);
    const wh_real_t gap = now->gap < WH_CLEARANCE_RANGE ? now->gap : WH_CLEARANCE_RANGE;
    const bool ends = (slice - curves->first) % curves->slices == 0;
    gaps->least = (moves || ends) && gap < gaps->least ? gap : gaps->least;
    gaps->bin = (moves || ends) && gap < gaps->bin ? gap : gaps->bin;
    assert_near(least_of(world), gaps->least, 1e-3);
    if (ends) {
        assert_near(last_bin(curves), gaps->bin, 1e-3);
        gaps->bin = gap;
    }
}

/* Plays one slice. False if the run is over: a hit was reported, as it must be, or contact is open. */
static bool play_slice(scene_t *scene, wh_world_t *world, uint64_t slice, const look_t *before,
                       const look_t *now, gaps_t *gaps, counts_t *counts) {
    wh_event_t events[8];
    wh_event_list_t list = {events, 8, 0};
    const wh_world_input_t input = show(scene, now->bodies, slice);
    const wh_vec3_t one = wh_vec3_subtract(&now->bodies[0].r, &before->bodies[0].r);
    const wh_vec3_t two = wh_vec3_subtract(&now->bodies[1].r, &before->bodies[1].r);
    const wh_real_t way = wh_vec3_norm(&one) + wh_vec3_norm(&two);
    wh_world_step(world, &input, &list);
    const bool told = list.count > 0 && events[0].kind == WH_EVENT_HIT;
    if (way > 0 && (is_deep(now) || (is_deep(before) && way > 2 * WH_GAP_TOUCH))) {
        assert_true(told);
        ++counts->hits;
        return false;
    }
    const bool rests = !(way > 0);
    if (rests || (is_free(before) && is_free(now) && !dips(scene, before, now))) {
        assert_int_equal(list.count, 0);
        compare(world, slice, now, !rests, gaps);
        return true;
    }
    ++counts->open;
    return false;
}

static void play(scene_t *scene, counts_t *counts) {
    static unsigned char memory[1 << 20] __attribute__((aligned(16)));
    wh_real_t way[MOST_SLICES + 1];
    wh_pose_t bodies[2];
    const size_t count = plan(way);
    const uint64_t first = wh_test_below(1000);
    gaps_t gaps = {WH_CLEARANCE_RANGE, WH_CLEARANCE_RANGE, 0};
    assert_in_range(count, 2, MOST_SLICES);
    assert_true(wh_world_bytes(&scene->config) <= sizeof memory);
    place(scene, way[0], bodies);
    look_t before = look_at(scene, bodies);
    const wh_world_input_t input = show(scene, bodies, first);
    wh_world_t *world = wh_world_init(&scene->config, &input, memory, sizeof memory);
    for (size_t i = 1; i < count; ++i) {
        place(scene, way[i], bodies);
        const look_t now = look_at(scene, bodies);
        if (!play_slice(scene, world, first + i, &before, &now, &gaps, counts)) {
            return;
        }
        before = now;
    }
    ++counts->parted;
}

static void what_overlaps_or_kisses_and_then_parts_is_told_in_its_slice(void **state) {
    static scene_t scene;
    counts_t counts = {0, 0, 0};
    (void)state;
    (void)wh_test_seed();
    for (int run = 0; run < RUNS; ++run) {
        if (set_up(&scene)) {
            play(&scene, &counts);
        }
    }
    print_message("%d runs with a hit, %d without, %d open\n", counts.hits, counts.parted, counts.open);
    assert_true(counts.hits > RUNS / 4);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_overlaps_or_kisses_and_then_parts_is_told_in_its_slice),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
