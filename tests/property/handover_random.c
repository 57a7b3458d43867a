/* Hand-overs from the end-effector to chucks at random heights, with either order of the valves. In
 * random cells, `layout`, a run, and the closed forms of a polar robot agree on which slots GET and
 * PUT reach. */
#include "support/support.h"

#include "math/trig.h"
#include "mcs/script_run.h"
#include "reading/layout_read.h"
#include "survey/survey.h"

#include <unistd.h>

#define TRANSFERS 750

/* The least margin to eps_projz that a hand-over leaves, mm. */
#define LEAST_MARGIN 0.2

/* A chuck with a random height and a random order of the valves. */
static const char handover_layout[] =
    "return {\n"
    "  grippers = { { name = 'EE' }, { name = 'PA', on = 'P' } },\n"
    "  stations = {\n"
    "    B = { at = { 0, 700, params.slot_height }, rpy = { 0, 0, 90 } },\n"
    "    P = { kind = 'prealigner', at = { -600, 0, params.chuck_height }, rpy = { 0, 0, 180 },\n"
    "          handover = params.handover },\n"
    "  },\n"
    "  wafers = { { name = 'Wafer', station = 'B', slot = 1, dx = params.dx, dy = params.dy } },\n"
    "}\n";

/* The layout, and the script with its GETs and PUTs. */
static char layout_path[WH_TEST_PATH], script[WH_TEST_PATH];

static FILE *create(char path[WH_TEST_PATH]) {
    FILE *file = fdopen(mkstemp(wh_test_path(path, "handover")), "w");
    assert_non_null(file);
    return file;
}

static int write_script(void **state) {
    (void)state;
    FILE *layout = create(layout_path);
    FILE *lines = create(script);
    fputs(handover_layout, layout);
    fprintf(lines,
            "cell '%s'\n"
            "get('B', 1) put('P', 1)\n"
            "expect(holder('Wafer') == 'PA', 'the chuck holds the wafer')\n",
            layout_path);
    return fclose(layout) + fclose(lines);
}

static int remove_script(void **state) {
    (void)state;
    return unlink(layout_path) + unlink(script);
}

static double play(const char *handover) {
    char texts[5][60];
    const char *parameters[5];
    snprintf(texts[0], sizeof texts[0], "slot_height=%.17g", wh_test_uniform(650, 1250));
    snprintf(texts[1], sizeof texts[1], "chuck_height=%.17g", wh_test_uniform(650, 1250));
    snprintf(texts[2], sizeof texts[2], "dx=%.17g", wh_test_uniform(-20, 20));
    snprintf(texts[3], sizeof texts[3], "dy=%.17g", wh_test_uniform(-20, 20));
    snprintf(texts[4], sizeof texts[4], "handover=%s", handover);
    for (size_t i = 0; i < 5; ++i) {
        parameters[i] = texts[i];
    }
    const wh_script_run_options_t options = {
        .script = script, .parameters = parameters, .parameter_count = 5};
    wh_script_run_t run;
    const wh_script_run_outcome_t outcome = wh_script_run(&run, &options);
    if (outcome != WH_RUN_MET) {
        print_error("%s %s %s: %s %s\n", texts[0], texts[1], handover, run.message,
                    run.record.failure ? run.record.failure : "");
    }
    assert_int_equal(outcome, WH_RUN_MET);
    assert_int_equal(run.record.event_count, 2);
    const wh_event_t *event = &run.record.events[1].event;
    assert_int_equal(event->kind, WH_EVENT_HANDED_OVER);
    assert_true(event->measured.ready);
    const double margin = event->measured.margin_projz;
    wh_script_run_close(&run);
    return margin;
}

static void test_transfers(const char *handover) {
    double least = 1;
    wh_rounds_t rounds = WH_ROUNDS(1, TRANSFERS, 0.3);
    while (wh_round(&rounds)) {
        const double margin = play(handover);
        least = margin < least ? margin : least;
    }
    print_message("%s: %d transfers, least margin %.6f mm\n", handover, rounds.made, least);
    assert_true(least >= LEAST_MARGIN);
}

