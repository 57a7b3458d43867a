/* A study's result as tables. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../math/trig.h"
#include "print_internal.h"
#include "study_causes.h"
#include "study_print.h"

/* The parts of the run's result that are useful here take its frame. */
typedef struct {
    const wh_study_result_t *study;
    const wh_tally_t *tally;
    wh_printer_t frame;
} table_t;

bool wh_study_is_kept(const wh_study_result_t *result) {
    const wh_confidence_t success = wh_wilson_interval(result->tally->met, result->tally->trials);
    return success.low >= result->require;
}

void wh_study_expected(const char *text, char *expected, size_t size) {
    static const char *const found[] = {"; found dX ", "; it lies in ", "; at the script's end "};
    size_t length = strlen(text);
    for (size_t i = 0; i < sizeof found / sizeof found[0]; ++i) {
        const char *at = strstr(text, found[i]);
        length = at ? (size_t)(at - text) : length;
    }
    snprintf(expected, size, "%.*s", (int)length, text);
}

double wh_study_nominal(const wh_study_wafer_t *wafer, size_t q) {
    const double values[] = {wafer->place.dx, wafer->place.dy, wafer->place.dz,
                             wh_deg_from_rad(wafer->place.tilt), 0};
    return values[q];
}

/* -------------------------------------------------------------------------------------------------- rates */

/* In percent, with its interval. */
static void put_rate(wh_grid_t *grid, size_t column, wh_ink_t ink, uint64_t hits, uint64_t trials) {
    const wh_confidence_t rate = wh_wilson_interval(hits, trials);
    wh_grid_number(grid, column, ink, 100 * rate.rate);
    wh_grid_text(grid, column + 1, WH_INK_DIM, "%.4f to %.4f", 100 * rate.low, 100 * rate.high);
}

static void put_trial(wh_grid_t *grid, size_t column, uint64_t trial) {
    if (trial != WH_TALLY_NO_TRIAL) {
        wh_grid_number(grid, column, WH_INK_PLAIN, (double)trial);
    }
}

static void print_expectations(const table_t *table) {
    wh_grid_t *grid =
        wh_grid_new(table->frame.style, 2, "line{0};expected;seen{0};met{0};%{2,4};95 %;first missed{0}");
    for (size_t i = 0; i < table->tally->expectations.count; ++i) {
        const wh_tally_row_t *row = &table->tally->expectations.rows[i];
        char expected[200];
        if (!wh_tally_is_told(row)) {
            continue;
        }
        wh_study_expected(row->text, expected, sizeof expected);
        wh_grid_row(grid);
        wh_grid_number(grid, 0, WH_INK_PLAIN, row->line);
        wh_grid_text(grid, 1, WH_INK_PLAIN, "%s", expected);
        wh_grid_number(grid, 2, WH_INK_PLAIN, (double)row->seen);
        wh_grid_number(grid, 3, row->bad > 0 ? WH_INK_BAD : WH_INK_GOOD, (double)(row->seen - row->bad));
        put_rate(grid, 4, WH_INK_PLAIN, row->seen - row->bad, row->seen);
        put_trial(grid, 6, row->first);
    }
    wh_print_titled(&table->frame, "Expectations", grid);
}

static void print_errors(const table_t *table) {
    wh_grid_t *grid =
        wh_grid_new(table->frame.style, 2, "line{0};command;error;trials{0};%{2,4};95 %;first{0}");
    for (size_t i = 0; i < table->tally->errors.count; ++i) {
        const wh_tally_row_t *row = &table->tally->errors.rows[i];
        wh_grid_row(grid);
        wh_grid_number(grid, 0, WH_INK_PLAIN, row->line);
        wh_grid_text(grid, 1, WH_INK_PLAIN, "%s", row->text);
        wh_grid_text(grid, 2, WH_INK_BAD, "%d %s", row->place, wh_status_name((wh_status_t)row->place));
        wh_grid_number(grid, 3, WH_INK_PLAIN, (double)row->bad);
        put_rate(grid, 4, WH_INK_PLAIN, row->bad, table->tally->trials);
        put_trial(grid, 6, row->first);
    }
    wh_print_titled(&table->frame, "Errors of commands", grid);
}

