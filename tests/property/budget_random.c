/* Budgets of random cells. The windows of one station are closed forms of the paper's three
 * tolerances. The limits of a script with two stations are those that a plain search over a grid
 * finds. A hole in the range that passes is never within a width. Every point drawn from the box
 * passes. */
#include "support/support.h"

#include "layout/errors.h"
#include "math/trig.h"
#include "study/budget_player.h"

#include <unistd.h>

/* In full: cells, the steps of a grid, points of a box, and trials of a cell that collides. */
enum { CELLS = 3, GRID = 40, POINTS = 100, TRIALS = 20 };

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

/* `lines` describe the cell; all parameters are read. */
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

/* Each trial is the whole script, read again: a short run draws few points of the box. */
static wh_budget_options_t options_of(int32_t most, const bool *wanted) {
    const wh_budget_options_t options = {.threads = 1,
                                         .most = {most, most},
                                         .steps = 20,
                                         .samples =
                                             wh_test_is_full() ? 256 : (WH_TEST_SHARE > 1 ? 8 : 32) + 1,
                                         .seed = 1,
                                         .wanted = wanted};
    return options;
}

/* Only the first station is used, and under sanitizers no other is tested. */
static const bool only_first[2] = {true, false};
static const bool *const both = WH_TEST_SHARE > 1 ? only_first : NULL;

static void find(cell_t *cell, const wh_budget_options_t *options) {
    assert_true(wh_budget_find(&cell->budget, &cell->study, options));
}

static bool is_at_box;

static void see_box(void *user, const char *what, size_t done, size_t total) {
    (void)user;
    (void)done;
    (void)total;
    is_at_box = is_at_box || strncmp(what, "points of the box", 17) == 0;
}

static bool is_enough(void) {
    return is_at_box;
}

