#include "sweep_print.h"

#include <math.h>
#include <string.h>

#include "../text/grid.h"
#include "../text/json.h"

static const char *const verdicts[] = {"ok", "failed", "bad"};

size_t wh_sweep_count(const wh_script_sweep_t *sweep, wh_sweep_verdict_t verdict) {
    size_t count = 0;
    for (size_t i = 0; i < sweep->point_count; ++i) {
        count += sweep->points[i].verdict == verdict ? 1 : 0;
    }
    return count;
}

/* -------------------------------------------------------------------------------------------------- table */

static void add_row(const wh_script_sweep_t *sweep, wh_grid_t *grid, size_t i) {
    const wh_sweep_point_t *point = &sweep->points[i];
    const double figures[] = {point->simulated_s, point->wafers_per_hour, point->projz, point->projxy,
                              point->gap};
    const size_t first = sweep->axis_count;
    wh_grid_row(grid);
    for (size_t axis = 0; axis < sweep->axis_count; ++axis) {
        wh_grid_number(grid, axis, WH_INK_PLAIN, wh_sweep_value(sweep, i, axis));
    }
    wh_grid_text(grid, first, point->verdict == WH_SWEEP_OK ? WH_INK_GOOD : WH_INK_BAD, "%s",
                 verdicts[point->verdict]);
    for (size_t k = 0; k < sizeof figures / sizeof figures[0]; ++k) {
        if (isfinite(figures[k])) {
            wh_grid_number(grid, first + 1 + k, WH_INK_PLAIN, figures[k]);
        }
    }
    if (point->reason) {
        wh_grid_text(grid, first + 6, WH_INK_PLAIN, "%s", point->reason);
    }
}

/* The run that is ok and has most wafers per hour, or else takes least time; point_count if none is ok. */
static size_t find_best(const wh_script_sweep_t *sweep) {
    size_t best = sweep->point_count;
    for (size_t i = 0; i < sweep->point_count; ++i) {
        const wh_sweep_point_t *point = &sweep->points[i];
        const wh_sweep_point_t *before = best < sweep->point_count ? &sweep->points[best] : NULL;
        const bool is_faster = before && isfinite(point->wafers_per_hour) && isfinite(before->wafers_per_hour)
                                   ? point->wafers_per_hour > before->wafers_per_hour
                                   : before && point->simulated_s < before->simulated_s;
        if (point->verdict == WH_SWEEP_OK && (!before || is_faster)) {
            best = i;
        }
    }
    return best;
}

static void print_best(const wh_script_sweep_t *sweep, FILE *out) {
    const size_t best = find_best(sweep);
    if (best == sweep->point_count) {
        return;
    }
    fputs("the fastest of them:", out);
    for (size_t axis = 0; axis < sweep->axis_count; ++axis) {
        char value[WH_SWEEP_VALUE];
        wh_sweep_text(wh_sweep_value(sweep, best, axis), value);
        fprintf(out, " --set %s=%s", sweep->axes[axis].name, value);
    }
    fprintf(out, ", %.3f s simulated\n", sweep->points[best].simulated_s);
}

int wh_sweep_print_table(const wh_script_sweep_t *sweep, FILE *out, const wh_style_t *style) {
    const size_t ok = wh_sweep_count(sweep, WH_SWEEP_OK);
    char columns[400] = "";
    for (size_t axis = 0; axis < sweep->axis_count; ++axis) {
        const size_t length = strlen(columns);
        (void)snprintf(columns + length, sizeof columns - length, "%s%.40s{0,12}", axis > 0 ? ";" : "",
                       sweep->axes[axis].name);
    }
    wh_grid_t *grid = wh_grid_new(style, sweep->axis_count, columns);
    wh_grid_columns(grid, "result;simulated s{3};wafers/h{1};|dr_proj_z|{4};|dr_proj_xy|{4};gap mm{3};why");
    for (size_t i = 0; i < sweep->point_count; ++i) {
        add_row(sweep, grid, i);
    }
    wh_style_put(out, sweep->run.script);
    fputs("\n\n", out);
    wh_grid_print(grid, out);
    fputc('\n', out);
    wh_style_print(style, out, ok == sweep->point_count ? WH_INK_GOOD : WH_INK_BAD, "%zu of %zu runs ok", ok,
                   sweep->point_count);
    fputc('\n', out);
    print_best(sweep, out);
    return ferror(out) ? -1 : 0;
}

/* --------------------------------------------------------------------------------------------------- JSON */

static json_t *axis(const void *subject, size_t i) {
    const wh_sweep_axis_t *of = &((const wh_script_sweep_t *)subject)->axes[i];
    return wh_json_set(json_object(), "name %s start %g step %g count %lld", of->name, of->start, of->step,
                       (json_int_t)of->count);
}

static json_t *run(const void *subject, size_t i) {
    const wh_script_sweep_t *sweep = subject;
    const wh_sweep_point_t *point = &sweep->points[i];
    json_t *values = json_array();
    for (size_t k = 0; k < sweep->axis_count; ++k) {
        wh_json_append(values, wh_json_real(wh_sweep_value(sweep, i, k)));
    }
    json_t *object = wh_json_add(json_object(), "values", values, NULL);
    (void)wh_json_set(object,
                      "verdict %s reason %s simulated_s %g wafers_per_hour %g dr_proj_z %g dr_proj_xy %g "
                      "gap %g",
                      verdicts[point->verdict], point->reason, point->simulated_s, point->wafers_per_hour,
                      point->projz, point->projxy, point->gap);
    return wh_json_add(object, "hash",
                       point->verdict == WH_SWEEP_BAD ? json_null() : wh_json_hash(point->hash), NULL);
}

int wh_sweep_print_json(const wh_script_sweep_t *sweep, FILE *out) {
    json_t *root = wh_json_set(json_object(), "format %d ok %i script %s", 1,
                               wh_sweep_count(sweep, WH_SWEEP_OK) == sweep->point_count, sweep->run.script);
    wh_json_put(root, "axes", wh_json_list(axis, sweep, sweep->axis_count));
    wh_json_put(root, "runs", wh_json_list(run, sweep, sweep->point_count));
    const int status = wh_json_print(root, out);
    json_decref(root);
    return status;
}
