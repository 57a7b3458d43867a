/* Two robots move, stand and move on for thousands of slices; one of them has a wafer. The smallest
 * gaps, of the run and over time, are those of a plain loop over all pairs at each slice's end. */
#include <stdio.h>
#include <stdlib.h>

#include "collision/gap.h"
#include "collision/world.h"
#include "support/pose.h"

enum { ROBOTS = 2, FIXED = 3, UPPER = FIXED, BLADE = UPPER + ROBOTS, PARTS = BLADE + 2 * ROBOTS, WAFERS = 3 };
enum { ITEMS = PARTS + WAFERS, RUNS = 121, SLICES = 1500, LEG = 50 };

static wh_part_t parts[PARTS];
static wh_world_config_t config;
static wh_grasp_config_t grasp;
static wh_cell_t cell;
static wh_wafer_t wafers[WAFERS];
static wh_gripper_t grippers[ROBOTS];

/* The upper bound for a robot's point in a slice, mm. */
#define FASTEST 6

/* A robot's place and its motion in each slice. */
typedef struct {
    double x, y, z, turn_deg;
    double dx, dy, dz, dturn_deg;
    int until; /* the slice that ends the leg */
} walk_t;

typedef struct {
    wh_real_t least[WH_CLEARANCES], now[WH_CLEARANCES], bin[WH_CLEARANCES];
    wh_real_t nearest; /* the nearest of all at the slice's end */
} oracle_t;

static walk_t walks[ROBOTS];
static wh_pose_t links[ROBOTS * WH_ARM_BODIES];

static wh_part_t box_part(wh_part_kind_t kind, int32_t owner, wh_vec3_t size, wh_pose_t at) {
    wh_part_t part = {.kind = kind, .owner = owner};
    part.convex = (wh_convex_t){
        .kind = WH_CONVEX_BOX, .half = wh_vec3_scale(WH_REAL(0.5), &size), .body_from_shape = at};
    return part;
}

static wh_pose_t turned(double x, double y, double z, double turn_deg) {
    wh_pose_t pose = wh_test_at(x, y, z);
    pose.R = wh_mat3_from_rpy_deg(0, 0, turn_deg);
    return pose;
}

static void set_up_scene(void) {
    static const wh_world_arm_t arms[ROBOTS] = {{0, WH_ARM_BASE}, {1, WH_ARM_BASE}};
    static const uint8_t carried_by[ROBOTS] = {0, 1};
    parts[0] = box_part(WH_PART_FIXED, WH_NONE, wh_vec3(600, 20, 300), wh_test_at(0, 420, 0));
    parts[1] = box_part(WH_PART_FIXED, WH_NONE, wh_vec3(40, 40, 300), turned(0, -380, 0, 30));
    parts[1].convex.kind = WH_CONVEX_CYLINDER;
    parts[2] = box_part(WH_PART_FIXED, WH_NONE, wh_vec3(900, 900, 10), wh_test_at(0, 0, -120));
    for (int32_t r = 0; r < ROBOTS; ++r) {
        parts[UPPER + r] = box_part(WH_PART_ARM, r * (int32_t)WH_ARM_BODIES + (int32_t)WH_ARM_UPPER,
                                    wh_vec3(200, 60, 30), wh_test_at(-100, 0, -40));
        for (int32_t side = 0; side < 2; ++side) {
            parts[BLADE + 2 * r + side] =
                box_part(WH_PART_BLADE, r, wh_vec3(160, 25, 3), wh_test_at(0, 120 * side - 60, -1.5));
        }
    }
    grasp = wh_grasp_config_default();
    cell.tolerance = grasp.tolerance;
    config = (wh_world_config_t){.parts = parts,
                                 .part_count = PARTS,
                                 .gripper_count = ROBOTS,
                                 .wafer_count = WAFERS,
                                 .arm_count = ROBOTS,
                                 .arms = arms,
                                 .carried_by = carried_by,
                                 .cell = &cell,
                                 .grasp = &grasp};
    config.wafer = (wh_convex_t){.kind = WH_CONVEX_CYLINDER, .half = {100, 0, WH_REAL(0.3875)}};
    config.wafer.body_from_shape = wh_test_at(0, 0, WH_REAL(0.3875));
    assert_int_equal(wh_world_validate(&config, NULL), WH_OK);
}

/* Robot 0 holds wafer 0; the others lie in the cell. */
static void place_robots(void) {
    for (int r = 0; r < ROBOTS; ++r) {
        const walk_t *walk = &walks[r];
        const wh_pose_t hand = turned(walk->x, walk->y, walk->z, walk->turn_deg);
        const wh_pose_t behind = wh_test_at(-60, 0, 10 - wh_real_abs(walk->z) / 5); /* it sags */
        for (int i = 0; i < WH_ARM_BODIES; ++i) {
            links[r * WH_ARM_BODIES + i] = wh_pose_compose(&hand, &behind);
        }
        grippers[r].base_from_gripper = hand;
        grippers[r].valve = WH_VALVE_CLOSED;
        grippers[r].wafer = r == 0 ? 0 : WH_NONE;
    }
    wafers[0].base_from_wafer = grippers[0].base_from_gripper;
    wafers[0].holder = 0;
}