/* Only widths: the search ends before it looks for the box; a hole makes that search long. */
static void find_widths(cell_t *cell, int32_t most, const bool *wanted) {
    wh_budget_options_t options = options_of(most, wanted);
    options.tell = see_box;
    options.is_enough = is_enough;
    is_at_box = false;
    assert_false(wh_budget_find(&cell->budget, &cell->study, &options));
    assert_true(is_at_box && cell->budget.incomplete);
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

/* The last thousandth before a limit that itself does not pass. */
static void assert_ends_at(const wh_budget_side_t *side, double limit) {
    assert_near(side->inside, 1000 * limit - 0.5, 0.51);
    assert_int_equal(side->outside, side->inside + 1);
}

static void closed_forms_of_one_station(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(1, CELLS, 0.1);
    while (wh_round(&rounds)) {
        cell_t *cell = open_cell("get('A', 1)\nexpect(limit > 0)\n");
        const double *numbers = cell->numbers;
        find_widths(cell, 8000, both);
        const wh_budget_error_t *errors = cell->budget.stations[0].errors;
        for (int way = 0; way < 2; ++way) {
            assert_ends_at(&errors[0].sides[way], numbers[PROJXY]);
            assert_ends_at(&errors[1].sides[way], numbers[PROJXY]);
            assert_ends_at(&errors[3].sides[way], numbers[TILT_DEG]);
            assert_ends_at(&errors[4].sides[way], numbers[TILT_DEG]);
            assert_string_equal(errors[0].sides[way].why.name, "WAFER_MISSING");
            assert_string_equal(errors[0].sides[way].why.command, "GET A 1");
        }
        /* The blade enters too near to a wafer that is too low, and stops too far below a wafer
         * that is too high. */
        assert_ends_at(&errors[2].sides[0], numbers[STROKE] - numbers[OFFSET] - numbers[PROJZ]);
        assert_string_equal(errors[2].sides[0].why.name, "VACUUM_BEFORE_PICK");
        assert_ends_at(&errors[2].sides[1], numbers[OFFSET] + numbers[PROJZ]);
        /* The wafer is round, and no command goes to B. */
        assert_false(errors[5].has_effect);
        assert_int_equal(errors[5].width, 8000);
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

/* The cell of these tests, and its budget: up to 1 mm if the limit is nearer, except for long runs.
 * In each cell that is drawn, two tilts together reach the limit of one, so the box has an end. */
static cell_t *shared;
static wh_budget_options_t shared_options;

static int open_shared(void **state) {
    (void)state;
    shared_options = options_of(8000, both);
    shared_options.most[0] = wh_test_is_full() ? 8000 : 1000;
    shared = open_cell(transfer);
    find(shared, &shared_options);
    return 0;
}

static int close_shared(void **state) {
    (void)state;
    close_cell(shared);
    return 0;
}

static void what_passes_is_what_a_grid_finds(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(1, 12, 0.1);
    while (wh_round(&rounds)) {
        const size_t station = both ? 0 : wh_test_below(2);
        const size_t axis = wh_test_below(WH_SPREADS);
        const wh_budget_error_t *error = &shared->budget.stations[station].errors[axis];
        for (int way = 0; way < 2; ++way) {
            const wh_budget_side_t *side = &error->sides[way];
            const int32_t sign = way == 0 ? -1 : 1;
            for (int32_t i = 0; i <= GRID; i += WH_TEST_SHARE) {
                assert_true(
                    one_passes(shared, station, axis, sign * (int32_t)((int64_t)side->inside * i / GRID)));
            }
            assert_true(side->outside == 0 || !one_passes(shared, station, axis, sign * side->outside));
            assert_in_range(error->width, 0, side->inside);
        }
    }
}

/* The last hundredth is left out: the search for counterexamples does not prove a box. */
static void try_a_point(const cell_t *cell, bool is_inside) {
    char texts[2 * WH_SPREADS][WH_BUDGET_TEXT];
    const char *errors[2 * WH_SPREADS];
    for (size_t i = 0; i < 2 * WH_SPREADS; ++i) {
        const int32_t half = (int32_t)((int64_t)cell->budget.box.half[i] * 99 / 100);
        const int32_t value = is_inside               ? (int32_t)wh_test_below(2 * (uint32_t)half + 1) - half
                              : wh_test_below(2) == 0 ? half
                                                      : -half;
        wh_budget_text(texts[i], cell->study.layout, i / WH_SPREADS, i % WH_SPREADS, value);
        errors[i] = texts[i];
    }
    assert_true(run_passes(cell, errors, 2 * WH_SPREADS));
}

static void every_point_of_the_box_passes(void **state) {
    (void)state;
    const wh_budget_box_t *box = &shared->budget.box;
    assert_true(box->share > 0 && box->share <= box->whole);
    assert_non_null(box->outside);
    /* The box ends at its witness: it fails one thousandth beyond it, along each error of the witness. */
    bool beyond = false;
    for (size_t i = 0; i < 2 * WH_SPREADS; ++i) {
        assert_in_range(abs(box->outside[i]), 0, box->half[i] + 1);
        assert_in_range(abs(box->inside[i]), 0, box->half[i]);
        beyond = beyond || abs(box->outside[i]) > box->half[i];
    }
    assert_true(beyond);
    wh_rounds_t rounds = WH_ROUNDS(4, POINTS, 0.1);
    while (wh_round(&rounds)) {
        try_a_point(shared, rounds.number % 2 == 0);
    }
}

/* The wafers of A and B are off by the limit together: the expectation sees the difference of both. */
static void two_stations_share_a_limit(void **state) {
    (void)state;
    const cell_t *cell = shared;
    const double limit = cell->numbers[LIMIT];
    for (size_t station = 0; station < (both ? 1 : 2); ++station) {
        for (size_t axis = 0; axis < 2; ++axis) {
            const wh_budget_error_t *error = &cell->budget.stations[station].errors[axis];
            assert_near(error->width, 1000 * limit, 1.01);
            assert_string_equal(error->sides[0].why.name, "expectation");
        }
    }
    /* Along x alone both errors may take half of it, so the box is no larger than that. */
    assert_in_range(cell->budget.box.half[0] + cell->budget.box.half[WH_SPREADS], 1,
                    (int32_t)(1000 * limit) + 1);
}

/* ------------------------------------------------------------------------------------------------- a hole */

/* Between 1 and 1.2 mm it fails; beyond it passes again. */
static void what_passes_behind_a_hole_is_not_safe(void **state) {
    (void)state;
    wh_rounds_t rounds = WH_ROUNDS(1, CELLS, 0.1);
    while (wh_round(&rounds)) {
        char lines[400];
        const int32_t most = WH_TEST_SHARE > 1 ? 100 : 1000; /* µm */
        const double begins = wh_test_uniform(0.2e-3, 0.8e-3) * most;
        const double ends = 1.3 * begins;
        (void)snprintf(lines, sizeof lines,
                       "get('A', 1) put('B 2', 1)\n"
                       "local dx, dy = offset('W', 'B 2', 1)\n"
                       "local off = math.sqrt(dx * dx + dy * dy)\n"
                       "expect(off < %.17g or off > %.17g)\nexpect(limit > 0)\n",
                       begins, ends);
        cell_t *cell = open_cell(lines);
        find_widths(cell, most, only_first);
        for (size_t axis = 0; axis < 2; ++axis) {
            assert_ends_at(&cell->budget.stations[0].errors[axis].sides[0], begins);
            assert_ends_at(&cell->budget.stations[0].errors[axis].sides[1], begins);
            assert_true(one_passes(cell, 0, axis, (int32_t)(1100 * ends)) || cell->numbers[PROJXY] < 1.2);
        }
        close_cell(cell);
    }
}

/* ---------------------------------------------------------------------------------------------- collisions */

/* A FOUP, ledges and a prealigner, with wafers that rest and one that is moved over all of them. In
 * some cells wafers settle in their slots. */
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

/* One station's error, several errors of one station, or errors of all. */
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

/* A trial is replayed, and collisions are checked where something is off. It ends as the script does. */
static void replays_hit_what_the_script_hits(void **state) {
    (void)state;
    int failed = 0;
    wh_rounds_t rounds = WH_ROUNDS(2, 10, 0.2);
    while (wh_round(&rounds)) {
        cell_t *cell = calloc(1, sizeof *cell);
        wh_budget_player_t player;
        wh_budget_why_t why;
        assert_non_null(cell);
        open_colliding(cell);
        wh_budget_player_open(&player, &cell->study);
        assert_true(player.two_ways);
        for (int trial = 0; trial < TRIALS; ++trial) {
            int32_t point[3 * WH_SPREADS];
            draw_point(point, 3 * WH_SPREADS);
            const bool passes = wh_budget_passes(&player, point, WH_BUDGET_WITH);
            assert_int_equal(wh_budget_run(&player, point, &why), passes);
            const bool is_of_way = strcmp(why.name, "hit") == 0 || strcmp(why.name, "too_close") == 0 ||
                                   strcmp(why.name, "pushed_through") == 0;
            failed += !passes && is_of_way ? 1 : 0;
        }
        wh_budget_player_close(&player);
        close_cell(cell);
    }
    assert_in_range(failed, rounds.made * TRIALS / 20, rounds.made * TRIALS);
}

/* ------------------------------------------------------------------------------------------------- threads */

static void threads_change_nothing(void **state) {
    (void)state;
    wh_budget_options_t options = shared_options;
    const wh_budget_t *one = &shared->budget;
    wh_budget_t three;
    options.threads = 3;
    assert_true(wh_budget_find(&three, &shared->study, &options));
    assert_memory_equal(one->stations, three.stations, 2 * sizeof *one->stations);
    assert_int_equal(one->box.share, three.box.share);
    assert_memory_equal(one->box.outside, three.box.outside, 2 * WH_SPREADS * sizeof *one->box.outside);
    assert_int_equal(one->trials, three.trials);
    wh_budget_free(&three);
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
    return cmocka_run_group_tests(tests, open_shared, close_shared);
}
