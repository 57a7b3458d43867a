/* Counted time gives the full run's record, hash included, bit for bit: for studies' cells with drawn errors, in which
 * picks, hand-overs and shelves fail, and for commands at random in cells of all kinds. No axis does more to a
 * gripper in a slice than the bounds by which slices are left out. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mcs/script_run.h"
#include "print/record_print.h"
#include "support/support.h"
#include "trial/quiet.h"

typedef struct {
    int64_t slices, left_out, moving;
    size_t events;
} sums_t;

/* The record as JSON, but for what a counted run may tell otherwise. */
static char *tell(wh_record_t *record) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    record->wall_s = 0;
    record->counted.is_wanted = false;
    assert_int_equal(wh_record_print_json(record, out), 0);
    assert_int_equal(fclose(out), 0);
    return text;
}

static void compare(wh_script_run_options_t options, sums_t *sums) {
    static wh_script_run_t run;
    options.without_collisions = true;
    (void)wh_script_run(&run, &options);
    char *full = tell(&run.record);
    sums->slices += run.record.slices;
    sums->events += run.record.event_count;
    wh_script_run_close(&run);
    options.counts = WH_MCS_COUNT;
    (void)wh_script_run(&run, &options);
    sums->left_out += run.record.counted.left_out;
    sums->moving += run.record.counted.moving;
    char *counted = tell(&run.record);
    wh_script_run_close(&run);
    assert_string_equal(counted, full);
    free(full);
    free(counted);
}

static void report(const sums_t *sums, int rounds) {
    printf("%d rounds: %lld of %lld slices left out, something moved in %lld; %zu events\n", rounds,
           (long long)sums->left_out, (long long)sums->slices, (long long)sums->moving, sums->events);
}

/* ------------------------------------------------------------------------------------------ studies' trials */

static void trials_of_studies(void **state) {
    (void)state;
    static const char *const scripts[] = {"tests/end_to_end/data/study_retry.lua",
                                          "tests/end_to_end/data/study_shelves.lua"};
    static const char *const kinds[][3] = {{"check=sampled", "seat=false", "vacuum=ideal"},
                                           {"check=swept", "seat=true", "z=1"},
                                           {"vacuum=delayed", "settle=true", "z=0.6"},
                                           {"vacuum=delayed", "check=swept", "late=0.01"},
                                           {"double=true", "z=0.01", "seat=true"}};
    FILE *nowhere = fopen("/dev/null", "w");
    sums_t sums = {0};
    wh_rounds_t rounds = WH_ROUNDS(30, 1000, 0.3);
    while (wh_round(&rounds)) {
        const wh_trial_t trial = {7, (uint64_t)rounds.number};
        compare((wh_script_run_options_t){.script = scripts[wh_test_below(2)],
                                          .parameters = kinds[wh_test_below(sizeof kinds / sizeof *kinds)],
                                          .parameter_count = 3,
                                          .unread_parameters = true,
                                          .trial = &trial,
                                          .limits.print_to = nowhere},
                &sums);
    }
    report(&sums, rounds.made);
    assert_true(sums.left_out > sums.slices / 2 && sums.events > (size_t)rounds.made);
    assert_int_equal(fclose(nowhere), 0);
}

/* -------------------------------------------------------------------------------------- commands at random */

static const struct {
    const char *layout, *stations, *grippers, *robots;
} cells[] = {{"study_cell.lua", "A,B,P", "EE,PA", ""},
             {"../../../lua/layouts/paper.lua", "A,B,P", "EE,PA", ""},
             {"../../../lua/layouts/dual.lua", "A,B,P", "FRONT,BACK,PA", ""},
             {"../../../lua/layouts/dual_efem.lua", "FOUP1,FOUP2,P1,P2", "ONE,TWO,PA1,PA2", ""},
             {"../../../lua/layouts/edge.lua", "A,B,P", "EE,PA", ""},
             {"../../../lua/layouts/face_down.lua", "B,D,P,U", "EE,P1", ""},
             {"../../../lua/layouts/flip.lua", "A,D", "EE", ""},
             {"../../../lua/layouts/leak.lua", "A,B", "EE", ""},
             {"../../../lua/layouts/load_lock.lua", "A,FLIPPER,LL", "EE,CLAMP", ""},
             {"../../../lua/layouts/stage.lua", "A,P", "EE,PA,PINS", ""},
             {"../../../lua/layouts/tilting.lua", "A,B", "EE", ""},
             {"../../../lua/layouts/tool.lua", "FROM,IN,OUT,PM1,TO", "ATM blade,VAC 1,VAC 2", "ATM,VAC"},
             {"../../../lua/layouts/two_doors.lua", "A,LL,PM", "ATM blade,VAC blade", "ATM,VAC"},
             {"../../../lua/layouts/two_robots.lua", "FROM,IN,OUT,PM,TO", "ATM blade,VAC blade", "ATM,VAC"},
             {"../../../lua/layouts/vacuum_tool.lua", "AL,LL,PM1,PM2", "A,B,CHUCK,PINS", ""}};

