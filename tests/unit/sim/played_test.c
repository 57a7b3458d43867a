/* A played run: its rows move the axes as a track does, several motions at once; a run that is not as
 * described is refused, and each number of it matters. */
#include "support/pose.h"

#include "sim/played.h"

enum { WAFERS = 2, GRIPPERS = 2, MOTIONS = 2, ROWS = 40, ROBOT = 0xf };

static wh_wafer_t wafers[WAFERS];
static wh_gripper_t grippers[GRIPPERS];
static wh_played_motion_t motions[MOTIONS];
static wh_slow_t slow;
static wh_station_t station;
static wh_machine_t machine;
static wh_player_t player;
static wh_played_row_t rows[ROWS];
static wh_played_fault_t brought[6];
static wh_pose_t starts[WAFERS];

static wh_played_room_t room_here(void) {
    const wh_played_room_t room = {wafers, WAFERS, grippers, GRIPPERS, motions, MOTIONS, NULL, &slow};
    return room;
}

/* A robot, and a chuck on axis 4. */
static void fill_machine(void) {
    memset(&machine, 0, sizeof machine);
    wh_robot_default(&machine.robot);
    machine.chuck_limits = machine.robot.limits[3];
    machine.axis_count = 5;
    machine.gripper_count = GRIPPERS;
    for (int g = 0; g < GRIPPERS; ++g) {
        machine.mounts[g].axis = g == 0 ? WH_NONE : 4;
        machine.mounts[g].base_from_station = wh_test_at(-600, 0, 950);
        machine.mounts[g].effector_from_gripper = wh_pose_identity();
    }
}

static wh_played_t run_of(size_t row_count, int64_t slices) {
    const wh_cell_t cell = {.stations = &station, .count = 1, .tolerance = wh_tolerance_paper()};
    const wh_played_t run = {.machine = &machine,
                             .rows = rows,
                             .row_count = row_count,
                             .motion_count = MOTIONS,
                             .wafers = starts,
                             .wafer_count = WAFERS,
                             .slice_us = 1000,
                             .config = wh_grasp_config_default(),
                             .physics = wh_physics_default(),
                             .cell = cell,
                             .parts = {.take_ways = wh_track_take_ways,
                                       .take_vias = wh_track_take_vias,
                                       .begin_slowly = wh_track_begin_slowly},
                             .slices = slices};
    return run;
}

static int set_up(void **state) {
    (void)state;
    memset(rows, 0, sizeof rows);
    memset(brought, 0, sizeof brought);
    fill_machine();
    station = (wh_station_t){.base_from_station = wh_test_at(700, 0, 900), .slots = 1, .pitch = 10};
    station.chuck = WH_NONE;
    starts[0] = wh_test_at(700, 0, 900);
    starts[1] = wh_test_at(-700, 0, 900);
    return 0;
}

static wh_played_row_t row_of(int64_t after, int64_t slices, wh_played_kind_t kind, uint32_t bits) {
    const wh_played_row_t row = {
        .after = after, .slices = slices, .kind = kind, .gripper = WH_NONE, .bits = bits};
    return row;
}

/* Plays all, and returns how the player stopped. */
static wh_status_t play(const wh_played_t *run) {
    const wh_played_room_t room = room_here();
    int64_t slices = 0;
    (void)wh_player_init(&player, run, &room);
    while (wh_player_next(&player)) {
        ++slices;
        assert_int_equal(player.command.seq, slices);
    }
    assert_true(player.status != WH_OK || slices == run->slices);
    return player.status;
}

/* ------------------------------------------------------------------------------------------------- refusing */

