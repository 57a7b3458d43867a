/* The world's results for random motions, compared with a plain loop over all pairs at 400 instants
 * of each slice. */
#include <stdio.h>
#include <stdlib.h>

#include "collision/gap.h"
#include "collision/world.h"
#include "math/trig.h"
#include "support/pose.h"

enum { WAFERS = 6, FIXED = 4, ARM = FIXED + 3, PARTS };
enum { RUNS = 75, SLICES = 40, INSTANTS = 200 };

static wh_part_t parts[PARTS];
static wh_world_config_t config;
static wh_cell_t cell;
static wh_grasp_t table;
static wh_wafer_t wafers[WAFERS];
static wh_gripper_t grippers[1];

/* The places of the blade and the robot's links. */
typedef struct {
    wh_pose_t hand, links[WH_ARM_BODIES];
} stance_t;

/* The results of the plain loop. */
typedef struct {
    wh_real_t least[WH_CLEARANCES]; /* at the slices' ends */
    wh_real_t now[WH_CLEARANCES];   /* at this slice's end */
    wh_real_t bin[WH_CLEARANCES];   /* at the ends of the slices of this bin of the curves */
    wh_real_t deepest;              /* the smallest gap at any instant; -1: a hit */
    bool undecided;
} oracle_t;

static wh_pose_t turned(double x, double y, double z, double tilt, double turn) {
    wh_pose_t pose = wh_test_at(x, y, z);
    pose.R = wh_mat3_from_rpy_deg(wh_test_uniform(-tilt, tilt), wh_test_uniform(-tilt, tilt), turn);
    return pose;
}

static wh_convex_t box_of(double x, double y, double z) {
    const wh_convex_t box = {
        .kind = WH_CONVEX_BOX, .half = {x / 2, y / 2, z / 2}, .body_from_shape = wh_pose_identity()};
    return box;
}

/* Walls and balls about a stack of wafers, and a blade of two boxes and a capsule. */
static void set_up_scene(void) {
    for (int i = 0; i < FIXED; ++i) {
        parts[i] = (wh_part_t){.kind = WH_PART_FIXED, .owner = WH_NONE, .convex = box_of(5, 100, 100)};
        parts[i].convex.body_from_shape =
            turned(wh_test_uniform(-400, 400), wh_test_uniform(-400, 400), wh_test_uniform(-60, 60), 180, 0);
    }
    parts[0].convex.kind = WH_CONVEX_CAPSULE;
    parts[0].convex.half = wh_vec3(20, 0, 30);
    for (int i = FIXED; i < ARM; ++i) {
        parts[i] = (wh_part_t){.kind = WH_PART_BLADE, .owner = 0, .convex = box_of(160, 20, 3)};
        parts[i].convex.body_from_shape.r = wh_vec3(0, 40.0 * (i - FIXED), -1.5);
    }
    parts[ARM] = (wh_part_t){.kind = WH_PART_ARM, .owner = WH_ARM_FOREARM, .convex = box_of(120, 30, 20)};
    parts[ARM].convex.body_from_shape.r = wh_vec3(60, 0, -40);
    for (int w = 0; w < WAFERS; ++w) {
        wafers[w].base_from_wafer = turned(wh_test_uniform(-5, 5), wh_test_uniform(-5, 5), 10.0 * w, 0.3, 0);
    }
    const wh_grasp_config_t grasp = wh_grasp_config_default();
    const wh_grasp_storage_t storage = {wafers, WAFERS, grippers, 1, NULL, 0};
    assert_int_equal(wh_grasp_init(&table, &grasp, &storage), WH_OK);
    cell.tolerance = grasp.tolerance;
    config =
        (wh_world_config_t){.parts = parts, .part_count = PARTS, .gripper_count = 1, .wafer_count = WAFERS};
    config.cell = &cell;
    config.grasp = &table.config;
    config.wafer = (wh_convex_t){.kind = WH_CONVEX_CYLINDER, .half = {150, 0, 0.3875}};
    config.wafer.body_from_shape = wh_test_at(0, 0, 0.3875);
    assert_int_equal(wh_world_validate(&config, NULL), WH_OK);
}

/* A pose between two, as the world's header defines it: a straight way of the origin, a turn at a
 * constant rate. */