/* Home is 110 mm to one side. A body that has not moved yet has no gap, so both robots begin with a move. */
static void begin_leg(int r, int slice) {
    walk_t *walk = &walks[r];
    const double home = r == 0 ? -110 : 110;
    const bool stands = slice > 1 && wh_test_uniform(0, 1) < 0.3;
    const double fast = wh_test_uniform(0, 3);
    walk->until = slice + 1 + (int)wh_test_uniform(0, wh_test_uniform(0, 1) < 0.5 ? 6 : LEG);
    walk->dx = walk->dy = walk->dz = walk->dturn_deg = 0;
    if (!stands) {
        walk->dx = fast * wh_test_uniform(-1, 1) - 0.008 * (walk->x - home);
        walk->dy = fast * wh_test_uniform(-1, 1) - 0.006 * walk->y;
        walk->dz = wh_test_uniform(-0.5, 0.5) - 0.008 * (walk->z - (r == 0 ? -14 : 14));
        walk->dturn_deg = wh_test_uniform(-0.3, 0.3);
    }
}

/* On a leg the robot moves evenly, at any speed, or stands. */
static void walk_on(int r, int slice) {
    walk_t *walk = &walks[r];
    if (slice == 1 || slice == walk->until) {
        begin_leg(r, slice);
    }
    walk->x += walk->dx;
    walk->y += walk->dy;
    walk->z += walk->dz;
    walk->turn_deg += walk->dturn_deg;
}

/* ------------------------------------------------------------------------------------------- the plain loop */

static int robot_of(size_t item) {
    if (item < FIXED) {
        return WH_NONE;
    }
    if (item < BLADE) {
        return (int)item - UPPER;
    }
    return item < PARTS ? ((int)item - BLADE) / 2 : wafers[item - PARTS].holder;
}

static wh_part_kind_t kind_of(size_t item) {
    return item < PARTS ? parts[item].kind : WH_PART_WAFER;
}

static wh_pose_t place_of(size_t item) {
    const wh_convex_t *convex = item < PARTS ? &parts[item].convex : &config.wafer;
    if (item < FIXED) {
        return convex->body_from_shape;
    }
    if (item >= PARTS) {
        return wh_pose_compose(&wafers[item - PARTS].base_from_wafer, &convex->body_from_shape);
    }
    const wh_pose_t *body = kind_of(item) == WH_PART_ARM ? &links[parts[item].owner]
                                                         : &grippers[parts[item].owner].base_from_gripper;
    return wh_pose_compose(body, &convex->body_from_shape);
}

/* A wafer that one robot holds is within reach of the other: the two may come together. */
static bool is_reached(const wh_wafer_t *wafer, const wh_gripper_t *gripper) {
    const wh_pose_t seen = wh_pose_relative(&gripper->base_from_gripper, &wafer->base_from_wafer);
    const wh_real_t limit = grasp.tolerance.projxy;
    return wafer->holder != WH_NONE && seen.r.x * seen.r.x + seen.r.y * seen.r.y <= limit * limit &&
           wh_real_abs(seen.r.z) <= grasp.near_projz;
}

/* The gap between a wafer at `w` and a part. */
static wh_clearance_kind_t of_wafer(size_t w, size_t part) {
    const int robot = robot_of(part);
    const wh_wafer_t *wafer = &wafers[w - PARTS];
    if (kind_of(part) == WH_PART_FIXED) {
        return WH_CLEARANCE_WAFER_OTHER;
    }
    if (kind_of(part) == WH_PART_ARM) {
        return wafer->holder == robot ? WH_CLEARANCE_ARM_ITSELF : WH_CLEARANCE_ARM_OTHER;
    }
    if (wafer->holder == robot || is_reached(wafer, &grippers[robot])) {
        return WH_CLEARANCES;
    }
    return place_of(w).r.z > place_of(part).r.z ? WH_CLEARANCE_BLADE_WAFER_ABOVE
                                                : WH_CLEARANCE_BLADE_WAFER_BELOW;
}

/* The gap between two parts; at least one moves. */
static wh_clearance_kind_t of_parts(size_t a, size_t b) {
    const bool has_arm = kind_of(a) == WH_PART_ARM || kind_of(b) == WH_PART_ARM;
    if (robot_of(a) == robot_of(b)) {
        return kind_of(a) == kind_of(b) ? WH_CLEARANCES : WH_CLEARANCE_ARM_ITSELF;
    }
    return has_arm ? WH_CLEARANCE_ARM_OTHER : WH_CLEARANCE_BLADE_OTHER;
}

/* The kind of gap between two items, a before b; WH_CLEARANCES: they do not count. */
static wh_clearance_kind_t clearance_of(size_t a, size_t b) {
    if (robot_of(a) == WH_NONE && robot_of(b) == WH_NONE) {
        return WH_CLEARANCES;
    }
    if (b < PARTS) {
        return of_parts(a, b);
    }
    return a >= PARTS ? WH_CLEARANCE_WAFER_WAFER : of_wafer(b, a);
}