static void new_gripper_first(void **state) {
    (void)state;
    test_transfers("new_first");
}

static void within_the_same_slice(void **state) {
    (void)state;
    test_transfers("same_slice");
}

/* ----------------------------------------------------------------------------------------- what is in reach */

#define CELLS 300

/* A tilted or an upright station, a blade that is mounted aside on the end-effector, and a robot
 * with little room. */
static const char reach_layout[] =
    "local p = params\n"
    "return {\n"
    "  robot = { theta = { min = p.theta_min, max = p.theta_max }, r = { min = p.r_min, max = p.r_max, home "
    "= p.r_max },\n"
    "            z = { min = p.z_min, max = p.z_max, home = p.z_max }, yaw = { min = -p.yaw, max = p.yaw } "
    "},\n"
    "  grippers = { { name = 'EE', at = { p.blade_x, p.blade_y, 0 }, rpy = { 0, 0, p.blade_turn } } },\n"
    "  stations = { A = { at = { p.x, p.y, p.z }, rpy = { p.roll, p.pitch, p.heading }, slots = p.slots,\n"
    "                     retract = p.retract } },\n"
    "}\n";

/* Every GET and PUT from home. A command that planning refuses ends the script. */
static const char reach_script[] = "for slot = 1, params.slots do\n"
                                   "  home() get('A', slot, { vacuum_check = 'none' })\n"
                                   "  home() put('A', slot, { vacuum_check = 'none', force = true })\n"
                                   "end\n";

enum { THETA_MIN, THETA_MAX, R_MIN, R_MAX, Z_MIN, Z_MAX, YAW, BLADE_X, BLADE_Y, BLADE_TURN };
enum { X = BLADE_TURN + 1, Y, Z, ROLL, PITCH, HEADING, RETRACT, SLOTS, NUMBERS };

static char reach_path[WH_TEST_PATH];
static char reach_script_path[WH_TEST_PATH];
static double numbers[NUMBERS];
static char number_texts[NUMBERS][60];
static const char *number_parameters[NUMBERS];

static void write_files(void) {
    FILE *layout = create(reach_path);
    FILE *lines = create(reach_script_path);
    fputs(reach_layout, layout);
    fprintf(lines, "cell '%s'\n%s", reach_path, reach_script);
    assert_int_equal(fclose(layout) + fclose(lines), 0);
}

static void draw_numbers(void) {
    static const char *const names[NUMBERS] = {
        "theta_min",  "theta_max", "r_min", "r_max", "z_min", "z_max", "yaw",     "blade_x", "blade_y",
        "blade_turn", "x",         "y",     "z",     "roll",  "pitch", "heading", "retract", "slots"};
    const bool is_upright = wh_test_below(2) == 0;
    const double bearing = wh_test_uniform(-200, 200), radius = wh_test_uniform(350, 900);
    numbers[THETA_MIN] = wh_test_uniform(-560, -60);
    numbers[THETA_MAX] = wh_test_uniform(60, 560);
    numbers[R_MIN] = wh_test_uniform(150, 450);
    numbers[R_MAX] = wh_test_uniform(700, 1000);
    numbers[Z_MIN] = wh_test_uniform(700, 905);
    numbers[Z_MAX] = wh_test_uniform(950, 1200);
    numbers[YAW] = wh_test_uniform(20, 270);
    numbers[BLADE_X] = wh_test_uniform(-50, 50);
    numbers[BLADE_Y] = wh_test_uniform(-30, 30);
    numbers[BLADE_TURN] = wh_test_uniform(-20, 20);
    numbers[X] = radius * cos(bearing * M_PI / 180);
    numbers[Y] = radius * sin(bearing * M_PI / 180);
    numbers[Z] = wh_test_uniform(880, 940);
    numbers[ROLL] = is_upright ? 0 : wh_test_uniform(-40, 40);
    numbers[PITCH] = is_upright ? 0 : wh_test_uniform(-20, 20);
    numbers[HEADING] = bearing + wh_test_uniform(-50, 50);
    numbers[RETRACT] = wh_test_uniform(20, 600);
    numbers[SLOTS] = 1 + wh_test_below(6);
    for (size_t i = 0; i < NUMBERS; ++i) {
        snprintf(number_texts[i], sizeof number_texts[i], "%s=%.17g", names[i], numbers[i]);
        number_parameters[i] = number_texts[i];
    }
}