static wh_pose_t between(const wh_pose_t *a, const wh_pose_t *b, double t) {
    wh_pose_t pose = *b;
    for (int i = 0; i < 9; ++i) {
        pose.R.m[i / 3][i % 3] = (1 - t) * a->R.m[i / 3][i % 3] + t * b->R.m[i / 3][i % 3];
    }
    for (int i = 0; i < 3; ++i) {
        wh_mat3_orthonormalise(&pose.R);
    }
    pose.r =
        wh_vec3((1 - t) * a->r.x + t * b->r.x, (1 - t) * a->r.y + t * b->r.y, (1 - t) * a->r.z + t * b->r.z);
    return pose;
}

static stance_t stance_between(const stance_t *a, const stance_t *b, double t) {
    stance_t stance = {.hand = between(&a->hand, &b->hand, t)};
    for (int i = 0; i < WH_ARM_BODIES; ++i) {
        stance.links[i] = between(&a->links[i], &b->links[i], t);
    }
    return stance;
}

static const wh_convex_t *other_of(int i, wh_pose_t *base_from_shape) {
    if (i < FIXED) {
        *base_from_shape = parts[i].convex.body_from_shape;
        return &parts[i].convex;
    }
    *base_from_shape = wh_pose_compose(&wafers[i - FIXED].base_from_wafer, &config.wafer.body_from_shape);
    return &config.wafer;
}

static wh_clearance_kind_t kind_of(int other, const wh_pose_t *blade, const wh_pose_t *shape) {
    if (other < FIXED) {
        return WH_CLEARANCE_BLADE_OTHER;
    }
    return shape->r.z > blade->r.z ? WH_CLEARANCE_BLADE_WAFER_ABOVE : WH_CLEARANCE_BLADE_WAFER_BELOW;
}

static void lower(double *least, double found) {
    if (found < *least) {
        *least = found < 0 ? 0 : found;
    }
}

/* Part p of blade or forearm compared with another body. */
static void look_at_pair(const stance_t *stance, int p, int other, bool end, oracle_t *oracle) {
    const bool is_arm = parts[p].kind == WH_PART_ARM;
    const wh_pose_t *body = is_arm ? &stance->links[parts[p].owner] : &stance->hand;
    const wh_pose_t blade = wh_pose_compose(body, &parts[p].convex.body_from_shape);
    wh_pose_t shape;
    wh_gap_t gap;
    const wh_convex_t *convex = other_of(other, &shape);
    wh_gap_measure(&parts[p].convex, &blade, convex, &shape, 20, wh_vec3(0, 0, 0), &gap);
    const wh_real_t found = gap.state == WH_GAP_HIT ? -1 : gap.gap;
    const wh_clearance_kind_t kind = is_arm ? WH_CLEARANCE_ARM_OTHER : kind_of(other, &blade, &shape);
    oracle->undecided = oracle->undecided || gap.state == WH_GAP_UNDECIDED;
    oracle->deepest = found < oracle->deepest ? found : oracle->deepest;
    if (end) {
        lower(&oracle->least[kind], found);
        lower(&oracle->now[kind], found);
    }
}

static void look_at_instant(const stance_t *stance, bool end, oracle_t *oracle) {
    for (int p = FIXED; p < PARTS; ++p) {
        for (int other = 0; other < FIXED + WAFERS; ++other) {
            look_at_pair(stance, p, other, end, oracle);
        }
    }
}

/* One slice of both. Returns whether the world reported contact. */
static bool play_slice(wh_world_t *world, const stance_t *from, const stance_t *to, oracle_t *oracle) {
    wh_event_t events[8];
    wh_event_list_t steps = {events, 8, 0};
    wh_event_list_t list = {events, 8, 0};
    const wh_gripper_input_t input = {to->hand, WH_VALVE_CLOSED};
    assert_int_equal(wh_grasp_step(&table, &input, &steps), WH_OK);
    for (int kind = 0; kind < WH_CLEARANCES; ++kind) {
        oracle->now[kind] = WH_CLEARANCE_RANGE;
    }
    for (int i = 1; i <= INSTANTS; ++i) {
        const stance_t at = stance_between(from, to, (double)i / (double)INSTANTS);
        look_at_instant(i == INSTANTS ? to : &at, i == INSTANTS, oracle);
    }
    const wh_world_input_t seen = {table.slice, wafers, grippers, to->links, NULL};
    wh_world_step(world, &seen, &list);
    bool hits = false;
    for (size_t i = 0; i < list.count; ++i) {
        hits = hits || events[i].kind == WH_EVENT_HIT;
        oracle->undecided = oracle->undecided || events[i].kind == WH_EVENT_UNDECIDED;
        assert_true(events[i].kind == WH_EVENT_HIT || events[i].kind == WH_EVENT_UNDECIDED);
    }
    return hits;
}