/* Zeroed, and after each refusal of wh_player_init, whatever its memory held before. */
static void a_player_without_a_run_plays_nothing(void **state) {
    (void)state;
    static wh_played_t run;
    const wh_played_room_t room = room_here();
    memset(&player, 0, sizeof player);
    assert_false(wh_player_next(&player));
    assert_int_equal(player.status, WH_STATUS_NOT_INITIALISED);
    assert_false(wh_player_is_as_recorded(&player));
    memset(&player, 0xa5, sizeof player);
    assert_false(wh_player_next(&player));
    assert_false(wh_player_is_as_recorded(&player));
    for (int missing = 0; missing < 3; ++missing) {
        memset(&player, 0, sizeof player);
        assert_int_equal(wh_player_init(&player, missing == 0 ? NULL : &run, missing == 1 ? NULL : &room),
                         WH_STATUS_NULL_ARGUMENT);
        assert_int_equal(player.status, WH_STATUS_NULL_ARGUMENT);
        assert_false(wh_player_next(&player));
        assert_int_equal(player.status, WH_STATUS_NULL_ARGUMENT);
    }
    assert_int_equal(wh_player_init(NULL, &run, &room), WH_STATUS_NULL_ARGUMENT);
}

static wh_played_t run_with_faults(size_t fault_count) {
    wh_played_t run = run_of(0, 20);
    for (int i = 0; i < 6; ++i) {
        brought[i].seq = 3 + i / WH_COMMAND_FAULTS;
        brought[i].request.index = i;
        brought[i].request.fault = wh_fault_make(WH_FAULT_SENSOR_ON, 0, 0, 1, WH_FAULT_FOREVER);
    }
    run.faults = brought;
    run.fault_count = fault_count;
    return run;
}

static void a_run_that_lacks_an_array_is_refused(void **state) {
    (void)state;
    wh_played_t run = run_with_faults(3);
    assert_int_equal(play(&run), WH_OK);
    assert_int_equal(player.simulator.physics.faults.count, 3);
    run.rows = NULL;
    assert_int_equal(play(&run), WH_OK); /* there are none */
    run.row_count = 1;
    assert_int_equal(play(&run), WH_STATUS_NULL_ARGUMENT);
    run = run_with_faults(3);
    run.faults = NULL;
    assert_int_equal(play(&run), WH_STATUS_NULL_ARGUMENT);
    run.fault_count = 0;
    assert_int_equal(play(&run), WH_OK);
    run.order_count = 1;
    assert_int_equal(play(&run), WH_STATUS_NULL_ARGUMENT);
    run = run_with_faults(3);
    run.wafers = NULL;
    assert_int_equal(play(&run), WH_STATUS_NULL_ARGUMENT);
}

static void the_room_fits_the_run(void **state) {
    (void)state;
    wh_played_t run = run_of(0, 1);
    wh_played_room_t room = room_here();
    room.wafer_count = 1;
    assert_int_equal(wh_player_init(&player, &run, &room), WH_STATUS_BAD_CAPACITY);
    room = room_here();
    room.gripper_count = 1;
    assert_int_equal(wh_player_init(&player, &run, &room), WH_STATUS_BAD_CAPACITY);
    room = room_here();
    room.motion_count = 1;
    assert_int_equal(wh_player_init(&player, &run, &room), WH_STATUS_BAD_CAPACITY);
    room = room_here();
    room.slow = NULL;
    assert_int_equal(wh_player_init(&player, &run, &room), WH_STATUS_NULL_ARGUMENT);
    run.parts.begin_slowly = NULL;
    assert_int_equal(wh_player_init(&player, &run, &room), WH_OK);
    run.parts.set_grips = wh_simulator_set_grips;
    assert_int_equal(wh_player_init(&player, &run, &room), WH_STATUS_NULL_ARGUMENT); /* no `seen` */
}

static void a_runs_two_slice_lengths_agree(void **state) {
    (void)state;
    const double bad[] = {0.002, 0.0010001, 0.000999, 0, -0.001, (double)NAN, (double)INFINITY};
    const wh_played_room_t room = room_here();
    wh_played_t run = run_of(0, 20);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        run.physics.slice_s = (wh_real_t)bad[i];
        assert_int_equal(play(&run), WH_STATUS_OUT_OF_RANGE);
    }
    for (int64_t us = 1; us <= 1000000; us += (us < 5000 ? 1 : 997) * WH_TEST_SHARE) {
        run.slice_us = us;
        run.physics.slice_s = (wh_real_t)us / WH_REAL(1e6);
        assert_int_equal(wh_player_init(&player, &run, &room), WH_OK);
    }
}

