/* Budgets of random cells: the windows of one station are closed forms of the paper's three tolerances; what a script of two stations
 * may be off by is what a plain search over a grid finds; a hole in what passes is never within a width; and every point of the box
 * that is drawn passes. */
#include "support/support.h"

#include "layout/errors.h"
#include "math/trig.h"
#include "study/budget_player.h"

#include <unistd.h>

enum { ROUNDS = 1, GRID = 40, POINTS = 100 / WH_TEST_SHARE };

static const char layout_text[] =
    "return {\n"
    "  tolerance = { projz = params.projz, projxy = params.projxy, planar = params.planar },\n"
    "  grippers = { { name = 'EE' } },\n"
    "  stations = {\n"
    "    A = { at = { 700, 0, 900 }, stroke = params.stroke, offset = params.offset },\n"
    "    ['B 2'] = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 } },\n"
    "  },\n"
    "  wafers = { { name = 'W', station = 'A', slot = 1 } },\n"
    "}\n";

enum { PROJZ, PROJXY, TILT_DEG, STROKE, OFFSET, LIMIT, NUMBERS };

/* A script, its layout, and what was drawn for them. */
typedef struct {
    char layout[WH_TEST_PATH], script[WH_TEST_PATH];
    double numbers[NUMBERS];
    char texts[NUMBERS][60];
    const char *parameters[NUMBERS];
    wh_study_t study;
    wh_budget_t budget;
} cell_t;

static FILE *create(char path[WH_TEST_PATH]) {
    FILE *file = fdopen(mkstemp(wh_test_path(path, "budget")), "w");
    assert_non_null(file);
    return file;
}

/* `lines` follow the cell; all parameters are read. */
static cell_t *open_cell(const char *lines) {
    static const double least[] = {0.1, 1, 0.5, 5, 2, 0.3};
    static const double most[] = {0.9, 6, 6, 7, 3, 0.8};
    cell_t *cell = calloc(1, sizeof *cell);
    assert_non_null(cell);
    FILE *layout = create(cell->layout);
    FILE *script = create(cell->script);
    fputs(layout_text, layout);
    fprintf(script, "cell '%s'\nlocal limit = params.limit\n%s", cell->layout, lines);
    assert_int_equal(fclose(layout) + fclose(script), 0);
    for (size_t i = 0; i < NUMBERS; ++i) {
        static const char *const names[] = {"projz", "projxy", "planar", "stroke", "offset", "limit"};
        cell->numbers[i] = wh_test_uniform(least[i], most[i]);
        const double value =
            i == TILT_DEG ? (double)wh_cos(WH_PI / 180 * (wh_real_t)cell->numbers[i]) : cell->numbers[i];
        snprintf(cell->texts[i], sizeof cell->texts[i], "%s=%.17g", names[i], value);
        cell->parameters[i] = cell->texts[i];
    }
    cell->study.run = (wh_script_run_options_t){
        .script = cell->script, .parameters = cell->parameters, .parameter_count = NUMBERS};
    cell->study.run.limits.print_to = stderr;
    cell->study.trials = 1;
    cell->study.draws_nothing = true;
    assert_true(wh_study_open(&cell->study));
    if (!cell->study.nominal.record.ok) {
        print_error("%s\n", cell->study.nominal.record.failure);
    }
    assert_true(cell->study.nominal.record.ok);
    return cell;
}

static const wh_budget_options_t plain = {
    .threads = 1, .most = {8000, 8000}, .steps = 20, .samples = 256, .seed = 1};

static void find(cell_t *cell, const wh_budget_options_t *options) {
    assert_true(wh_budget_find(&cell->budget, &cell->study, options));
}

static void close_cell(cell_t *cell) {
    wh_budget_free(&cell->budget);
    wh_study_close(&cell->study);
    assert_int_equal(unlink(cell->layout) + unlink(cell->script), 0);
    free(cell);
}

/* Runs the script itself with these errors. */
static bool run_passes(const cell_t *cell, const char *const errors[], size_t count) {
    wh_script_run_options_t options = cell->study.run;
    wh_script_run_t run;
    options.errors = errors;
    options.error_count = count;
    const bool passes = wh_script_run(&run, &options) == WH_RUN_MET;
    wh_script_run_close(&run);
    return passes;
}