static void print_events(const table_t *table) {
    wh_grid_t *grid = wh_grid_new(table->frame.style, 1, "event;trials{0};%{2,4};95 %;all in all{0}");
    for (size_t kind = 0; kind < WH_EVENT_KINDS; ++kind) {
        const wh_tally_event_t *event = &table->tally->events[kind];
        if (event->trials > 0) {
            const bool bad = wh_print_is_complaint((wh_event_kind_t)kind);
            wh_grid_row(grid);
            wh_grid_text(grid, 0, bad ? WH_INK_BAD : WH_INK_PLAIN, "%s",
                         wh_event_name((wh_event_kind_t)kind));
            wh_grid_number(grid, 1, WH_INK_PLAIN, (double)event->trials);
            put_rate(grid, 2, WH_INK_PLAIN, event->trials, table->tally->trials);
            wh_grid_number(grid, 4, WH_INK_PLAIN, (double)event->total);
        }
    }
    wh_print_titled(&table->frame, "Events", grid);
}

/* ------------------------------------------------------------------------------------------------- wafers */

static void add_quantity(wh_grid_t *grid, const wh_study_wafer_t *wafer, const wh_sum_t *sum, size_t q) {
    static const char *const names[] = {"dX mm", "dY mm", "dz mm", "tilt deg", "off mm"};
    static const uint32_t permille[] = {1, 50, 500, 950, 999};
    const double nominal = wh_study_nominal(wafer, q);
    wh_grid_text(grid, 2, WH_INK_PLAIN, "%s", names[q]);
    wh_grid_number(grid, 3, WH_INK_PLAIN, nominal + wh_sum_mean(sum));
    wh_grid_number(grid, 4, WH_INK_PLAIN, wh_sum_deviation(sum));
    wh_grid_number(grid, 5, WH_INK_PLAIN, nominal + wh_sum_least(sum));
    for (size_t i = 0; i < sizeof permille / sizeof permille[0]; ++i) {
        wh_grid_number(grid, 6 + i, WH_INK_PLAIN, nominal + wh_sum_quantile(sum, permille[i]));
    }
    wh_grid_number(grid, 11, WH_INK_PLAIN, nominal + wh_sum_most(sum));
}

static void add_wafer(const table_t *table, wh_grid_t *grid, size_t index) {
    const wh_study_wafer_t *wafer = &table->study->study->wafers[index];
    const wh_tally_wafer_t *tally = &table->tally->wafers[index];
    const wh_layout_t *layout = table->study->study->layout;
    for (size_t q = 0; q < WH_TALLY_QUANTITIES && tally->of[q].count > 0; ++q) {
        wh_grid_row(grid);
        if (q == 0) {
            wh_grid_text(grid, 0, WH_INK_PLAIN, "%s", layout->wafers[wafer->wafer].name);
            wh_grid_text(grid, 1, WH_INK_PLAIN, "%s %d", layout->stations[wafer->place.station].name,
                         wafer->place.slot);
        }
        add_quantity(grid, wafer, &tally->of[q], q);
    }
}

static void print_wafers(const table_t *table) {
    const wh_study_t *study = table->study->study;
    wh_grid_t *grid =
        wh_grid_new(table->frame.style, 3,
                    "wafer;in;what;mean{4};deviation{4};min{4};0.1 %{4};5 %{4};50 %{4};95 %{4};99.9 %{4};"
                    "max{4}");
    for (size_t w = 0; w < table->tally->wafer_count; ++w) {
        add_wafer(table, grid, w);
    }
    wh_print_titled(&table->frame, "Wafers at the end", grid);
    for (size_t w = 0; w < table->tally->wafer_count; ++w) {
        const wh_tally_wafer_t *tally = &table->tally->wafers[w];
        if (tally->elsewhere > 0) {
            char count[WH_PRINT_NUMBER_SIZE];
            wh_print_say(&table->frame, "%s ends elsewhere in %s trial%s, which are not in these figures",
                         study->layout->wafers[study->wafers[w].wafer].name,
                         wh_print_count(count, (int64_t)tally->elsewhere), tally->elsewhere == 1 ? "" : "s");
            fputc('\n', table->frame.out);
        }
    }
}

/* --------------------------------------------------------------------------------------------------- flow */

/* A value between the least and the most, whatever its bin. */
static double within(double value, const wh_flow_spread_t *spread) {
    return value < spread->least ? spread->least : value > spread->most ? spread->most : value;
}

