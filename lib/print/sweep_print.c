#include "sweep_print.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "../text/array.h"
#include "../text/grid.h"
#include "../text/json.h"
#include "unlooked.h"

static const char *const verdicts[] = {"ok", "failed", "undone", "bad"};

size_t wh_sweep_count(const wh_script_sweep_t *sweep, wh_sweep_verdict_t verdict) {
    size_t count = 0;
    for (size_t i = 0; i < sweep->point_count; ++i) {
        count += sweep->points[i].verdict == verdict ? 1 : 0;
    }
    return count;
}

/* -------------------------------------------------------------------------------------------------- table */

static const struct {
    const char *heading;
    size_t offset; /* of the figure in a point */
} figures[] = {{";simulated s{3}", offsetof(wh_sweep_point_t, simulated_s)},
               {";wafers/h{1}", offsetof(wh_sweep_point_t, wafers_per_hour)},
               {";|dr_proj_z|{4}", offsetof(wh_sweep_point_t, projz)},
               {";|dr_proj_xy|{4}", offsetof(wh_sweep_point_t, projxy)},
               {";gap mm{3}", offsetof(wh_sweep_point_t, gap)}};
#define FIGURES (sizeof figures / sizeof figures[0])

static double figure_of(const wh_sweep_point_t *point, size_t k) {
    double value;
    memcpy(&value, (const char *)point + figures[k].offset, sizeof value);
    return value;
}

/* Behind the figures come counts of what went wrong, and words: what is busiest, and why a run is not ok. */
enum { LATE = FIGURES, LOST, BUSIEST, WHY, COLUMNS };

static bool has(const wh_sweep_point_t *point, size_t k) {
    return k == LATE      ? point->late > 0
           : k == LOST    ? point->lost > 0
           : k == BUSIEST ? point->busiest != NULL
           : k == WHY     ? point->reason != NULL
                          : (bool)isfinite(figure_of(point, k));
}

/* True if any run has this. */
static bool has_any(const wh_script_sweep_t *sweep, size_t k) {
    bool any = false;
    for (size_t i = 0; i < sweep->point_count; ++i) {
        any = any || has(&sweep->points[i], k);
    }
    return any;
}

static wh_grid_t *new_grid(const wh_script_sweep_t *sweep, const wh_style_t *style,
                           const bool shown[COLUMNS]) {
    char columns[400] = "";
    wh_grid_t *grid = wh_grid_new(style, sweep->axis_count, NULL);
    for (size_t axis = 0; axis < sweep->axis_count; ++axis) {
        const size_t size = strlen(sweep->axes[axis].name) + sizeof "{0,12}";
        char *heading = wh_array_new(size, 1);
        (void)snprintf(heading, size, "%s%s", sweep->axes[axis].name,
                       sweep->axes[axis].words ? "" : "{0,12}");
        wh_grid_columns(grid, heading);
        free(heading);
    }
    size_t length = (size_t)snprintf(columns, sizeof columns, "result");
    for (size_t k = 0; k < FIGURES; ++k) {
        length += shown[k]
                      ? (size_t)snprintf(columns + length, sizeof columns - length, "%s", figures[k].heading)
                      : 0;
    }
    (void)snprintf(columns + length, sizeof columns - length, "%s%s%s%s", shown[LATE] ? ";too long{0}" : "",
                   shown[LOST] ? ";lost{0}" : "", shown[BUSIEST] ? ";busiest" : "", shown[WHY] ? ";why" : "");
    wh_grid_columns(grid, columns);
    return grid;
}

/* In a column that is shown if any run has such a count; 0 is left out. */
static void add_count(size_t count, wh_grid_t *grid, size_t *column, bool is_shown) {
    if (count > 0) {
        wh_grid_number(grid, *column, WH_INK_BAD, (double)count);
    }
    *column += is_shown ? 1 : 0;
}

/* The figures and words from a column on. */
static void add_figures(const wh_sweep_point_t *point, wh_grid_t *grid, size_t column,
                        const bool shown[COLUMNS]) {
    for (size_t k = 0; k < FIGURES; ++k) {
        if (isfinite(figure_of(point, k))) {
            wh_grid_number(grid, column, WH_INK_PLAIN, figure_of(point, k));
        }
        column += shown[k] ? 1 : 0;
    }
    add_count(point->late, grid, &column, shown[LATE]);
    add_count(point->lost, grid, &column, shown[LOST]);
    if (point->busiest) {
        wh_grid_text(grid, column, WH_INK_PLAIN, "%s", point->busiest);
    }
    column += shown[BUSIEST] ? 1 : 0;
    if (point->reason) {
        wh_grid_text(grid, column, WH_INK_PLAIN, "%s", point->reason);
    }
}