static bool one_passes(const cell_t *cell, size_t station, size_t axis, int32_t value) {
    char text[WH_BUDGET_TEXT];
    const char *errors[] = {text};
    wh_budget_text(text, cell->study.layout, station, axis, value);
    return run_passes(cell, errors, 1);
}

/* ------------------------------------------------------------------------------------------- closed forms */

/* The last thousandth before a limit, which itself does not pass. */
static void assert_ends_at(const wh_budget_side_t *side, double limit) {
    assert_near(side->inside, 1000 * limit - 0.5, 0.51);
    assert_int_equal(side->outside, side->inside + 1);
}

static void closed_forms_of_one_station(void **state) {
    (void)state;
    for (int round = 0; round < ROUNDS; ++round) {
        cell_t *cell = open_cell("get('A', 1)\nexpect(limit > 0)\n");
        const double *numbers = cell->numbers;
        find(cell, &plain);
        const wh_budget_error_t *errors = cell->budget.stations[0].errors;
        for (int way = 0; way < 2; ++way) {
            assert_ends_at(&errors[0].sides[way], numbers[PROJXY]);
            assert_ends_at(&errors[1].sides[way], numbers[PROJXY]);
            assert_ends_at(&errors[3].sides[way], numbers[TILT_DEG]);
            assert_ends_at(&errors[4].sides[way], numbers[TILT_DEG]);
            assert_string_equal(errors[0].sides[way].why.name, "WAFER_MISSING");
            assert_string_equal(errors[0].sides[way].why.command, "GET A 1");
        }
        /* The blade enters too near to a wafer that is too low, and ends too far below one that is too high. */
        assert_ends_at(&errors[2].sides[0], numbers[STROKE] - numbers[OFFSET] - numbers[PROJZ]);
        assert_string_equal(errors[2].sides[0].why.name, "VACUUM_BEFORE_PICK");
        assert_ends_at(&errors[2].sides[1], numbers[OFFSET] + numbers[PROJZ]);
        /* The wafer is round, and nobody goes to B. */
        assert_false(errors[5].has_effect);
        assert_int_equal(errors[5].width, plain.most[1]);
        for (size_t axis = 0; axis < WH_SPREADS; ++axis) {
            assert_false(cell->budget.stations[1].errors[axis].has_effect);
        }
        assert_int_equal(cell->budget.tightest, 0);
        assert_int_equal(cell->budget.next, WH_NONE);
        close_cell(cell);
    }
}

/* ------------------------------------------------------------------------------------------- plain search */

static const char transfer[] = "get('A', 1) put('B 2', 1)\nexpect_offset('W', 'B 2', 1, 0, 0, limit)\n";

static void what_passes_is_what_a_grid_finds(void **state) {
    (void)state;
    for (int round = 0; round < ROUNDS; ++round) {
        cell_t *cell = open_cell(transfer);
        find(cell, &plain);
        const size_t station = wh_test_below(2);
        const size_t axis = wh_test_below(WH_SPREADS);
        const wh_budget_error_t *error = &cell->budget.stations[station].errors[axis];
        for (int way = 0; way < 2; ++way) {
            const wh_budget_side_t *side = &error->sides[way];
            const int32_t sign = way == 0 ? -1 : 1;
            for (int32_t i = 0; i <= GRID; ++i) {
                assert_true(
                    one_passes(cell, station, axis, sign * (int32_t)((int64_t)side->inside * i / GRID)));
            }
            assert_true(side->outside == 0 || !one_passes(cell, station, axis, sign * side->outside));
            assert_in_range(error->width, 0, side->inside);
        }
        close_cell(cell);
    }
}

