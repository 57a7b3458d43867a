/* A budget as tables. */
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "../text/output.h"
#include "budget_print.h"
#include "print_internal.h"

typedef struct {
    const wh_budget_t *budget;
    wh_printer_t frame;
} table_t;

static double number_of(int32_t thousandths) {
    return (double)thousandths / WH_BUDGET_UNIT;
}

static const char *unit_of(size_t axis) {
    return axis < 3 ? "mm" : "deg";
}

static const char *station_name(const table_t *table, size_t station) {
    return table->budget->study->layout->stations[station].name;
}

/* ----------------------------------------------------------------------------------------- each by itself */

#define WHY 400

/* "42 WAFER_MISSING in GET A 1", "hit in PUT B 2", "line 8 is not met". */
static void name_failure(const wh_budget_why_t *why, char text[WHY]) {
    char name[sizeof why->name];
    wh_text_words(name, sizeof name, why->name);
    if (why->error != WH_OK) {
        (void)snprintf(text, WHY, "%d %s in %s", (int)why->error, why->name, why->command);
    } else if (strcmp(why->name, "expectation") == 0) {
        (void)snprintf(text, WHY, "line %d is not met", why->line);
    } else {
        (void)snprintf(text, WHY, "%s%s%s", name, why->command[0] ? " in " : "", why->command);
    }
}

static void put_side(wh_grid_t *grid, const wh_budget_side_t *side, int way) {
    const double sign = way == 0 ? -1 : 1;
    const size_t column = 3 + 2 * (size_t)way;
    char why[WHY] = "";
    if (side->outside > 0) {
        name_failure(&side->why, why);
        wh_grid_text(grid, column, WH_INK_PLAIN, "%+.3f", sign * number_of(side->outside));
        wh_grid_text(grid, column + 1, WH_INK_PLAIN, "%s", why);
    } else {
        wh_grid_text(grid, column, WH_INK_DIM, "none");
    }
}

static void add_error(const table_t *table, wh_grid_t *grid, size_t station, size_t axis) {
    const wh_budget_t *budget = table->budget;
    const wh_budget_error_t *error = &budget->stations[station].errors[axis];
    const bool never = error->sides[0].outside == 0 && error->sides[1].outside == 0;
    const bool tightest = budget->tightest != WH_NONE && (size_t)budget->tightest == station &&
                          axis == wh_budget_tightest_axis(budget, station);
    wh_grid_row(grid);
    wh_grid_text(grid, 0, WH_INK_PLAIN, "%s", axis == 0 ? station_name(table, station) : "");
    wh_grid_text(grid, 1, WH_INK_PLAIN, "%s %s", wh_errors_teaching_name(axis), unit_of(axis));
    if (!error->known) {
        wh_grid_text(grid, 2, WH_INK_DIM, "not known");
    } else if (never) {
        wh_grid_text(grid, 2, WH_INK_DIM, "%s%g", error->has_effect ? "at least " : "no effect to ",
                     number_of(error->width));
    } else {
        wh_grid_text(grid, 2, tightest ? WH_INK_BAD : WH_INK_PLAIN, "%.3f", number_of(error->width));
        put_side(grid, &error->sides[0], 0);
        put_side(grid, &error->sides[1], 1);
    }
}

static bool has_effect(const wh_budget_station_t *station) {
    bool any = false;
    for (size_t axis = 0; axis < WH_SPREADS; ++axis) {
        any = any || station->errors[axis].has_effect || !station->errors[axis].known;
    }
    return any;
}

static void add_station(const table_t *table, wh_grid_t *grid, size_t station) {
    const wh_budget_options_t *options = &table->budget->options;
    if (!has_effect(&table->budget->stations[station])) {
        wh_grid_named_row(grid, station_name(table, station));
        wh_grid_text(grid, 1, WH_INK_PLAIN, "each");
        wh_grid_text(grid, 2, WH_INK_DIM, "no effect to %g mm, %g deg", number_of(options->most[0]),
                     number_of(options->most[1]));
        return;
    }
    for (size_t axis = 0; axis < WH_SPREADS; ++axis) {
        add_error(table, grid, station, axis);
    }
}