static void add_row(const wh_script_sweep_t *sweep, wh_grid_t *grid, size_t i, const bool shown[COLUMNS]) {
    const wh_sweep_point_t *point = &sweep->points[i];
    size_t column = 0;
    char text[WH_SWEEP_VALUE];
    wh_grid_row(grid);
    for (; column < sweep->axis_count; ++column) {
        if (sweep->axes[column].words) {
            wh_grid_text(grid, column, WH_INK_PLAIN, "%s", wh_sweep_word(sweep, i, column, text));
        } else {
            wh_grid_number(grid, column, WH_INK_PLAIN, wh_sweep_value(sweep, i, column));
        }
    }
    wh_grid_text(grid, column++, point->verdict == WH_SWEEP_OK ? WH_INK_GOOD : WH_INK_BAD, "%s",
                 verdicts[point->verdict]);
    add_figures(point, grid, column, shown);
}

/* True if each run that may be the fastest has a rate: then rates are compared, else times. */
static bool have_rates(const wh_script_sweep_t *sweep) {
    bool have = true;
    for (size_t i = 0; i < sweep->point_count; ++i) {
        have = have && (!wh_sweep_may_lead(&sweep->points[i]) || isfinite(sweep->points[i].wafers_per_hour));
    }
    return have;
}

/* The run with most wafers per hour, or else the one that takes least time; point_count if none may be it. */
static size_t find_best(const wh_script_sweep_t *sweep) {
    const bool by_rate = have_rates(sweep);
    size_t best = sweep->point_count;
    for (size_t i = 0; i < sweep->point_count; ++i) {
        const wh_sweep_point_t *point = &sweep->points[i];
        const wh_sweep_point_t *before = best < sweep->point_count ? &sweep->points[best] : NULL;
        const bool is_faster = !before   ? true
                               : by_rate ? point->wafers_per_hour > before->wafers_per_hour
                                         : point->simulated_s < before->simulated_s;
        if (wh_sweep_may_lead(point) && (by_rate || !point->is_cut) && is_faster) {
            best = i;
        }
    }
    return best;
}

static void print_best(const wh_script_sweep_t *sweep, FILE *out) {
    const size_t best = find_best(sweep);
    size_t left_out = 0;
    for (size_t i = 0; i < sweep->point_count; ++i) {
        const bool is_ok = sweep->points[i].verdict == WH_SWEEP_OK;
        left_out += is_ok && !wh_sweep_may_lead(&sweep->points[i]) ? 1 : 0;
    }
    if (best == sweep->point_count) {
        return;
    }
    fputs(left_out > 0 ? "the fastest of those that keep all wafers and windows, and are not cut:"
                       : "the fastest of them:",
          out);
    for (size_t axis = 0; axis < sweep->axis_count; ++axis) {
        char value[WH_SWEEP_VALUE];
        fprintf(out, " --set %s=%s", sweep->axes[axis].name, wh_sweep_word(sweep, best, axis, value));
    }
    fprintf(out, ", %.3f s simulated\n", sweep->points[best].simulated_s);
}

/* A range whose steps do not lead to its end. */
static void print_end(const wh_sweep_axis_t *axis, FILE *out) {
    const double last = axis->start + axis->step * (double)(axis->count - 1);
    if (!axis->words && fabs(last - axis->end) > 1e-9 * fabs(axis->step)) {
        char texts[2][WH_SWEEP_VALUE];
        wh_sweep_text(last, texts[0]);
        wh_sweep_text(axis->end, texts[1]);
        wh_style_put(out, "! ");
        wh_style_put(out, axis->name);
        fprintf(out, " goes up to %s, for its steps do not lead to %s\n", texts[0], texts[1]);
    }
}

static wh_print_unlooked_t count_unlooked(const wh_script_sweep_t *sweep) {
    wh_print_unlooked_t unlooked = {"! ", "run", 0, 0, 0, 0};
    for (size_t i = 0; i < sweep->point_count; ++i) {
        wh_print_unlooked_add(&unlooked, &sweep->points[i]);
    }
    return unlooked;
}

/* The faults that did not come, as the first such run tells them: other runs may miss others. */
static void print_never_came(const wh_script_sweep_t *sweep, FILE *out) {
    const char *first = NULL;
    size_t runs = 0;
    for (size_t i = 0; i < sweep->point_count; ++i) {
        const char *list = sweep->points[i].never_came;
        first = first ? first : list;
        runs += list ? 1 : 0;
    }
    if (first) {
        fprintf(out, "! never came in %zu run%s, and so were not tried%s: %s\n", runs, runs == 1 ? "" : "s",
                runs == 1 ? "" : ", in the first of them", first);
    }
}

static void print_loss(size_t count, const char *what, FILE *out) {
    if (count > 0) {
        fprintf(out, "! in %zu run%s that count%s as ok wafers %s\n", count, count == 1 ? "" : "s",
                count == 1 ? "s" : "", what);
    }
}

/* Runs that count as ok, and are not called the fastest all the same. */
static void print_losses(const wh_script_sweep_t *sweep, FILE *out) {
    size_t late = 0, lost = 0;
    for (size_t i = 0; i < sweep->point_count; ++i) {
        const bool is_ok = sweep->points[i].verdict == WH_SWEEP_OK;
        late += is_ok && sweep->points[i].late > 0 ? 1 : 0;
        lost += is_ok && sweep->points[i].lost > 0 ? 1 : 0;
    }
    print_loss(late, "stayed beyond their windows", out);
    print_loss(lost, "were lost", out);
}