/* The distance of a value from the ends of its travel; below 0: outside. */
static double within(double value, double min, double max) {
    return value - min < max - value ? value - min : max - value;
}

static double turned_to_half(double angle) {
    return angle - 360 * ceil((angle - 180) / 360);
}

/* Theta has this value at the start of the way in, and turns by this angle on it. */
static double room_of_turn(double theta, double turn) {
    return fmin(within(theta, numbers[THETA_MIN], numbers[THETA_MAX]),
                within(theta + turn, numbers[THETA_MIN], numbers[THETA_MAX]));
}

/* The least room in the axes' travel and of the links on the way into a slot, mm or degrees. It follows the
 * text of motion/robot.h and bodies/shapes.h and uses none of their code: a polar robot starts from theta 0,
 * and takes the longer way round if it has to. */
static double room_at(const wh_layout_t *layout, int32_t slot) {
    const wh_pose_t at = wh_station_slot(&layout->places[0], slot);
    const double degree = M_PI / 180;
    const double heading = atan2((double)at.R.m[1][0], (double)at.R.m[0][0]);
    const double wrist = heading - numbers[BLADE_TURN] * degree; /* the end-effector's heading */
    const double to_x = (double)at.r.x - numbers[BLADE_X] * cos(wrist) + numbers[BLADE_Y] * sin(wrist);
    const double to_y = (double)at.r.y - numbers[BLADE_X] * sin(wrist) - numbers[BLADE_Y] * cos(wrist);
    const double from_x = to_x - numbers[RETRACT] * cos(heading);
    const double from_y = to_y - numbers[RETRACT] * sin(heading);
    const double along =
        -(from_x * cos(heading) + from_y * sin(heading)); /* from there to the closest point */
    const double aside = fabs(from_y * cos(heading) - from_x * sin(heading));
    const double ends[] = {hypot(from_x, from_y), hypot(to_x, to_y)};
    const double farthest = fmax(ends[0], ends[1]);
    const double nearest = along > 0 && along < numbers[RETRACT] ? aside : fmin(ends[0], ends[1]);
    double theta = atan2(from_y, from_x) / degree;
    if (within(theta, numbers[THETA_MIN], numbers[THETA_MAX]) < 0) {
        const double other = theta > 0 ? theta - 360 : theta + 360;
        theta = within(other, numbers[THETA_MIN], numbers[THETA_MAX]) < 0 ? theta : other;
    }
    const double turn = turned_to_half(atan2(to_y, to_x) / degree - atan2(from_y, from_x) / degree);
    const double yaw = turned_to_half(wrist / degree - theta);
    double room = fmin(nearest - numbers[R_MIN], numbers[R_MAX] - farthest);
    room = fmin(room, fmax(room_of_turn(theta, turn),
                           fmax(room_of_turn(theta - 360, turn), room_of_turn(theta + 360, turn))));
    room = fmin(room, fmin(within(yaw, -numbers[YAW], numbers[YAW]),
                           within(yaw - turn, -numbers[YAW], numbers[YAW])));
    const wh_layout_station_t *station = &layout->stations[0];
    const double low = (double)(at.r.z - (station->stroke - station->offset));
    const double high = (double)(at.r.z + station->offset);
    room = fmin(room, fmin(low - numbers[Z_MIN], numbers[Z_MAX] - high));
    /* Both links stretched come to the wrist, behind the end-effector. */
    const wh_arm_t *arm = &layout->shapes.arm;
    const double back_x = (double)arm->reach * cos(wrist), back_y = (double)arm->reach * sin(wrist);
    const double stretched =
        fmax(hypot(from_x - back_x, from_y - back_y), hypot(to_x - back_x, to_y - back_y));
    return fmin(room, 2 * (double)arm->link - stretched);
}