static void print_errors(const table_t *table) {
    const wh_budget_t *budget = table->budget;
    wh_grid_t *grid =
        wh_grid_new(table->frame.style, 2, "station;error;width{3};fails at{3};+with;and at{3};+with");
    for (size_t s = 0; s < budget->study->layout->station_count; ++s) {
        if (budget->stations[s].wanted) {
            add_station(table, grid, s);
        }
    }
    wh_print_titled(&table->frame, "Each error alone: passes from -width to +width", grid);
}

/* The direction that gives an error its width: 0 downwards, 1 upwards. */
static int tight_way(const wh_budget_error_t *error) {
    return error->sides[0].outside > 0 && error->sides[0].inside == error->width ? 0 : 1;
}

/* The command that plays a point. */
static void print_command(const table_t *table, const int32_t point[]) {
    const wh_study_t *study = table->budget->study;
    FILE *out = table->frame.out;
    fputs("  waferhand run ", out);
    wh_output_word(out, study->run.script);
    for (size_t i = 0; i < study->run.parameter_count; ++i) {
        fputs(" --set ", out);
        wh_output_word(out, study->run.parameters[i]);
    }
    for (size_t i = 0; point && i < WH_SPREADS * study->layout->station_count; ++i) {
        char text[WH_BUDGET_TEXT];
        if (point[i] != 0) {
            wh_budget_text(text, study->layout, i / WH_SPREADS, i % WH_SPREADS, point[i]);
            fputs(" --error ", out);
            wh_output_word(out, text);
        }
    }
    fputc('\n', out);
}

/* The error that allows least, just beyond its width. */
static void print_first(const table_t *table) {
    const wh_budget_t *budget = table->budget;
    if (budget->tightest == WH_NONE) {
        return;
    }
    const size_t station = (size_t)budget->tightest;
    const size_t axis = wh_budget_tightest_axis(budget, station);
    const int way = tight_way(&budget->stations[station].errors[axis]);
    int32_t *point = wh_array_new(WH_SPREADS * budget->study->layout->station_count, sizeof *point);
    point[station * WH_SPREADS + axis] =
        (way == 0 ? -1 : 1) * budget->stations[station].errors[axis].sides[way].outside;
    fputs("the first that fails, and any other, can be played by itself:\n", table->frame.out);
    print_command(table, point);
    free(point);
}

/* The largest distance between trials within the widths, in mm and in degrees. */
static double widest_step(const wh_budget_t *budget, bool turns) {
    int32_t widest = 0;
    for (size_t s = 0; s < budget->study->layout->station_count; ++s) {
        for (size_t axis = turns ? 3 : 0; axis < (turns ? 6U : 3U); ++axis) {
            for (int way = 0; way < 2; ++way) {
                const int32_t step = budget->stations[s].errors[axis].sides[way].widest;
                widest = step > widest ? step : widest;
            }
        }
    }
    return number_of(widest);
}

static void print_how(const table_t *table) {
    const wh_budget_t *budget = table->budget;
    fprintf(table->frame.out,
            "\ntried from 0 outwards up to %g mm and %g deg, in steps of at most %g mm and %g deg,\n"
            "and where it first fails to 0.001; a failure between two steps would not be seen\n",
            number_of(budget->options.most[0]), number_of(budget->options.most[1]),
            widest_step(budget, false), widest_step(budget, true));
}

/* ----------------------------------------------------------------------------------------------- together */

static void print_half(const table_t *table) {
    const wh_budget_t *budget = table->budget;
    wh_grid_t *grid = wh_grid_new(table->frame.style, 1, "station");
    char title[100];
    for (size_t axis = 0; axis < WH_SPREADS; ++axis) {
        char column[40];
        (void)snprintf(column, sizeof column, "%s %s{3}", wh_errors_teaching_name(axis), unit_of(axis));
        wh_grid_columns(grid, column);
    }
    for (size_t s = 0; s < budget->study->layout->station_count; ++s) {
        if (budget->stations[s].wanted) {
            wh_grid_named_row(grid, station_name(table, s));
        }
        for (size_t axis = 0; axis < WH_SPREADS && budget->stations[s].wanted; ++axis) {
            wh_grid_number(grid, 1 + axis, WH_INK_PLAIN, number_of(budget->box.half[s * WH_SPREADS + axis]));
        }
    }
    (void)snprintf(title, sizeof title,
                   "All errors together: each up to %.1f %% of its own width, up or down",
                   budget->box.whole > 0 ? 100.0 * (double)budget->box.share / (double)budget->box.whole : 0);
    wh_print_titled(&table->frame, title, grid);
}

