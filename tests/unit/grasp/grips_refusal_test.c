/* Grips beside their table: what they refuse, which step is whose, and which face an event is of. */
#include "support/support.h"

#include "grasp/grips.h"
#include "grasp/restore.h"

/* One wafer, two grippers, and all that grips need. */
typedef struct {
    wh_wafer_t wafers[1], seen[1];
    wh_gripper_t grippers[2];
    wh_grip_t kinds[2];
    wh_grip_state_t states[2];
    wh_edge_wafer_t shapes[1];
    double speeds[2];
    wh_gripper_input_t inputs[2];
    wh_event_t events[8];
    wh_event_list_t list;
    wh_grasp_t table;
    wh_grips_t grips;
    wh_grips_parts_t parts;
} bench_t;

static bench_t bench;

static wh_grasp_storage_t storage(void) {
    return (wh_grasp_storage_t){bench.wafers, 1, bench.grippers, 2, NULL, 0};
}

static void begin_table(void) {
    const wh_grasp_config_t config = wh_grasp_config_default();
    const wh_grasp_storage_t of = storage();
    assert_int_equal(wh_grasp_init(&bench.table, &config, &of), WH_OK);
}

static void begin(wh_grip_kind_t kind) {
    memset(&bench, 0, sizeof bench);
    bench.wafers[0].base_from_wafer = wh_pose_identity();
    bench.shapes[0] = wh_edge_wafer_nominal(150);
    for (size_t g = 0; g < 2; ++g) {
        bench.kinds[g] = (wh_grip_t){kind, wh_edge_default(150)};
        bench.speeds[g] = 40;
        bench.inputs[g] = (wh_gripper_input_t){wh_pose_identity(), WH_VALVE_OPEN};
    }
    bench.list = (wh_event_list_t){bench.events, 8, 0};
    begin_table();
    bench.parts = (wh_grips_parts_t){WH_REAL(0.775), 0.001,      bench.kinds, bench.shapes, NULL, 0,
                                     bench.states,   bench.seen, bench.speeds};
    assert_int_equal(wh_grips_init(&bench.grips, &bench.parts, &bench.table), WH_OK);
}

static wh_status_t step(void) {
    return wh_grips_step(&bench.grips, bench.inputs, &bench.list);
}

static const wh_event_t *find_event(wh_event_kind_t kind) {
    for (size_t i = 0; i < bench.list.count; ++i) {
        if (bench.events[i].kind == kind) {
            return &bench.events[i];
        }
    }
    return NULL;
}

/* A contest that begins with the back, and a gripper that turns over on its way off. The bytes of a hash tell
 * the two apart, and so does a table that takes the run up. */