static void a_runs_faults_and_orders_are_in_order(void **state) {
    (void)state;
    wh_played_order_t orders[2] = {{.seq = 3}, {.seq = 4}};
    wh_played_t run = run_with_faults(6); /* 4 of slice 3, 2 of slice 4 */
    run.orders = orders;
    run.order_count = 2;
    assert_int_equal(play(&run), WH_OK);
    brought[4].seq = 3;
    assert_int_equal(play(&run), WH_STATUS_OUT_OF_RANGE);
    brought[4].seq = 4;
    brought[5].seq = 3;
    assert_int_equal(play(&run), WH_STATUS_OUT_OF_RANGE);
    brought[5].seq = 4;
    brought[0].seq = 0;
    assert_int_equal(play(&run), WH_STATUS_OUT_OF_RANGE);
    brought[0].seq = 3;
    orders[1].seq = 3;
    assert_int_equal(play(&run), WH_STATUS_OUT_OF_RANGE);
    orders[0].seq = 0;
    orders[1].seq = 4;
    assert_int_equal(play(&run), WH_STATUS_OUT_OF_RANGE);
    orders[0].seq = 3;
    assert_int_equal(play(&run), WH_OK);
    orders[1].scan.kind = WH_SCAN_ARM; /* there is no edge sensor: the slice is refused */
    assert_int_equal(play(&run), WH_STATUS_OUT_OF_RANGE);
    assert_int_equal(player.command.seq, 4);
}

/* Theta turns, a slice of the vacuum, then rows that each are wrong in one way. */
static void rows_that_are_not_as_described_are_refused(void **state) {
    (void)state;
    const wh_played_row_t good[] = {row_of(2, 500, WH_PLAYED_AXES, 0x1),
                                    row_of(502, 0, WH_PLAYED_VALVES, 0x3),
                                    row_of(510, 5, WH_PLAYED_AXES, 0x10)};
    const struct {
        size_t row;
        wh_played_row_t as;
        int64_t slices; /* that are played before */
    } bad[] = {
        {0, row_of(2, 0, WH_PLAYED_AXES, 0x1), 0},      /* no slice */
        {0, row_of(-1, 500, WH_PLAYED_AXES, 0x1), 0},   /* before the run */
        {0, row_of(2, 500, WH_PLAYED_MORE, 0x1), 0},    /* nothing began */
        {0, row_of(2, 500, (wh_played_kind_t)9, 1), 0}, /* no kind */
        {1, row_of(1, 0, WH_PLAYED_VALVES, 0x3), 0},    /* out of order */
        {2, row_of(520, 1, WH_PLAYED_AXES, 0x10), 0},   /* after the run */
        {2, row_of(510, 11, WH_PLAYED_AXES, 0x10), 0},  /* beyond it */
        {0, row_of(2, 500, WH_PLAYED_AXES, 0), 2},      /* no axis */
        {0, row_of(2, 500, WH_PLAYED_AXES, 0x20), 2},   /* of another machine */
        {1, row_of(502, 0, WH_PLAYED_VALVES, 0x4), 502},
        {2, row_of(510, 5, WH_PLAYED_MORE, 0x10), 0},  /* valves have no values */
        {2, row_of(510, 5, WH_PLAYED_POINT, 0x10), 0}, /* nor points */
    };
    rows[0] = good[0];
    rows[0].values[0] = 1;
    rows[1] = good[1];
    rows[2] = good[2];
    const wh_played_t run = run_of(3, 520);
    assert_int_equal(play(&run), WH_OK);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        const wh_played_row_t kept = rows[bad[i].row];
        rows[bad[i].row] = bad[i].as;
        assert_int_not_equal(play(&run), WH_OK);
        assert_int_equal(player.track.slice, bad[i].slices);
        rows[bad[i].row] = kept;
    }
    assert_int_equal(play(&run), WH_OK);
}