static uint64_t sum_of(const uint64_t tried[WH_BOX_KINDS]) {
    uint64_t sum = 0;
    for (size_t kind = 0; kind < WH_BOX_KINDS; ++kind) {
        sum += tried[kind];
    }
    return sum;
}

static void print_counts(const table_t *table, const uint64_t tried[WH_BOX_KINDS]) {
    static const char *const texts[WH_BOX_KINDS] = {
        "corners alike at all stations", "opposite at every other one",
        "of one station alone",          "by chance",
        "points inside by chance",       "corners beside the one that fails first"};
    size_t told = 0;
    for (size_t kind = 0; kind < WH_BOX_KINDS; ++kind) {
        if (tried[kind] > 0) {
            fprintf(table->frame.out, "%s%llu %s",
                    told == 0   ? ""
                    : told == 3 ? ",\n"
                                : ", ",
                    (unsigned long long)tried[kind], texts[kind]);
            ++told;
        }
    }
}

static void print_tried(const table_t *table) {
    const wh_budget_box_t *box = &table->budget->box;
    char count[WH_PRINT_NUMBER_SIZE];
    fprintf(table->frame.out, "\nno counterexample among %s trials of this box, which is no proof:\n",
            wh_print_count(count, (int64_t)sum_of(box->tried)));
    print_counts(table, box->tried);
    if (sum_of(box->tried_without) > 0) {
        fputs(";\nnot looking for collisions, ", table->frame.out);
        print_counts(table, box->tried_without);
    }
    fputc('\n', table->frame.out);
}

static void print_witnesses(const table_t *table) {
    const wh_budget_box_t *box = &table->budget->box;
    char why[WHY];
    if (box->outside) {
        name_failure(&box->why, why);
        fputs("just inside the box passes\n", table->frame.out);
        print_command(table, box->inside);
        wh_print_say(&table->frame, "just outside fails, with %s", why);
        fputc('\n', table->frame.out);
        print_command(table, box->outside);
    }
}

/* ------------------------------------------------------------------------------------------------ summary */

/* "A", "A and B", "A, B and 3 others": the stations that are like the tightest. */
static void print_alike(const table_t *table) {
    const wh_budget_t *budget = table->budget;
    const size_t tightest = (size_t)budget->tightest;
    size_t count = 1;
    size_t told = 1;
    for (size_t s = 0; s < budget->study->layout->station_count; ++s) {
        count += s != tightest && wh_budget_is_alike(budget, s, tightest) ? 1 : 0;
    }
    wh_print_say(&table->frame, "%s", station_name(table, tightest));
    for (size_t s = 0; s < budget->study->layout->station_count && told < 4; ++s) {
        if (s != tightest && wh_budget_is_alike(budget, s, tightest)) {
            ++told;
            wh_print_say(&table->frame, "%s%s", told == count ? " and " : ", ", station_name(table, s));
        }
    }
    if (count > told) {
        fprintf(table->frame.out, " and %zu others", count - told);
    }
}

/* "2.500 mm of z"; for angles also the distance at a wafer's rim. */
static void print_width(const table_t *table, size_t station) {
    const wh_budget_t *budget = table->budget;
    const size_t axis = wh_budget_tightest_axis(budget, station);
    fprintf(table->frame.out, "%.3f %s of %s", number_of(budget->stations[station].errors[axis].width),
            unit_of(axis), wh_errors_teaching_name(axis));
    if (axis >= 3) {
        fprintf(table->frame.out, " (%.3f mm at a wafer's rim)", wh_budget_tightness(budget, station));
    }
}

static void print_cause(const table_t *table) {
    const wh_budget_t *budget = table->budget;
    const size_t station = (size_t)budget->tightest;
    const wh_budget_error_t *error =
        &budget->stations[station].errors[wh_budget_tightest_axis(budget, station)];
    const wh_budget_why_t *why = &error->sides[tight_way(error)].why;
    char name[WHY];
    name_failure(why, name);
    wh_print_say(&table->frame, "Beyond that the run fails: %s%s%s", name, why->text[0] ? ": " : "",
                 why->text);
    fputc('\n', table->frame.out);
}