/* The size of a run's motions: the largest step, and its share of vertical motion and of tilting. */
typedef struct {
    double reach, lift, tilt;
} manner_t;

static wh_pose_t next_pose(const wh_pose_t *pose, const manner_t *manner) {
    wh_pose_t next = *pose;
    const wh_mat3_t turn = wh_mat3_from_rpy_deg(
        wh_test_uniform(-1, 1) * manner->tilt, wh_test_uniform(-1, 1) * manner->tilt, wh_test_uniform(-6, 6));
    next.R = wh_mat3_multiply(&pose->R, &turn);
    wh_mat3_orthonormalise(&next.R);
    next.r.x += wh_test_uniform(-1, 1) * manner->reach - 0.05 * pose->r.x;
    next.r.y += wh_test_uniform(-1, 1) * manner->reach - 0.05 * pose->r.y;
    next.r.z += wh_test_uniform(-1, 1) * manner->reach * manner->lift;
    return next;
}

/* A robot whose column leans, on a rail; its kind is TRZY or SCARA. Its blade reaches the wafers
 * when its axes are at 0, except R and a SCARA's elbow. */
static wh_carrier_t carrier_of(bool is_scara) {
    wh_chain_t chain = {
        .kind = is_scara ? WH_CHAIN_SCARA : WH_CHAIN_TRZY, .has_rail = true, .has_tilt = true};
    wh_carrier_t carrier;
    for (int axis = 0; axis < WH_CHAIN_AXES; ++axis) {
        const double far = axis == WH_CHAIN_RAIL || axis == WH_CHAIN_Z || axis == WH_CHAIN_REACH ? 1000 : 3;
        chain.travel[axis] = (wh_travel_t){-far, far};
        chain.limits[axis] = (wh_limits_t){1, 10, 100};
    }
    chain.travel[WH_CHAIN_TILT_X] = chain.travel[WH_CHAIN_TILT_Y] = (wh_travel_t){-1, 1};
    chain.travel[WH_CHAIN_REACH] = is_scara ? (wh_travel_t){-3, 3} : (wh_travel_t){0, 1000};
    chain.links[0] = chain.links[1] = 300;
    chain.is_placed = true;
    chain.base_from_robot = wh_test_at(is_scara ? -700 : -500, 30, 0);
    assert_int_equal(wh_carrier_init(&carrier, &chain), WH_OK);
    return carrier;
}

static stance_t stance_at(const wh_carrier_t *carrier, const wh_real_t axes[]) {
    static const wh_arm_t arm = {.reach = 100, .link = 300};
    stance_t stance;
    carrier->forward(carrier, axes, &stance.hand);
    wh_arm_place_carrier(&arm, carrier, axes, NULL, stance.links);
    return stance;
}

/* Each axis moves by itself. */
static void step_axes(const wh_carrier_t *carrier, const manner_t *manner, wh_real_t axes[]) {
    const wh_real_t rad = manner->reach / 500;
    for (size_t i = 0; i < carrier->axis_count; ++i) {
        const uint8_t axis = carrier->axes[i];
        const bool is_elbow = axis == WH_CHAIN_REACH && carrier->chain.kind == WH_CHAIN_SCARA;
        const bool leans = axis == WH_CHAIN_TILT_X || axis == WH_CHAIN_TILT_Y;
        const bool shifts = axis == WH_CHAIN_RAIL || (axis == WH_CHAIN_REACH && !is_elbow);
        const double most = leans                ? wh_rad_from_deg(manner->tilt)
                            : axis == WH_CHAIN_Z ? manner->reach * manner->lift
                            : shifts             ? manner->reach / 2
                                                 : rad;
        axes[i] += wh_test_uniform(-1, 1) * most;
    }
}

/* The robot's next stance; without a robot, the next pose of a blade that moves freely while the
 * links stand. */
static stance_t next_stance(const stance_t *stance, const wh_carrier_t *carrier, const manner_t *manner,
                            wh_real_t axes[]) {
    stance_t next = *stance;
    if (carrier) {
        step_axes(carrier, manner, axes);
        return stance_at(carrier, axes);
    }
    next.hand = next_pose(&stance->hand, manner);
    return next;
}

static void compare_clearances(const wh_world_t *world, const oracle_t *oracle) {
    for (int kind = 0; kind < WH_CLEARANCES; ++kind) {
        assert_near(wh_world_clearances(world)[kind].gap, oracle->least[kind], 1e-3);
    }
}

static wh_real_t nearest_of(const wh_world_t *world) {
    wh_real_t nearest = WH_CLEARANCE_RANGE;
    for (int kind = 0; kind < WH_CLEARANCES; ++kind) {
        lower(&nearest, wh_world_clearances(world)[kind].gap);
    }
    return nearest;
}