/* Axes that somebody else moved stand where their rows say, and stay there; a row that goes on has the other values. */
static void axes_stand_where_they_are_placed(void **state) {
    (void)state;
    static const double first[] = {0.5, 650, 902, -0.25, 0.125};
    rows[0] = row_of(0, 0, WH_PLAYED_PLACE, 0x1f);
    memcpy(rows[0].values, (const wh_real_t[]){WH_REAL(0.5), 650, 902, WH_REAL(-0.25), WH_REAL(0.125)},
           5 * sizeof(wh_real_t));
    rows[1] = row_of(0, 0, WH_PLAYED_VALVES, 0x1);
    rows[2] = row_of(3, 0, WH_PLAYED_PLACE, 0x4);
    rows[2].values[0] = 910;
    const wh_played_t run = run_of(3, 5);
    const wh_played_room_t room = room_here();
    assert_int_equal(wh_player_init(&player, &run, &room), WH_OK);
    for (int64_t slice = 1; slice <= run.slices; ++slice) {
        assert_true(wh_player_next(&player));
        for (size_t axis = 0; axis < 5; ++axis) {
            assert_true(player.command.axes[axis] == (axis == 2 && slice > 3 ? 910 : (wh_real_t)first[axis]));
        }
        assert_int_equal(player.command.grippers[0].valve, WH_VALVE_OPEN);
    }
    assert_false(wh_player_next(&player));
    assert_int_equal(player.status, WH_OK);
    const wh_player_t before = player;
    rows[2].values[0] += WH_REAL(0.5);
    assert_int_equal(play(&run), WH_OK);
    assert_true(player.inputs != before.inputs);
}

static void places_that_are_not_as_described_are_refused(void **state) {
    (void)state;
    const wh_real_t bad[] = {1e9, -1e9, (wh_real_t)NAN, (wh_real_t)INFINITY};
    rows[0] = row_of(1, 0, WH_PLAYED_PLACE, 0x2);
    rows[0].values[0] = 600;
    wh_played_t run = run_of(1, 5);
    assert_int_equal(play(&run), WH_OK);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        rows[0].values[0] = bad[i];
        assert_int_not_equal(play(&run), WH_OK);
        assert_int_equal(player.track.slice, 1);
    }
    rows[0].values[0] = 600;
    rows[0].bits = 0x20;
    assert_int_equal(play(&run), WH_STATUS_OUT_OF_RANGE);
    rows[0].bits = 0x2;
    run.row_count = 2;
    rows[1] = row_of(1, 0, WH_PLAYED_SLOW, 0);
    assert_int_equal(play(&run), WH_STATUS_OUT_OF_RANGE); /* no motion that could be slow */
    rows[1] = row_of(1, 0, WH_PLAYED_POINT, 0);
    assert_int_equal(play(&run), WH_STATUS_OUT_OF_RANGE);
    rows[1] = row_of(0, 0, WH_PLAYED_PLACE, 0x2);
    assert_int_equal(play(&run), WH_STATUS_OUT_OF_RANGE); /* out of order */
    rows[1] = row_of(1, 0, WH_PLAYED_MORE, 0);
    assert_int_equal(play(&run), WH_STATUS_OUT_OF_RANGE); /* one value too many */
}

/* ---------------------------------------------------------------------------------------- as a track has it */

/* The axes that a track gives for a segment, slice by slice, from where it stands; and the row for it. */
static int64_t expect(wh_track_t *track, const wh_segment_t *segment, const wh_slowness_t *slowly,
                      wh_real_t axes[][WH_AXES], int64_t most) {
    int64_t slices = 0;
    wh_slow_t room;
    if (slowly) {
        assert_int_equal(wh_track_begin_slowly(track, segment, slowly, &room), WH_OK);
    } else {
        assert_int_equal(wh_track_begin(track, segment), WH_OK);
    }
    while (slices < most && wh_track_next(track, 0) == WH_TRACK_MOVING) {
        memcpy(axes[slices], track->axes, sizeof track->axes);
        ++slices;
    }
    return slices;
}

enum { SLICES = 12000 };
static wh_real_t expected[SLICES][WH_AXES];

static void put_values(size_t row, size_t count, const double values[]) {
    for (size_t i = 0; i < count; ++i) {
        rows[row].values[i] = (wh_real_t)values[i];
    }
}