/* Prints warnings that the numbers do not show. */
static void print_warnings(const table_t *table) {
    const wh_budget_t *budget = table->budget;
    if (!budget->study->layout->collision) {
        fputs("\n! " WH_RECORD_UNLOOKED "\n", table->frame.out);
    }
    if (wh_study_has_noise(budget->study)) {
        fputs("\n! sensors have noise: one sample of it was used, the same in all trials\n",
              table->frame.out);
    }
    if (budget->caught) {
        fputs("\n! in trials that passed, the script caught errors: what it then does counts as passing\n",
              table->frame.out);
    }
}

/* Says which station must be taught better: the last line. */
static void print_answer(const table_t *table) {
    const wh_budget_t *budget = table->budget;
    FILE *out = table->frame.out;
    fputc('\n', out);
    if (budget->tightest == WH_NONE) {
        fprintf(out, "No station needs better teaching: nothing up to %g mm and %g deg makes the run fail\n",
                number_of(budget->options.most[0]), number_of(budget->options.most[1]));
        return;
    }
    wh_print_say(&table->frame, "The tightest error is %s of %s: ",
                 wh_errors_teaching_name(wh_budget_tightest_axis(budget, (size_t)budget->tightest)),
                 station_name(table, (size_t)budget->tightest));
    print_width(table, (size_t)budget->tightest);
    fputs(". ", out);
    print_cause(table);
    fputs("Teach ", out);
    print_alike(table);
    fputs(" best, up to ", out);
    print_width(table, (size_t)budget->tightest);
    if (budget->next != WH_NONE) {
        wh_print_say(&table->frame, "; the next is %s with ", station_name(table, (size_t)budget->next));
        print_width(table, (size_t)budget->next);
    }
    fputc('\n', out);
}

static void print_capped(const table_t *table) {
    const size_t count = wh_budget_capped(table->budget);
    if (count > 0) {
        fprintf(
            table->frame.out,
            "\n! %zu error%s passed up to the limit, which is less than the least below, and may allow less: "
            "--limit and --limit-deg go farther\n",
            count, count == 1 ? "" : "s");
    }
}

/* Errors without any width: the script has nothing to spare there. */
static void print_zeros(const table_t *table) {
    const wh_budget_t *budget = table->budget;
    const char *before = "\n! no width at all, for it fails 0.001 beside where it was taught: ";
    for (size_t i = 0; i < WH_SPREADS * budget->study->layout->station_count; ++i) {
        const wh_budget_station_t *station = &budget->stations[i / WH_SPREADS];
        const wh_budget_error_t *error = &station->errors[i % WH_SPREADS];
        if (station->wanted && error->known && error->width == 0) {
            fputs(before, table->frame.out);
            wh_print_say(&table->frame, "%s of %s", wh_errors_teaching_name(i % WH_SPREADS),
                         station_name(table, i / WH_SPREADS));
            before = ", ";
        }
    }
    if (strcmp(before, ", ") == 0) {
        fputc('\n', table->frame.out);
    }
}

static void print_incomplete(const table_t *table) {
    const wh_budget_t *budget = table->budget;
    size_t known = 0;
    size_t wanted = 0;
    for (size_t i = 0; i < WH_SPREADS * budget->study->layout->station_count; ++i) {
        const wh_budget_station_t *station = &budget->stations[i / WH_SPREADS];
        wanted += station->wanted ? 1 : 0;
        known += station->wanted && station->errors[i % WH_SPREADS].known ? 1 : 0;
    }
    fprintf(
        table->frame.out,
        "\n! incomplete, for it was interrupted: %zu of %zu errors are known, and not how they go together\n",
        known, wanted);
}

int wh_budget_print_table(const wh_budget_t *budget, FILE *out, const wh_style_t *style) {
    const table_t table = {budget, {&budget->study->nominal.record, style, out}};
    wh_print_say(&table.frame, "%s on %s", budget->study->run.script, budget->study->layout->path);
    fputc('\n', out);
    print_errors(&table);
    if (budget->incomplete) {
        print_zeros(&table);
        print_incomplete(&table);
        return ferror(out) ? -1 : 0;
    }
    print_how(&table);
    print_first(&table);
    print_half(&table);
    print_tried(&table);
    print_witnesses(&table);
    print_warnings(&table);
    print_zeros(&table);
    print_capped(&table);
    print_answer(&table);
    return ferror(out) ? -1 : 0;
}