/* Prints warnings that the rows do not show. */
static void print_warnings(const wh_script_sweep_t *sweep, FILE *out) {
    const wh_print_unlooked_t unlooked = count_unlooked(sweep);
    size_t caught = 0;
    for (size_t i = 0; i < sweep->point_count; ++i) {
        caught += sweep->points[i].caught ? 1 : 0;
    }
    wh_print_unlooked(&unlooked, out);
    print_losses(sweep, out);
    if (caught > 0) {
        fprintf(out, "! in %zu run%s that count as ok the script caught errors\n", caught,
                caught == 1 ? "" : "s");
    }
    print_never_came(sweep, out);
    for (size_t axis = 0; axis < sweep->axis_count; ++axis) {
        print_end(&sweep->axes[axis], out);
    }
}

int wh_sweep_print_table(const wh_script_sweep_t *sweep, FILE *out, const wh_style_t *style) {
    const size_t ok = wh_sweep_count(sweep, WH_SWEEP_OK);
    bool shown[COLUMNS];
    for (size_t k = 0; k < COLUMNS; ++k) {
        shown[k] = has_any(sweep, k);
    }
    wh_grid_t *grid = new_grid(sweep, style, shown);
    for (size_t i = 0; i < sweep->point_count; ++i) {
        if (sweep->points[i].verdict != WH_SWEEP_UNDONE) {
            add_row(sweep, grid, i, shown);
        }
    }
    wh_style_put(out, sweep->run.script);
    fputs("\n\n", out);
    wh_grid_print(grid, out);
    fputc('\n', out);
    wh_style_print(style, out, ok == sweep->point_count ? WH_INK_GOOD : WH_INK_BAD, "%zu of %zu runs ok", ok,
                   sweep->point_count);
    fputc('\n', out);
    print_best(sweep, out);
    print_warnings(sweep, out);
    return ferror(out) ? -1 : 0;
}

/* --------------------------------------------------------------------------------------------------- JSON */

static json_t *axis(const void *subject, size_t i) {
    const wh_sweep_axis_t *of = &((const wh_script_sweep_t *)subject)->axes[i];
    if (of->words) {
        json_t *words = json_array();
        for (size_t k = 0; k < of->count; ++k) {
            wh_json_append(words, wh_json_text(of->words[k]));
        }
        return wh_json_add(wh_json_set(json_object(), "name %s", of->name), "values", words, NULL);
    }
    return wh_json_set(json_object(), "name %s start %g step %g count %lld", of->name, of->start, of->step,
                       (json_int_t)of->count);
}

const char *wh_sweep_verdict(const wh_sweep_point_t *point) {
    return verdicts[point->verdict];
}

json_t *wh_sweep_put_run(const wh_sweep_point_t *point, json_t *object) {
    (void)wh_json_set(object,
                      "verdict %s reason %s simulated_s %g wafers_per_hour %g dr_proj_z %g dr_proj_xy %g "
                      "gap %g checked %i caught_errors %i",
                      verdicts[point->verdict], point->reason, point->simulated_s, point->wafers_per_hour,
                      point->projz, point->projxy, point->gap, point->checked, point->caught);
    if (point->busiest) {
        wh_json_put(object, "busiest", wh_json_text(point->busiest));
    }
    if (point->never_came) {
        wh_json_put(object, "never_came", wh_json_text(point->never_came));
    }
    if (point->is_cut) {
        wh_json_put(object, "cut", json_true());
    }
    if (point->late > 0) {
        wh_json_put(object, "late", json_integer((json_int_t)point->late));
    }
    if (point->lost > 0) {
        wh_json_put(object, "lost", json_integer((json_int_t)point->lost));
    }
    return wh_json_add(object, "hash",
                       point->verdict == WH_SWEEP_BAD ? json_null() : wh_json_hash(point->hash), NULL);
}

static json_t *run(const void *subject, size_t i) {
    const wh_script_sweep_t *sweep = subject;
    const wh_sweep_point_t *point = &sweep->points[i];
    if (point->verdict == WH_SWEEP_UNDONE) {
        return NULL;
    }
    json_t *values = json_array();
    for (size_t k = 0; k < sweep->axis_count; ++k) {
        char text[WH_SWEEP_VALUE];
        wh_json_append(values, sweep->axes[k].words ? wh_json_text(wh_sweep_word(sweep, i, k, text))
                                                    : wh_json_real(wh_sweep_value(sweep, i, k)));
    }
    return wh_sweep_put_run(point, wh_json_add(json_object(), "values", values, NULL));
}

int wh_sweep_print_json(const wh_script_sweep_t *sweep, FILE *out) {
    json_t *root = wh_json_set(json_object(), "format %d ok %i interrupted %i script %s", 1,
                               wh_sweep_count(sweep, WH_SWEEP_OK) == sweep->point_count,
                               wh_sweep_count(sweep, WH_SWEEP_UNDONE) > 0, sweep->run.script);
    wh_json_put(root, "axes", wh_json_list(axis, sweep, sweep->axis_count));
    wh_json_put(root, "runs", wh_json_list(run, sweep, sweep->point_count));
    const int status = wh_json_print(root, out);
    json_decref(root);
    return status;
}