static void add_figure(const table_t *table, wh_grid_t *grid, wh_flow_sum_t figure) {
    static const char *const names[WH_FLOW_SUM_FIGURES] = {"makespan s",    "cycle s",       "wafers/h",
                                                           "robots wait s", "wafers wait s", "late stays"};
    static const uint32_t permille[] = {1, 50, 500, 950, 999};
    const wh_flow_sums_t *flow = table->tally->flow;
    const double *without = table->study->study->flow;
    if (flow->of[figure].count == 0) {
        return;
    }
    const wh_flow_spread_t spread = wh_flow_sums_spread(flow, figure, without);
    wh_grid_named_row(grid, names[figure]);
    if (!isnan(without[figure])) {
        wh_grid_number(grid, 1, WH_INK_PLAIN, without[figure]);
    }
    wh_grid_number(grid, 2, WH_INK_PLAIN, spread.mean);
    wh_grid_number(grid, 3, WH_INK_PLAIN, spread.deviation);
    wh_grid_number(grid, 4, WH_INK_PLAIN, spread.least);
    for (size_t i = 0; i < sizeof permille / sizeof permille[0]; ++i) {
        wh_grid_number(grid, 5 + i, WH_INK_PLAIN,
                       within(wh_flow_sums_quantile(flow, figure, without, permille[i]), &spread));
    }
    wh_grid_number(grid, 10, WH_INK_PLAIN, spread.most);
}

/* Trials that are in none of these figures. */
static void print_left_out(const table_t *table, uint64_t count, const char *one, const char *many) {
    char text[WH_PRINT_NUMBER_SIZE];
    if (count > 0) {
        fprintf(table->frame.out, "%s of %s\n", wh_print_count(text, (int64_t)count),
                count == 1 ? one : many);
    }
}

static void print_flow(const table_t *table) {
    const wh_flow_sums_t *flow = table->tally->flow;
    if (!flow) {
        return;
    }
    wh_grid_t *grid =
        wh_grid_new(table->frame.style, 1,
                    "flow;without errors{3};mean{3};deviation{3};min{3};0.1 %{3};5 %{3};50 %{3};"
                    "95 %{3};99.9 %{3};max{3}");
    for (int i = 0; i < WH_FLOW_SUM_FIGURES; ++i) {
        add_figure(table, grid, (wh_flow_sum_t)i);
    }
    wh_print_titled(&table->frame, "The flow", grid);
    print_left_out(table, flow->unfinished,
                   "the trials did not bring all wafers to their ends, and is not in the makespan",
                   "the trials did not bring all wafers to their ends, and are not in the makespan");
    print_left_out(table, flow->unsteady,
                   "the trials has no steady cycle: its mean over the middle third of the wafers counts",
                   "the trials have no steady cycle: their means over the middle third of the wafers count");
    print_left_out(table, flow->no_cycle,
                   "the trials has too few wafers for a cycle, and is in neither it nor the rate",
                   "the trials have too few wafers for a cycle, and are in neither it nor the rate");
    print_left_out(table, flow->clipped, "the trials drew a process shorter than 0 s, which took none",
                   "the trials drew a process shorter than 0 s, which took none");
}

/* ------------------------------------------------------------------------------------------------- causes */

/* The most drawn errors that are told. */
#define MOST_CAUSES 8

static void put_correlation(wh_grid_t *grid, size_t column, const wh_correlation_t *found) {
    char r[WH_GRID_NUMBER_SIZE];
    char low[WH_GRID_NUMBER_SIZE];
    char high[WH_GRID_NUMBER_SIZE];
    if (!found->determined) {
        wh_grid_text(grid, column, WH_INK_DIM, "not determined");
        return;
    }
    const bool is_sure = found->low > 0 || found->high < 0;
    wh_grid_format(r, sizeof r, found->r, 2);
    wh_grid_format(low, sizeof low, found->low, 2);
    wh_grid_format(high, sizeof high, found->high, 2);
    wh_grid_text(grid, column, is_sure ? WH_INK_PLAIN : WH_INK_DIM, "%s (%s to %s)", r, low, high);
}

static void add_cause(const table_t *table, wh_grid_t *grid, const wh_cause_told_t *told) {
    static const char *const quantities[] = {"dX", "dY", "dz", "tilt", "off"};
    static const char *const figures[] = {"makespan", "cycle", "wafers/h"};
    const wh_study_t *study = table->study->study;
    char name[WH_CAUSE_NAME];
    wh_cause_name(told->cause, study->layout, name);
    wh_grid_row(grid);
    wh_grid_text(grid, 0, WH_INK_PLAIN, "%s", name);
    put_correlation(grid, 1, &told->by_size);
    if (wh_cause_has_sign(told->cause)) {
        put_correlation(grid, 2, &told->by_value);
    }
    put_correlation(grid, 3, &told->end);
    if (told->end.determined && told->is_flow) {
        wh_grid_text(grid, 4, WH_INK_PLAIN, "%s", figures[told->quantity]);
    } else if (told->end.determined) {
        wh_grid_text(grid, 4, WH_INK_PLAIN, "%s %s",
                     study->layout->wafers[study->wafers[told->wafer].wafer].name,
                     quantities[told->quantity]);
    }
}