static void commands_at_random(void **state) {
    (void)state;
    FILE *nowhere = fopen("/dev/null", "w");
    sums_t sums = {0};
    wh_rounds_t rounds = WH_ROUNDS(30, 3000, 0.5);
    while (wh_round(&rounds)) {
        char texts[6][100];
        const char *parameters[6] = {texts[0], texts[1], texts[2], texts[3], texts[4], texts[5]};
        const size_t c = wh_test_below(sizeof cells / sizeof *cells);
        (void)snprintf(texts[0], sizeof texts[0], "layout=%s", cells[c].layout);
        (void)snprintf(texts[1], sizeof texts[1], "stations=%s", cells[c].stations);
        (void)snprintf(texts[2], sizeof texts[2], "grippers=%s", cells[c].grippers);
        (void)snprintf(texts[3], sizeof texts[3], "seed=%u", (unsigned)wh_test_below(1000000));
        (void)snprintf(texts[4], sizeof texts[4], "count=%u", 10 + (unsigned)wh_test_below(40));
        (void)snprintf(texts[5], sizeof texts[5], "robots=%s", cells[c].robots);
        compare((wh_script_run_options_t){.script = "tests/end_to_end/data/random_walk.lua",
                                          .parameters = parameters,
                                          .parameter_count = 6,
                                          .unread_parameters = true,
                                          .limits.print_to = nowhere},
                &sums);
    }
    report(&sums, rounds.made);
    assert_true(sums.left_out > sums.slices / 3 && sums.events > (size_t)rounds.made);
    assert_int_equal(fclose(nowhere), 0);
}

/* -------------------------------------------------------------------------------------------------- bounds */

typedef struct {
    wh_quiet_t quiet;
    wh_command_t before;
    int64_t moved, flat;
} bounds_t;

static double turn_between(const wh_mat3_t *a, const wh_mat3_t *b) {
    double sum = 0;
    for (int i = 0; i < 9; ++i) {
        sum += pow(a->m[i / 3][i % 3] - b->m[i / 3][i % 3], 2);
    }
    return 2 * asin(fmin(sqrt(sum / 8), 1));
}

static bool is_level(const wh_mat3_t *R) {
    return R->m[2][0] == 0 && R->m[2][1] == 0 && R->m[2][2] == 1;
}

static void check_gripper(bounds_t *bounds, const wh_command_t *command, uint32_t axes, size_t g) {
    const wh_pose_t *from = &bounds->before.grippers[g].base_from_gripper;
    const wh_pose_t *to = &command->grippers[g].base_from_gripper;
    const wh_vec3_t way = wh_vec3_subtract(&to->r, &from->r);
    double most = 1e-9, turn = 1e-6;
    for (size_t axis = 0; axis < command->axis_count; ++axis) {
        most += (axes >> axis & 1U) != 0 ? bounds->quiet.by_axis[g][axis].way : 0;
        turn += (axes >> axis & 1U) != 0 ? bounds->quiet.by_axis[g][axis].turn : 0;
    }
    assert_true(wh_vec3_norm(&way) <= most);
    assert_true(turn_between(&from->R, &to->R) <= turn);
    if ((axes & bounds->quiet.movers[g]) == 0) {
        assert_memory_equal(from, to, sizeof *to);
    }
    if ((axes & bounds->quiet.lifters[g]) == 0 && is_level(&from->R)) {
        assert_true(way.z == 0 && is_level(&to->R));
        ++bounds->flat;
    }
    bounds->moved += wh_vec3_norm(&way) > 0;
}

/* The axes that have moved, whatever the segment. */
static void check_slice(void *user, const wh_command_t *command, const wh_state_t *state) {
    bounds_t *bounds = user;
    uint32_t axes = 0;
    for (size_t axis = 0; axis < command->axis_count; ++axis) {
        axes |= command->axes[axis] != bounds->before.axes[axis] ? UINT32_C(1) << axis : 0;
    }
    for (size_t g = 0; state->seq > 1 && g < command->gripper_count; ++g) {
        check_gripper(bounds, command, axes, g);
    }
    bounds->before = *command;
}

static void set_up_bounds(void *user, const wh_layout_t *layout) {
    bounds_t *bounds = user;
    if (!bounds->quiet.machine) {
        wh_quiet_begin(&bounds->quiet, &layout->machine, layout->physics.slice_s);
    }
}

static void axes_keep_their_bounds(void **state) {
    (void)state;
    static const char *const scripts[] = {
        "lua/examples/02_prealigner.lua",  "lua/examples/12_three_foups.lua",
        "lua/examples/16_tilting.lua",     "lua/examples/20_series.lua",
        "lua/examples/21_flip.lua",        "lua/examples/23_two_robots.lua",
        "lua/examples/26_vacuum_tool.lua", "lua/examples/28_dual_efem.lua",
        "lua/examples/29_load_lock.lua",   "lua/examples/32_own_pattern.lua",
        "tests/end_to_end/data/via.lua",   "tests/end_to_end/data/via_rail.lua"};
    static wh_script_run_t run;
    FILE *nowhere = fopen("/dev/null", "w");
    for (size_t i = 0; i < sizeof scripts / sizeof *scripts; ++i) {
        static bounds_t bounds;
        memset(&bounds, 0, sizeof bounds);
        const wh_script_run_options_t options = {
            .script = scripts[i],
            .without_collisions = true,
            .listener = {.slice = check_slice, .boundary = set_up_bounds, .user = &bounds},
            .limits.print_to = nowhere};
        (void)wh_script_run(&run, &options);
        wh_script_run_close(&run);
        assert_true(bounds.moved > 1000 && bounds.flat > 1000);
    }
    assert_int_equal(fclose(nowhere), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(trials_of_studies),
        cmocka_unit_test(commands_at_random),
        cmocka_unit_test(axes_keep_their_bounds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