static void lower(wh_real_t *least, wh_real_t found) {
    *least = found < *least ? found : *least;
}

static wh_real_t gap_of(const wh_pose_t places[], size_t a, size_t b) {
    const wh_convex_t *one = a < PARTS ? &parts[a].convex : &config.wafer;
    const wh_convex_t *other = b < PARTS ? &parts[b].convex : &config.wafer;
    wh_gap_t gap;
    wh_gap_measure(one, &places[a], other, &places[b], WH_CLEARANCE_RANGE, wh_vec3(0, 0, 0), &gap);
    return gap.state == WH_GAP_CLEAR ? gap.gap : 0;
}

static void look(oracle_t *oracle) {
    wh_pose_t places[ITEMS];
    oracle->nearest = WH_CLEARANCE_RANGE;
    for (size_t i = 0; i < ITEMS; ++i) {
        places[i] = place_of(i);
        oracle->now[i % WH_CLEARANCES] = WH_CLEARANCE_RANGE;
    }
    for (size_t b = 1; b < ITEMS; ++b) {
        for (size_t a = 0; a < b; ++a) {
            const wh_clearance_kind_t kind = clearance_of(a, b);
            if (kind != WH_CLEARANCES) {
                const wh_real_t found = gap_of(places, a, b);
                lower(&oracle->nearest, found);
                lower(&oracle->now[kind], found);
            }
        }
    }
    for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
        lower(&oracle->least[kind], oracle->now[kind]);
        lower(&oracle->bin[kind], oracle->now[kind]);
    }
}

/* --------------------------------------------------------------------------------------------------- runs */

static void compare(const wh_world_t *world, uint64_t slice, oracle_t *oracle) {
    const wh_curves_t *curves = wh_world_curves(world);
    for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
        assert_near(wh_world_clearances(world)[kind].gap, oracle->least[kind], 1e-3);
        if (slice % curves->slices == 0) {
            assert_near(curves->gaps[kind][curves->count - 1], oracle->bin[kind], 1e-3);
            oracle->bin[kind] = oracle->now[kind];
        }
    }
    assert_int_equal(curves->count, slice / curves->slices);
}

static void begin_run(wh_world_t **world, void *memory, size_t bytes, oracle_t *oracle) {
    set_up_scene();
    for (int r = 0; r < ROBOTS; ++r) {
        walks[r] = (walk_t){.x = r == 0 ? -260 : 260, .y = wh_test_uniform(-60, 60), .z = r == 0 ? -20 : 20};
        walks[r].turn_deg = wh_test_uniform(-20, 20) + 180 * r;
    }
    wafers[1] = (wh_wafer_t){
        wh_test_at(wh_test_uniform(-60, 60), wh_test_uniform(180, 260), wh_test_uniform(-40, 40)), WH_NONE,
        WH_NONE};
    wafers[2] = (wh_wafer_t){
        wh_test_at(wh_test_uniform(-60, 60), wh_test_uniform(-240, -180), wh_test_uniform(-40, 40)), WH_NONE,
        WH_NONE};
    place_robots();
    *oracle = (oracle_t){.nearest = WH_CLEARANCE_RANGE};
    for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
        oracle->least[kind] = oracle->bin[kind] = WH_CLEARANCE_RANGE;
    }
    const wh_world_input_t input = {0, wafers, grippers, links, NULL};
    assert_true(wh_world_bytes(&config) <= bytes);
    *world = wh_world_init(&config, &input, memory, bytes);
}

/* Returns the slices until the first contact, at which the run ends. */
static int play_run(void) {
    static unsigned char memory[1 << 20] __attribute__((aligned(16)));
    wh_world_t *world;
    oracle_t oracle;
    begin_run(&world, memory, sizeof memory, &oracle);
    for (int slice = 1; slice <= SLICES; ++slice) {
        wh_event_t events[8];
        wh_event_list_t list = {events, 8, 0};
        for (int r = 0; r < ROBOTS; ++r) {
            walk_on(r, slice);
        }
        place_robots();
        look(&oracle);
        if (oracle.nearest < WH_REAL(0.02)) {
            return slice;
        }
        const wh_world_input_t input = {(uint64_t)slice, wafers, grippers, links, NULL};
        wh_world_step(world, &input, &list);
        if (list.count > 0) {
            assert_true(oracle.nearest < FASTEST); /* between two slices */
            return slice;
        }
        compare(world, (uint64_t)slice, &oracle);
    }
    return SLICES;
}

static void gaps_are_those_of_a_plain_loop(void **state) {
    (void)state;
    int slices = 0;
    wh_rounds_t rounds = WH_ROUNDS(4, RUNS, 1);
    while (wh_round(&rounds)) {
        slices += play_run();
    }
    print_message("%d slices\n", slices);
    assert_true(slices > rounds.made * 100);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gaps_are_those_of_a_plain_loop),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