static void compare(const wh_played_t *run) {
    const wh_played_room_t room = room_here();
    assert_int_equal(wh_player_init(&player, run, &room), WH_OK);
    for (int64_t i = 0; i < run->slices; ++i) {
        assert_true(wh_player_next(&player));
        assert_memory_equal(player.command.axes, expected[i], machine.axis_count * sizeof(wh_real_t));
    }
    assert_false(wh_player_next(&player));
    assert_int_equal(player.status, WH_OK);
}

/* One motion: its segment, and its rows. */
typedef struct {
    wh_played_kind_t kind;
    wh_segment_kind_t segment;
    double values[WH_PLAYED_VALUES]; /* of the first row */
    double targets[4];
} motion_case_t;

static const wh_slowness_t slowness = {{WH_REAL(0.5), 1}, WH_REAL(0.75)};
static const wh_via_point_t point = {.q = {1, 350, 950, 0}, .blend = 40};

static wh_segment_t segment_of(const wh_track_t *track, const motion_case_t *motion) {
    wh_segment_t segment = wh_track_blank(track);
    segment.kind = motion->segment;
    segment.gripper = 0;
    for (size_t axis = 0; axis < 4; ++axis) {
        segment.target[axis] = (wh_real_t)motion->targets[axis];
    }
    segment.travel = wh_vec3(0, 0, 12);
    segment.speed = 30;
    segment.reach = 400;
    segment.points = motion->kind == WH_PLAYED_VIA ? &point : NULL;
    segment.point_count = motion->kind == WH_PLAYED_VIA ? 1 : 0;
    return segment;
}

/* Adds the rows that come after the first one, and returns the next free one. */
static size_t add_rest(size_t row, bool has_point, bool is_slow) {
    if (has_point) {
        rows[row] = row_of(0, 0, WH_PLAYED_POINT, 0);
        put_values(row, 6, (const double[]){40, 0, 0, 1, 350, 950});
        rows[row + 1] = row_of(0, 0, WH_PLAYED_MORE, 0);
        row += 2;
    }
    if (is_slow) {
        rows[row] = row_of(0, 0, WH_PLAYED_SLOW, 0);
        put_values(row, 3, (const double[]){0.5, 1, 0.75});
        ++row;
    }
    return row;
}

/* AXES, LINE, WAY, VIA, and AXES at a slower pace, one after another; the WAY is cut. */
static void rows_move_the_axes_as_a_track_does(void **state) {
    (void)state;
    static const motion_case_t cases[] = {
        {WH_PLAYED_AXES, WH_SEGMENT_AXES, {1, 500, 1000, 0.5}, {1, 500, 1000, 0.5}},
        {WH_PLAYED_LINE, WH_SEGMENT_LINE, {0, 0, 12, 30}, {0}},
        {WH_PLAYED_WAY, WH_SEGMENT_WAY, {400, 0, -1, 600, 900, 0}, {-1, 600, 900, 0}},
        {WH_PLAYED_VIA, WH_SEGMENT_VIA, {2, 700, 950, 0.25}, {2, 700, 950, 0.25}},
        {WH_PLAYED_AXES, WH_SEGMENT_AXES, {0, 300, 900, 0}, {0, 300, 900, 0}},
    };
    wh_track_t track;
    int64_t at = 0;
    size_t row = 0;
    assert_int_equal(wh_track_init(&track, &machine, 1000), WH_OK);
    wh_track_take_ways(&track);
    wh_track_take_vias(&track);
    for (int i = 0; i < 5; ++i) {
        const wh_segment_t segment = segment_of(&track, &cases[i]);
        const bool is_cut = cases[i].kind == WH_PLAYED_WAY;
        const int64_t slices =
            expect(&track, &segment, i == 4 ? &slowness : NULL, expected + at, is_cut ? 700 : SLICES - at);
        rows[row] = row_of(at, slices, cases[i].kind, ROBOT);
        rows[row].gripper = 0;
        rows[row].is_cut = is_cut;
        put_values(row, WH_PLAYED_VALUES, cases[i].values);
        assert_true(!is_cut || slices == 700);
        at += slices;
        row = add_rest(row + 1, cases[i].kind == WH_PLAYED_VIA, i == 4);
    }
    const wh_played_t run = run_of(row, at);
    compare(&run);
}