/* Says how many drawn errors are left out. */
static void print_aside(const wh_study_t *study, FILE *out) {
    const size_t aside = study->drawn_count - study->cause_count;
    if (aside > 0) {
        fprintf(out, "%zu drawn error%s left out: the run without errors neither moves nor goes to what %s\n",
                aside, aside == 1 ? " is" : "s are", aside == 1 ? "it is of" : "they are of");
    }
}

static void print_causes(const table_t *table) {
    const size_t count = table->study->study->cause_count;
    wh_cause_told_t *told = wh_causes_told(table->study);
    wh_grid_t *grid = wh_grid_new(table->frame.style, 1,
                                  "drawn;failing with its size;with its value;strongest at the end;of");
    for (size_t i = 0; i < count && i < MOST_CAUSES; ++i) {
        add_cause(table, grid, &told[i]);
    }
    free(told);
    wh_print_titled(&table->frame, "Which error costs most: correlations, all together 95 % sure", grid);
    if (table->tally->met == table->tally->trials || table->tally->met == 0) {
        fprintf(table->frame.out, "%s of the trials failed, so nothing tells what failing goes with\n",
                table->tally->met == 0 ? "all" : "none");
    }
    if (count > MOST_CAUSES) {
        fprintf(table->frame.out, "and %zu more, which --json tells\n", count - MOST_CAUSES);
    }
    print_aside(table->study->study, table->frame.out);
}

/* -------------------------------------------------------------------------------------------------- worst */

/* How bad it is: how far a wafer ends off; of times alone how long the flow took. */
static void put_far(wh_grid_t *grid, size_t column, const wh_tally_trial_t *trial, const wh_study_t *study) {
    const double makespan_s = trial->flow[WH_FLOW_SUM_MAKESPAN];
    if (study->layout->tool && isnan(makespan_s)) {
        wh_grid_text(grid, column, WH_INK_PLAIN, "no end");
    } else if (study->layout->tool) {
        wh_grid_number(grid, column, WH_INK_PLAIN, makespan_s);
    } else if (trial->off <= 1e300) {
        wh_grid_number(grid, column, WH_INK_PLAIN, trial->off);
    } else {
        wh_grid_text(grid, column, WH_INK_PLAIN, "elsewhere");
    }
}

static void print_worst(const table_t *table) {
    wh_grid_t *grid = wh_grid_new(table->frame.style, 1,
                                  table->study->study->layout->tool ? "trial{0};result;makespan s{3};why"
                                                                    : "trial{0};result;off mm{4};why");
    const size_t count =
        table->study->worst < table->tally->worst_count ? table->study->worst : table->tally->worst_count;
    for (size_t i = 0; i < count; ++i) {
        const wh_tally_trial_t *trial = &table->tally->worst[i];
        char why[WH_TRIAL_LINE_WHY];
        wh_grid_row(grid);
        wh_grid_number(grid, 0, WH_INK_PLAIN, (double)trial->trial);
        wh_grid_text(grid, 1, trial->met ? WH_INK_GOOD : WH_INK_BAD, "%s", trial->met ? "ok" : "failed");
        put_far(grid, 2, trial, table->study->study);
        wh_trial_line_why(trial, why, sizeof why);
        wh_grid_text(grid, 3, WH_INK_PLAIN, "%s", why);
    }
    wh_print_titled(&table->frame, "Worst trials", grid);
}

/* ------------------------------------------------------------------------------------------------- around */

static void print_head(const table_t *table) {
    const wh_study_t *study = table->study->study;
    wh_print_say(&table->frame, "%s on %s", study->run.script, study->layout->path);
    fputc('\n', table->frame.out);
    wh_print_counted(table->frame.out, (int64_t)table->tally->trials, "trial", "trials");
    fprintf(table->frame.out, " of seed %llu\n", (unsigned long long)study->seed);
    if (!study->nominal.record.ok) {
        wh_style_print(table->frame.style, table->frame.out, WH_INK_WARN,
                       "without any errors the script fails already");
        fputc('\n', table->frame.out);
    }
}