/* Each bin of the curves holds the smallest gap at its begin and at the end of any of its slices. */
static void compare_curves(const wh_world_t *world, oracle_t *oracle) {
    const wh_curves_t *curves = wh_world_curves(world);
    for (int kind = 0; kind < WH_CLEARANCES; ++kind) {
        oracle->bin[kind] = oracle->now[kind] < oracle->bin[kind] ? oracle->now[kind] : oracle->bin[kind];
        if (table.slice % curves->slices != 0) {
            continue;
        }
        assert_near(curves->gaps[kind][curves->count - 1], oracle->bin[kind], 1e-3);
        oracle->bin[kind] = oracle->now[kind];
    }
    assert_int_equal(curves->count, table.slice / curves->slices);
}

/* The start of a run. */
static stance_t first_stance(int run, const wh_carrier_t *robot, const wh_real_t axes[]) {
    const double out = run % 3 == 2 ? 0 : 1;
    stance_t stance = stance_at(robot, axes);
    for (int i = 0; run % 2 == 0 && i < WH_ARM_BODIES; ++i) {
        stance.hand = turned(out * wh_test_uniform(-350, -200), out * wh_test_uniform(-300, 300),
                             10.0 * (run % 5) + (run % 3 == 2 ? 6.9 : wh_test_uniform(4, 8)), 0,
                             wh_test_uniform(0, 360));
        stance.links[i] = wh_test_at(0, 0, 5000);
    }
    return stance;
}

/* Counts: none in both; contact in both; one of them could not decide. */
static void play_run(int run, int counts[3]) {
    static unsigned char memory[1 << 20] __attribute__((aligned(16)));
    oracle_t oracle = {.deepest = 1e9};
    set_up_scene();
    for (int kind = 0; kind < WH_CLEARANCES; ++kind) {
        oracle.least[kind] = oracle.bin[kind] = WH_CLEARANCE_RANGE;
    }
    static const manner_t manners[] = {{60, 0.1, 1}, {8, 0.1, 1}, {8, 0.001, 0.005}};
    const manner_t *manner = &manners[run % 3];
    const wh_carrier_t robot = carrier_of(run % 4 == 3);
    const wh_carrier_t *carrier = run % 2 == 1 ? &robot : NULL;
    wh_real_t axes[WH_CARRIER_AXES] = {wh_test_uniform(-1, 1),
                                       run % 4 == 3 ? wh_test_uniform(-2, 2) : wh_test_uniform(200, 500),
                                       wh_test_uniform(4, 45)};
    stance_t stance = first_stance(run, &robot, axes);
    assert_true(wh_world_bytes(&config) <= sizeof memory);
    grippers[0].base_from_gripper = stance.hand;
    const wh_world_input_t seen = {table.slice, wafers, grippers, stance.links, NULL};
    wh_world_t *world = wh_world_init(&config, &seen, memory, sizeof memory);
    look_at_instant(&stance, false, &oracle);
    if (oracle.deepest < 1e-2) {
        return; /* it begins in contact, which wh_world_check_rest checks */
    }
    for (int slice = 0; slice < SLICES; ++slice) {
        const stance_t to = next_stance(&stance, carrier, manner, axes);
        const bool struck = play_slice(world, &stance, &to, &oracle);
        if (oracle.undecided) {
            ++counts[2];
            return;
        }
        if (struck || oracle.deepest < 0) {
            /* If bodies only graze between two instants, only the world can find it. */
            assert_true(struck);
            assert_true(oracle.deepest < 0.6);
            assert_near(nearest_of(world), 0, 0);
            ++counts[1];
            return;
        }
        compare_clearances(world, &oracle);
        compare_curves(world, &oracle);
        stance = to;
    }
    ++counts[0];
}

static void contact_and_clearance_are_those_of_a_plain_loop(void **state) {
    (void)state;
    int counts[3] = {0, 0, 0};
    wh_rounds_t rounds = WH_ROUNDS(12, RUNS, 1);
    while (wh_round(&rounds)) {
        play_run(rounds.number, counts);
    }
    print_message("%d runs without contact, %d with, %d undecided\n", counts[0], counts[1], counts[2]);
    assert_true(counts[2] <= 1 + rounds.made / 50);
    assert_true(counts[0] > rounds.made / 20 && counts[1] > 0 && counts[1] + 3 > rounds.made / 5);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(contact_and_clearance_are_those_of_a_plain_loop),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