/* The robot goes out while the chuck turns, and each moves as it does alone. */
static void motions_at_once_move_their_own_axes(void **state) {
    (void)state;
    wh_track_t robot;
    wh_track_t chuck;
    static wh_real_t other[SLICES][WH_AXES];
    assert_int_equal(wh_track_init(&robot, &machine, 1000), WH_OK);
    chuck = robot;
    wh_segment_t segment = wh_track_blank(&robot);
    segment.kind = WH_SEGMENT_AXES;
    segment.target[0] = 1;
    const int64_t first = expect(&robot, &segment, NULL, expected, SLICES);
    segment = wh_track_blank(&chuck);
    segment.kind = WH_SEGMENT_AXES;
    segment.target[4] = 3;
    const int64_t second = expect(&chuck, &segment, NULL, other, SLICES);
    const int64_t slices = 100 + second > first ? 100 + second : first;
    for (int64_t i = 0; i < slices; ++i) {
        memcpy(expected[i], i < first ? expected[i] : robot.axes, sizeof expected[i]);
        expected[i][4] = i < 100 ? 0 : i < 100 + second ? other[i - 100][4] : 3;
    }
    rows[0] = row_of(0, first, WH_PLAYED_AXES, 0x1);
    rows[0].values[0] = 1;
    rows[1] = row_of(100, second, WH_PLAYED_AXES, 0x10);
    rows[1].values[0] = 3;
    wh_played_t run = run_of(2, slices);
    compare(&run);

    wh_played_room_t room = room_here();
    run.motion_count = room.motion_count = 1;
    assert_int_equal(wh_player_init(&player, &run, &room), WH_OK);
    while (wh_player_next(&player)) {
    }
    assert_int_equal(player.status, WH_STATUS_BAD_CAPACITY);
    assert_int_equal(player.track.slice, 100);
}

/* A motion of more slices than it needs stands at its end; one of fewer, that nothing stopped, is there. So
 * float plays what double has planned. */
static void a_motion_ends_in_the_slice_that_its_row_says(void **state) {
    (void)state;
    for (int64_t slices = 500; slices <= 1500; slices += 250) {
        rows[0] = row_of(0, slices, WH_PLAYED_AXES, 0x1);
        rows[0].values[0] = 1;
        wh_played_t run = run_of(1, slices);
        assert_int_equal(play(&run), WH_OK);
        assert_true(player.track.axes[0] >= 1 && player.track.axes[0] <= 1);
        rows[0].is_cut = true;
        assert_int_equal(play(&run), WH_OK);
        assert_true(slices > 600 || player.track.axes[0] < 1);
    }
}

/* -------------------------------------------------------------------------------------------- what matters */

static void change_number(wh_played_row_t *row, size_t i) {
    row->after += i == 0;
    row->slices += i == 1;
    row->kind = i == 2 ? (wh_played_kind_t)((row->kind + 1) % WH_PLAYED_MORE) : row->kind;
    row->is_cut = row->is_cut != (i == 3);
    row->gripper += i == 4;
    row->bits ^= i == 5;
    if (i >= 6) {
        row->values[i - 6] = wh_test_neighbour(row->values[i - 6], 10000);
    }
}

static bool is_same(const wh_played_t *run) {
    (void)play(run);
    return wh_player_is_as_recorded(&player);
}

/* The robot takes wafer 0, with a fault on the way. */
static wh_played_t record_take(void) {
    wh_played_t run = run_with_faults(1);
    rows[0] = row_of(0, 1500, WH_PLAYED_AXES, ROBOT);
    put_values(0, 4, (const double[]){0, 700, 897, 0});
    rows[1] = row_of(1500, 0, WH_PLAYED_VALVES, 0x1);
    rows[2] = row_of(1501, 400, WH_PLAYED_LINE, ROBOT);
    rows[2].gripper = 0;
    put_values(2, 4, (const double[]){0, 0, 6, 20});
    run.row_count = 3;
    run.slices = 2000;
    assert_int_equal(play(&run), WH_OK);
    assert_int_equal(player.state.grippers[0].wafer, 0);
    assert_false(wh_player_is_as_recorded(&player));
    run.hash = wh_simulator_hash(&player.simulator);
    run.inputs = player.inputs;
    assert_true(wh_player_is_as_recorded(&player));
    return run;
}