static void print_how(const table_t *table) {
    const wh_study_t *study = table->study->study;
    if (wh_study_is_of_noise(study)) {
        wh_style_print(
            table->frame.style, table->frame.out, WH_INK_WARN,
            "no error is drawn: the trials differ in the noise of sensors alone, if the script asks them");
        fputc('\n', table->frame.out);
    }
    if (study->layout->tool) {
        fputs("each trial played its flow by times of its own\n", table->frame.out);
    } else if (study->whole) {
        fprintf(table->frame.out,
                "each trial ran the script whole, for in the run without errors this was read: %s\n",
                study->whole);
    } else {
        wh_print_counted(table->frame.out, (int64_t)table->tally->whole, "trial", "trials");
        fputs(" ran the script whole, the others are the run without errors, replayed\n", table->frame.out);
    }
}

static void print_alone(const table_t *table) {
    if (table->study->study->nominal.record.times_alone) {
        fprintf(table->frame.out, "! %s: " WH_RECORD_SOME_ALONE "\n",
                table->study->study->nominal.record.times_alone);
    }
}

static void print_unlooked(const table_t *table) {
    if (table->study->study->layout->tool) {
        fputs("! " WH_RECORD_TIMES_ALONE "\n", table->frame.out);
    } else if (!table->study->study->layout->collision) {
        fputs("! " WH_RECORD_UNLOOKED "\n", table->frame.out);
    }
}

/* Prints warnings that the rate does not show. */
static void print_warnings(const table_t *table) {
    const wh_trial_lines_t *lines = &table->tally->lines;
    const char *never_came = table->study->study->nominal.record.never_came;
    size_t caught = 0;
    for (size_t i = 0; i < lines->count; ++i) {
        caught += lines->lines[i].met && lines->lines[i].errors > 0 ? 1 : 0;
    }
    print_unlooked(table);
    print_alone(table);
    if (never_came) {
        fprintf(table->frame.out, "! never came in the run without errors, and so were not tried: %s\n",
                never_came);
    }
    if (caught > 0) {
        fprintf(table->frame.out, "! in %zu trial%s that count%s as ok the script caught errors%s\n", caught,
                caught == 1 ? "" : "s", caught == 1 ? "s" : "",
                lines->count < table->tally->trials ? " (of the first ones, which are known one by one)"
                                                    : "");
    }
}

static void print_summary(const table_t *table) {
    const wh_study_result_t *result = table->study;
    const wh_confidence_t success = wh_wilson_interval(table->tally->met, table->tally->trials);
    FILE *out = table->frame.out;
    const bool is_one = table->tally->trials == 1;
    char met[WH_PRINT_NUMBER_SIZE];
    char trials[WH_PRINT_NUMBER_SIZE];
    fputc('\n', out);
    print_how(table);
    if (!result->study->has_flow) {
        fputs("without errors: ", out);
        (void)wh_print_figure(&table->frame);
        fputc('\n', out);
    }
    wh_style_print(table->frame.style, out,
                   table->tally->met == table->tally->trials ? WH_INK_GOOD : WH_INK_BAD,
                   "%s of %s trial%s ok", wh_print_count(met, (int64_t)table->tally->met),
                   wh_print_count(trials, (int64_t)table->tally->trials), is_one ? "" : "s");
    fprintf(out, ": %.4f %%, 95 %% sure from %.4f to %.4f %% (Wilson)\n", 100 * success.rate,
            100 * success.low, 100 * success.high);
    if (result->require > 0) {
        const bool kept = wh_study_is_kept(result);
        wh_style_print(table->frame.style, out, kept ? WH_INK_GOOD : WH_INK_BAD, "%s",
                       kept ? "the required " : "not the required ");
        fprintf(out, "%.10g %%\n", 100 * result->require);
    }
    print_warnings(table);
    if (table->tally->worst_count > 0 && result->worst > 0) {
        fprintf(out, "--trial %llu --seed %llu plays the worst one\n",
                (unsigned long long)table->tally->worst[0].trial, (unsigned long long)result->study->seed);
    }
}

int wh_study_print_table(const wh_study_result_t *result, FILE *out, const wh_style_t *style) {
    const table_t table = {result, result->tally, {&result->study->nominal.record, style, out}};
    print_head(&table);
    print_expectations(&table);
    print_errors(&table);
    print_events(&table);
    print_wafers(&table);
    print_flow(&table);
    print_causes(&table);
    print_worst(&table);
    print_summary(&table);
    return ferror(out) ? -1 : 0;
}