static void a_contest_has_the_face_of_its_beginning(void **state) {
    (void)state;
    begin(WH_GRIP_VACUUM);
    assert_int_equal(step(), WH_OK);
    assert_int_equal(bench.grippers[1].contest.wafer, 0);
    bench.inputs[1].base_from_gripper.R = (wh_mat3_t){{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};
    bench.inputs[1].base_from_gripper.r.z = 300;
    assert_int_equal(step(), WH_OK);
    const wh_event_t *event = find_event(WH_EVENT_CONTESTED);
    assert_non_null(event);
    assert_int_equal(event->measured_slice, 1);
    assert_int_equal(event->face, WH_FACE_BACK);

    begin(WH_GRIP_VACUUM);
    bench.inputs[1].base_from_gripper.R = (wh_mat3_t){{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};
    bench.inputs[1].base_from_gripper.r.z = WH_REAL(0.775);
    assert_int_equal(step(), WH_OK);
    assert_int_equal(bench.grippers[1].contest.face, WH_FACE_FRONT);
    const uint64_t hash = wh_grips_hash(&bench.grips);
    wh_gripper_t kept[2];
    memcpy(kept, bench.grippers, sizeof kept);
    bench.grippers[1].contest.face = WH_FACE_BACK;
    assert_true(wh_grips_hash(&bench.grips) != hash);
    assert_int_equal(wh_grasp_restore(&bench.table, 1, bench.wafers, kept), WH_OK);
    assert_true(wh_grips_hash(&bench.grips) == hash);
    bench.inputs[1] = (wh_gripper_input_t){wh_pose_identity(), WH_VALVE_OPEN};
    bench.inputs[1].base_from_gripper.r.z = 300;
    assert_int_equal(step(), WH_OK);
    event = find_event(WH_EVENT_CONTESTED);
    assert_non_null(event);
    assert_int_equal(event->face, WH_FACE_FRONT);
    kept[1].contest.face = (wh_face_t)2;
    assert_int_equal(wh_grasp_restore(&bench.table, 1, bench.wafers, kept), WH_STATUS_OUT_OF_RANGE);
}

/* Likewise a near miss, whose closest approach came while the gripper looked at the front. */
static void a_near_miss_has_the_face_of_its_closest_approach(void **state) {
    (void)state;
    begin(WH_GRIP_VACUUM);
    bench.inputs[0].valve = WH_VALVE_CLOSED;
    bench.inputs[1].base_from_gripper.R = (wh_mat3_t){{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};
    bench.inputs[1].base_from_gripper.r.z = WH_REAL(2.775);
    assert_int_equal(step(), WH_OK);
    assert_int_equal(bench.grippers[1].approach.face, WH_FACE_FRONT);
    bench.inputs[1].base_from_gripper = wh_pose_identity();
    bench.inputs[1].base_from_gripper.r.z = -50;
    assert_int_equal(step(), WH_OK);
    const wh_event_t *event = find_event(WH_EVENT_NEAR_MISS);
    assert_non_null(event);
    assert_int_equal(event->measured_slice, 1);
    assert_int_equal(event->face, WH_FACE_FRONT);
    assert_near(event->measured.dr_proj_z, 2, 1e-5);
}

/* A step that is refused changes nothing, and names the gripper. */
static void speeds_are_looked_at(void **state) {
    (void)state;
    static const struct {
        double speed;
        wh_status_t status;
    } bad[] = {{-5000, WH_STATUS_OUT_OF_RANGE},
               {-1e-300, WH_STATUS_OUT_OF_RANGE},
               {(double)NAN, WH_STATUS_NOT_FINITE},
               {(double)INFINITY, WH_STATUS_NOT_FINITE},
               {-(double)INFINITY, WH_STATUS_NOT_FINITE}};
    begin(WH_GRIP_EDGE);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        const uint64_t hash = wh_grips_hash(&bench.grips);
        bench.speeds[1] = bad[i].speed;
        assert_int_equal(step(), bad[i].status);
        assert_true(wh_grips_hash(&bench.grips) == hash);
        assert_int_equal(bench.list.count, 1);
        assert_int_equal(bench.events[0].kind, WH_EVENT_BAD_INPUT);
        assert_int_equal(bench.events[0].gripper, 1);
        assert_int_equal(bench.events[0].status, bad[i].status);
    }
    bench.speeds[1] = 0;
    assert_int_equal(step(), WH_OK);
    assert_int_equal(wh_grips_complete(&bench.parts, bench.grippers, 2, 1, bench.states), WH_OK);
}

/* A table with grips has one step alone; one that was set up again has none of theirs any more. */
static void a_table_and_its_grips_belong_together(void **state) {
    (void)state;
    begin(WH_GRIP_EDGE);
    const uint64_t hash = wh_grips_hash(&bench.grips);
    assert_int_equal(wh_grasp_step(&bench.table, bench.inputs, &bench.list), WH_STATUS_HAS_GRIPS);
    assert_true(wh_grips_hash(&bench.grips) == hash);
    assert_int_equal(bench.list.count, 0);
    assert_int_equal(bench.table.counters.refused, 1);
    assert_int_equal(step(), WH_OK);
    begin_table();
    assert_int_equal(step(), WH_STATUS_NOT_INITIALISED);
    assert_int_equal(wh_grasp_step(&bench.table, bench.inputs, &bench.list), WH_OK);
    begin_table();
    wh_grips_t others = bench.grips;
    assert_int_equal(wh_grips_init(&bench.grips, &bench.parts, &bench.table), WH_OK);
    assert_int_equal(wh_grips_init(&others, &bench.parts, &bench.table), WH_OK);
    assert_int_equal(step(), WH_STATUS_NOT_INITIALISED);
    assert_int_equal(wh_grips_step(&others, bench.inputs, NULL), WH_OK);
}

static wh_status_t init_with(wh_grips_parts_t parts) {
    return wh_grips_init(&bench.grips, &parts, &bench.table);
}

static void arrays_that_overlap_are_refused(void **state) {
    (void)state;
    begin(WH_GRIP_EDGE);
    wh_grips_parts_t parts = bench.parts;
    parts.seen = bench.wafers;
    assert_int_equal(init_with(parts), WH_STATUS_OVERLAP);
    parts = bench.parts;
    parts.states = (wh_grip_state_t *)(void *)bench.grippers;
    assert_int_equal(init_with(parts), WH_STATUS_OVERLAP);
    parts = bench.parts;
    parts.speeds = &bench.states[1].s;
    assert_int_equal(init_with(parts), WH_STATUS_OVERLAP);
    assert_int_equal(init_with(bench.parts), WH_OK);
    /* And of the table: a byte is enough. */
    const wh_grasp_config_t config = wh_grasp_config_default();
    wh_grasp_storage_t of = storage();
    of.grippers = (wh_gripper_t *)(void *)((char *)(bench.wafers + 1) - 8);
    const wh_grasp_t before = bench.table;
    assert_int_equal(wh_grasp_init(&bench.table, &config, &of), WH_STATUS_OVERLAP);
    of = storage();
    of.wafers = (wh_wafer_t *)(void *)&bench.table;
    of.wafers->base_from_wafer = wh_pose_identity();
    assert_int_equal(wh_grasp_init(&bench.table, &config, &of), WH_STATUS_OVERLAP);
    bench.table = before;
    of = storage();
    assert_int_equal(wh_grasp_init(&bench.table, &config, &of), WH_OK);
}

/* The rounded bottom meets the circle: no outline of two flanks is left. */
static void a_notch_without_a_flank_is_refused(void **state) {
    (void)state;
    const wh_edge_t edge = {75.0, 17.91, 16.88, 1.0463, 5.49, -6.74, -3.95, 2.19, 5.61, 40};
    wh_edge_wafer_t wafer = {
        75.0, -0.415, 1.96, 0.2889, 1.5408, 15.9, -0.9999993060705563, 0.001178074023963068};
    assert_int_equal(wh_edge_wafer_validate(&edge, &wafer), WH_STATUS_OUT_OF_RANGE);
    wafer.bottom = 0.5;
    assert_int_equal(wh_edge_wafer_validate(&edge, &wafer), WH_OK);
    begin(WH_GRIP_EDGE);
    bench.kinds[0].edge = edge;
    wafer.bottom = 15.9;
    bench.shapes[0] = wafer;
    bench.kinds[1].kind = WH_GRIP_VACUUM;
    assert_int_equal(init_with(bench.parts), WH_STATUS_OUT_OF_RANGE);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_contest_has_the_face_of_its_beginning),
        cmocka_unit_test(a_near_miss_has_the_face_of_its_closest_approach),
        cmocka_unit_test(speeds_are_looked_at),
        cmocka_unit_test(a_table_and_its_grips_belong_together),
        cmocka_unit_test(arrays_that_overlap_are_refused),
        cmocka_unit_test(a_notch_without_a_flank_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