/* But for the last hundredth of it: a box is searched for counterexamples, not proved. */
static void every_point_of_the_box_passes(void **state) {
    (void)state;
    for (int round = 0; round < ROUNDS; ++round) {
        cell_t *cell = open_cell(transfer);
        find(cell, &plain);
        const wh_budget_box_t *box = &cell->budget.box;
        assert_true(box->share > 0 && box->share <= box->whole);
        assert_non_null(box->outside);
        for (int point = 0; point < POINTS; ++point) {
            char texts[2 * WH_SPREADS][WH_BUDGET_TEXT];
            const char *errors[2 * WH_SPREADS];
            for (size_t i = 0; i < 2 * WH_SPREADS; ++i) {
                const int32_t half = (int32_t)((int64_t)box->half[i] * 99 / 100);
                const int32_t value = point % 2 == 0 ? (int32_t)wh_test_below(2 * (uint32_t)half + 1) - half
                                      : wh_test_below(2) == 0 ? half
                                                              : -half;
                wh_budget_text(texts[i], cell->study.layout, i / WH_SPREADS, i % WH_SPREADS, value);
                errors[i] = texts[i];
            }
            assert_true(run_passes(cell, errors, 2 * WH_SPREADS));
        }
        /* The box ends where its witness says: one thousandth beyond it, along each error of the witness. */
        bool beyond = false;
        for (size_t i = 0; i < 2 * WH_SPREADS; ++i) {
            assert_in_range(abs(box->outside[i]), 0, box->half[i] + 1);
            assert_in_range(abs(box->inside[i]), 0, box->half[i]);
            beyond = beyond || abs(box->outside[i]) > box->half[i];
        }
        assert_true(beyond);
        close_cell(cell);
    }
}

/* The wafers of A and of B are off by the limit together: the expectation sees the difference of both. */
static void two_stations_share_a_limit(void **state) {
    (void)state;
    cell_t *cell = open_cell(transfer);
    find(cell, &plain);
    const double limit = cell->numbers[LIMIT];
    for (size_t station = 0; station < 2; ++station) {
        for (size_t axis = 0; axis < 2; ++axis) {
            const wh_budget_error_t *error = &cell->budget.stations[station].errors[axis];
            assert_near(error->width, 1000 * limit, 1.01);
            assert_string_equal(error->sides[0].why.name, "expectation");
        }
    }
    /* Along x alone both may have a half, so the box is no larger than that. */
    assert_in_range(cell->budget.box.half[0] + cell->budget.box.half[WH_SPREADS], 1,
                    (int32_t)(1000 * limit) + 1);
    close_cell(cell);
}

/* ------------------------------------------------------------------------------------------------- a hole */

/* Between 1 and 1.2 mm it fails; beyond it passes again. */
static void what_passes_behind_a_hole_is_not_safe(void **state) {
    (void)state;
    for (int round = 0; round < ROUNDS; ++round) {
        char lines[400];
        const double begins = wh_test_uniform(0.2, 0.8);
        const double ends = 1.3 * begins;
        (void)snprintf(lines, sizeof lines,
                       "get('A', 1) put('B 2', 1)\n"
                       "local dx, dy = offset('W', 'B 2', 1)\n"
                       "local off = math.sqrt(dx * dx + dy * dy)\n"
                       "expect(off < %.17g or off > %.17g)\nexpect(limit > 0)\n",
                       begins, ends);
        cell_t *cell = open_cell(lines);
        find(cell, &plain);
        for (size_t axis = 0; axis < 2; ++axis) {
            assert_ends_at(&cell->budget.stations[0].errors[axis].sides[0], begins);
            assert_ends_at(&cell->budget.stations[0].errors[axis].sides[1], begins);
            assert_true(one_passes(cell, 0, axis, (int32_t)(1100 * ends)) || cell->numbers[PROJXY] < 1.2);
        }
        close_cell(cell);
    }
}

/* ---------------------------------------------------------------------------------------------- collisions */

/* A FOUP, ledges and a prealigner, wafers that rest and one that is moved over all of them; at times wafers
 * come to rest on their slots. */
static const char colliding_layout[] =
    "return {\n"
    "  tolerance = { projz = 0.5, projxy = 5, planar = 0.999 }, collision = true, settle = params.settle,\n"
    "  clearance = { blade_wafer_above = params.clearance },\n"
    "  grippers = { { name = 'EE' }, { name = 'PA', on = 'P' } },\n"
    "  stations = {\n"
    "    A = { at = { 700, 0, 900 }, kind = 'foup', slots = 3 },\n"
    "    B = { at = { 0, 700, 900 }, rpy = { 0, 0, 90 }, slots = 2 },\n"
    "    P = { kind = 'prealigner', at = { -600, 0, 950 }, rpy = { 0, 0, 180 } },\n"
    "  },\n"
    "  wafers = { { name = 'W', station = 'A', slot = 2 }, { name = 'V', station = 'A', slot = 1 },\n"
    "             { name = 'U', station = 'B', slot = 1 } },\n"
    "}\n";

