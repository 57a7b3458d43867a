/* A hundred thousand GETs and PUTs of one wafer that lies beside its slot's centre: how far does it creep? */
#include "support/grasp.h"

/* The paper's Wafer 2. */
static const double offset_x = 13.794;
static const double offset_y = 7.2385;

#if defined(WH_FLOAT)
enum { CYCLES = 20000 };
/* Measured: 0.003 mm, at radii of up to 900 mm. */
#define BOUND 0.05
#else
enum { CYCLES = 100000 };
#define BOUND 1e-9
#endif

enum { SLOTS = 25 };

typedef struct {
    double heading, x, y, z;
} station_t;

static wh_pose_t slot_pose(const station_t *s, uint32_t slot, double above) {
    return wh_test_pose(wh_test_rotation(0, 0, 1, s->heading), s->x, s->y, s->z + 10 * slot + above);
}

static void go(cell_t *cell, const station_t *s, uint32_t slot, double above, int valve) {
    cell->input[0].base_from_gripper = slot_pose(s, slot, above);
    cell->input[0].valve = valve;
    cell_step(cell);
}

/* The key poses of a GET: below, on contact within eps_projz, above. */
static void get(cell_t *cell, const station_t *s, uint32_t slot) {
    go(cell, s, slot, -3, OPEN);
    go(cell, s, slot, -0.25, OPEN);
    cell_expect_held(cell, 0, 0);
    go(cell, s, slot, 3, OPEN);
}

/* And of a PUT: let go where it was taken, so that the height repeats as well. */
static void put(cell_t *cell, const station_t *s, uint32_t slot) {
    go(cell, s, slot, 3, OPEN);
    go(cell, s, slot, -0.25, CLOSED);
    cell_expect_held(cell, 0, WH_NONE);
    go(cell, s, slot, -3, CLOSED);
}

/* Another one each time: a few that recur would catch the wafer on the few numbers that they round to. */
static station_t draw_station(void) {
    const double around = wh_test_uniform(0, 2 * WH_TEST_PI);
    const double radius = wh_test_uniform(500, 900);
    const double heading = wh_test_uniform(0, 2 * WH_TEST_PI);
    const station_t s = {heading, radius * cos(around), radius * sin(around), wh_test_uniform(600, 1000)};
    return s;
}

static void offsets_survive(void **state) {
    (void)state;
    cell_t cell;
    (void)wh_test_seed();
    station_t drawn = draw_station();
    const station_t *s = &drawn;
    uint32_t slot = 0;
    const wh_pose_t slot_from_wafer = wh_test_pose(wh_test_rotation(0, 0, 1, 0.4), offset_x, offset_y, 0);
    const wh_pose_t home = slot_pose(s, slot, 0);
    const wh_pose_t start = wh_pose_compose(&home, &slot_from_wafer);
    double worst = 0;
    double worst_R = 0;
    cell_begin_default(&cell);
    assert_int_equal(wh_grasp_place(&cell.table, 0, &start), WH_OK);
    for (int cycle = 0; cycle < CYCLES; ++cycle) {
        get(&cell, s, slot);
        drawn = draw_station();
        slot = wh_test_below(SLOTS);
        put(&cell, s, slot);
        const wh_pose_t here = slot_pose(s, slot, 0);
        const wh_pose_t now = wh_pose_relative(&here, &cell.wafer[0].base_from_wafer);
        worst = fmax(worst, wh_test_difference_r(&now, &slot_from_wafer));
        worst_R = fmax(worst_R, wh_test_difference_R(&now, &slot_from_wafer));
    }
    printf("%d cycles: the offset moved by at most %.3g mm, the rotation by %.3g\n", CYCLES, worst, worst_R);
    assert_near(worst, 0, BOUND);
    assert_near(worst_R, 0, BOUND / 100);
    assert_int_equal(cell.table.counters.picked, CYCLES);
    assert_int_equal(cell.table.counters.near_misses, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(offsets_survive)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