/* The least room of all slots. */
static double room_of(const wh_layout_t *layout) {
    double room = 1e9;
    for (int32_t slot = 1; slot <= layout->places[0].slots; ++slot) {
        room = fmin(room, room_at(layout, slot));
    }
    return room;
}

/* The verdict of `layout`: true if nothing is refused from home. */
static bool layout_passes(double *room) {
    static wh_survey_t survey;
    wh_sandbox_result_t result;
    wh_feasibility_t check;
    wh_sandbox_t *sandbox = wh_sandbox_new_with(NULL, number_parameters, NUMBERS, &result);
    const wh_layout_t *layout = wh_layout_load(sandbox, reach_path, &result);
    if (!layout) {
        fail_msg("%s", result.message);
    }
    wh_feasibility(&check, layout);
    assert_true(wh_survey_open(&survey, sandbox, layout, &check, &result));
    bool passes = true;
    for (size_t i = 0; i < check.count; ++i) {
        const wh_finding_t *finding = &check.findings[i];
        passes = passes && finding->kind != WH_FINDING_LINKS &&
                 (finding->kind != WH_FINDING_REACH || strstr(finding->text, "coming from theta"));
    }
    *room = room_of(layout);
    wh_feasibility_free(&check);
    wh_survey_close(&survey);
    wh_sandbox_free(sandbox);
    return passes;
}

static bool run_passes(void) {
    const wh_script_run_options_t options = {
        .script = reach_script_path, .parameters = number_parameters, .parameter_count = NUMBERS};
    wh_script_run_t run;
    const wh_script_run_outcome_t outcome = wh_script_run(&run, &options);
    const bool passes = outcome != WH_RUN_BAD_INPUT && !run.record.failure;
    if (!passes && outcome == WH_RUN_BAD_INPUT) {
        assert_non_null(strstr(run.message, "expected one in reach"));
    }
    wh_script_run_close(&run);
    return passes;
}

static void say_numbers(void) {
    for (size_t i = 0; i < NUMBERS; ++i) {
        print_error("%s ", number_texts[i]);
    }
}

static void layout_and_run_agree_on_what_is_in_reach(void **state) {
    (void)state;
    int counts[2] = {0, 0};
    write_files();
    wh_rounds_t rounds = WH_ROUNDS(12, CELLS, 0.4);
    while (wh_round(&rounds)) {
        double room;
        draw_numbers();
        const bool by_layout = layout_passes(&room);
        const bool by_run = run_passes();
        if (fabs(room) > 1e-6 && (by_layout != (room > 0) || by_run != (room > 0))) {
            say_numbers();
            fail_msg("room %g: layout %d, run %d", room, by_layout, by_run);
        }
        ++counts[by_layout ? 1 : 0];
    }
    print_message("%d cells refused, %d not\n", counts[0], counts[1]);
    assert_true(counts[0] > rounds.made / 20 && counts[1] > rounds.made / 20);
    assert_int_equal(unlink(reach_path) + unlink(reach_script_path), 0);
}

int main(void) {
    (void)wh_test_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(new_gripper_first),
        cmocka_unit_test(within_the_same_slice),
        cmocka_unit_test(layout_and_run_agree_on_what_is_in_reach),
    };
    return cmocka_run_group_tests(tests, write_script, remove_script);
}