static void open_colliding(cell_t *cell) {
    FILE *layout = create(cell->layout);
    FILE *script = create(cell->script);
    fputs(colliding_layout, layout);
    fprintf(script,
            "cell '%s'\nget('A', 2) put('P', 1) rotate('P', 40) get('P', 1) put('B', 2)\n"
            "get('A', 1) put('A', 2)\n",
            cell->layout);
    assert_int_equal(fclose(layout) + fclose(script), 0);
    snprintf(cell->texts[0], sizeof cell->texts[0], "settle=%s", wh_test_below(3) == 0 ? "true" : "false");
    snprintf(cell->texts[1], sizeof cell->texts[1], "clearance=%.1f", 0.5 * wh_test_below(3));
    cell->parameters[0] = cell->texts[0];
    cell->parameters[1] = cell->texts[1];
    cell->study =
        (wh_study_t){.run = {.script = cell->script, .parameters = cell->parameters, .parameter_count = 2},
                     .trials = 1,
                     .draws_nothing = true};
    cell->study.run.limits.print_to = stderr;
    assert_true(wh_study_open(&cell->study));
    assert_true(cell->study.nominal.record.ok);
}

/* One station's error, several of one station, or of all. */
static void draw_point(int32_t point[], size_t size) {
    const uint32_t kind = wh_test_below(3);
    const size_t station = wh_test_below((uint32_t)(size / WH_SPREADS));
    const size_t only = station * WH_SPREADS + wh_test_below(WH_SPREADS);
    for (size_t i = 0; i < size; ++i) {
        const bool is_length = i % WH_SPREADS < 3;
        const int32_t most = is_length ? (i % WH_SPREADS == 2 ? 3000 : 5000) : 1500;
        const bool chosen = kind == 2 || (kind == 1 ? i / WH_SPREADS == station : i == only);
        const int32_t value = (int32_t)wh_test_below((uint32_t)(2 * most)) - most;
        point[i] = !chosen ? 0 : kind == 0 ? value : value / 3;
    }
}

/* A trial that is replayed, with collisions looked for where something is off, ends as the script does. */
static void replays_hit_what_the_script_hits(void **state) {
    (void)state;
    int failed = 0;
    for (int round = 0; round < 2; ++round) {
        cell_t *cell = calloc(1, sizeof *cell);
        wh_budget_player_t player;
        wh_budget_why_t why;
        assert_non_null(cell);
        open_colliding(cell);
        wh_budget_player_open(&player, &cell->study);
        assert_true(player.two_ways);
        for (int trial = 0; trial < POINTS; ++trial) {
            int32_t point[3 * WH_SPREADS];
            draw_point(point, 3 * WH_SPREADS);
            const bool passes = wh_budget_passes(&player, point, WH_BUDGET_WITH);
            assert_int_equal(wh_budget_run(&player, point, &why), passes);
            failed += !passes && (strcmp(why.name, "hit") == 0 || strcmp(why.name, "too_close") == 0) ? 1 : 0;
        }
        wh_budget_player_close(&player);
        close_cell(cell);
    }
    assert_in_range(failed, POINTS / 10, 2 * POINTS);
}

/* ------------------------------------------------------------------------------------------------- threads */

static void threads_change_nothing(void **state) {
    (void)state;
    cell_t *cell = open_cell(transfer);
    wh_budget_options_t options = plain;
    wh_budget_t one;
    find(cell, &options);
    one = cell->budget;
    memset(&cell->budget, 0, sizeof cell->budget);
    options.threads = 3;
    find(cell, &options);
    assert_memory_equal(one.stations, cell->budget.stations, 2 * sizeof *one.stations);
    assert_int_equal(one.box.share, cell->budget.box.share);
    assert_memory_equal(one.box.outside, cell->budget.box.outside, 2 * WH_SPREADS * sizeof *one.box.outside);
    assert_int_equal(one.trials, cell->budget.trials);
    wh_budget_free(&one);
    close_cell(cell);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_forms_of_one_station),
        cmocka_unit_test(what_passes_is_what_a_grid_finds),
        cmocka_unit_test(every_point_of_the_box_passes),
        cmocka_unit_test(two_stations_share_a_limit),
        cmocka_unit_test(what_passes_behind_a_hole_is_not_safe),
        cmocka_unit_test(replays_hit_what_the_script_hits),
        cmocka_unit_test(threads_change_nothing),
    };
    (void)wh_test_seed();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