static void each_number_of_a_row_matters(void **state) {
    (void)state;
    const wh_played_t run = record_take();
    for (size_t r = 0; r < run.row_count; ++r) {
        const wh_played_row_t kept = rows[r];
        for (size_t i = 0; i < WH_PLAYED_VALUES + 6; ++i) {
            change_number(&rows[r], i);
            assert_false(is_same(&run));
            rows[r] = kept;
        }
    }
    assert_true(is_same(&run));
}

static void the_cell_the_wafers_and_the_faults_matter(void **state) {
    (void)state;
    wh_played_t run = record_take();
    starts[1].r.x += 1;
    assert_false(is_same(&run));
    starts[1].r.x -= 1;
    brought[0].request.fault.from = 2;
    assert_false(is_same(&run));
    brought[0].request.fault.from = 1;
    station.pitch = 11;
    assert_false(is_same(&run));
    station.pitch = 10;
    machine.robot.limits[2].jerk *= 2; /* the axes come to their ends in another way */
    assert_false(is_same(&run));
    machine.robot.limits[2].jerk /= 2;
    run.physics.vacuum.on = WH_REAL(0.25);
    assert_false(is_same(&run));
    run.physics.vacuum.on = wh_physics_default().vacuum.on;
    assert_true(is_same(&run));
    --run.slices;
    assert_false(is_same(&run));
}

/* A constant carrier with the calls of the macro is one that wh_carrier_init has made. */
static void a_constant_carrier_has_the_calls_of_an_initialised_one(void **state) {
    (void)state;
    wh_chain_t chain;
    wh_carrier_t made;
    memset(&chain, 0, sizeof chain);
    chain.travel[WH_CHAIN_THETA] = machine.robot.travel[0];
    chain.travel[WH_CHAIN_REACH] = machine.robot.travel[1];
    chain.travel[WH_CHAIN_Z] = machine.robot.travel[2];
    chain.travel[WH_CHAIN_YAW] = machine.robot.travel[3];
    for (size_t axis = 0; axis < WH_CHAIN_AXES; ++axis) {
        chain.limits[axis] = machine.robot.limits[0];
    }
    chain.home[WH_CHAIN_REACH] = 300;
    chain.home[WH_CHAIN_Z] = 900;
    assert_int_equal(wh_carrier_init(&made, &chain), WH_OK);
    const wh_carrier_t written = {NULL, NULL, chain, 4, {4, 5, 1, 6}, WH_CARRIER_CALLS};
    assert_true(made.check_travel == written.check_travel && made.forward == written.forward);
    assert_true(made.inverse == written.inverse && made.plan_line == written.plan_line);
    assert_true(made.line_at == written.line_at);
    assert_int_equal(made.axis_count, written.axis_count);
    assert_memory_equal(made.axes, written.axes, written.axis_count);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(a_player_without_a_run_plays_nothing, set_up),
        cmocka_unit_test_setup(a_run_that_lacks_an_array_is_refused, set_up),
        cmocka_unit_test_setup(the_room_fits_the_run, set_up),
        cmocka_unit_test_setup(a_runs_two_slice_lengths_agree, set_up),
        cmocka_unit_test_setup(a_runs_faults_and_orders_are_in_order, set_up),
        cmocka_unit_test_setup(rows_that_are_not_as_described_are_refused, set_up),
        cmocka_unit_test_setup(axes_stand_where_they_are_placed, set_up),
        cmocka_unit_test_setup(places_that_are_not_as_described_are_refused, set_up),
        cmocka_unit_test_setup(rows_move_the_axes_as_a_track_does, set_up),
        cmocka_unit_test_setup(motions_at_once_move_their_own_axes, set_up),
        cmocka_unit_test_setup(a_motion_ends_in_the_slice_that_its_row_says, set_up),
        cmocka_unit_test_setup(each_number_of_a_row_matters, set_up),
        cmocka_unit_test_setup(the_cell_the_wafers_and_the_faults_matter, set_up),
        cmocka_unit_test_setup(a_constant_carrier_has_the_calls_of_an_initialised_one, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
