#include <math.h>

#include "../text/grid.h"
#include "sweep_print.h"
#include "unlooked.h"

/* -------------------------------------------------------------------------------------------------- table */

/* Behind the gain: stays beyond windows, and wafers lost, where any run has them. */
typedef struct {
    bool late, lost;
} shown_t;

static void add_row(wh_grid_t *grid, const char *name, const wh_sweep_point_t *point, double gain,
                    const shown_t *shown) {
    size_t column = 5;
    wh_grid_row(grid);
    wh_grid_text(grid, 0, WH_INK_PLAIN, "%s", name);
    wh_grid_text(grid, 1, point->verdict == WH_SWEEP_OK ? WH_INK_GOOD : WH_INK_BAD, "%s",
                 wh_sweep_verdict(point));
    if (isfinite(point->simulated_s)) {
        wh_grid_number(grid, 2, WH_INK_PLAIN, point->simulated_s);
    }
    if (isfinite(point->wafers_per_hour)) {
        wh_grid_number(grid, 3, WH_INK_PLAIN, point->wafers_per_hour);
    }
    if (isfinite(gain)) {
        wh_grid_number(grid, 4, WH_INK_PLAIN, 100 * gain);
    }
    if (point->late > 0) {
        wh_grid_number(grid, column, WH_INK_BAD, (double)point->late);
    }
    column += shown->late ? 1 : 0;
    if (point->lost > 0) {
        wh_grid_number(grid, column, WH_INK_BAD, (double)point->lost);
    }
    column += shown->lost ? 1 : 0;
    if (point->reason) {
        wh_grid_text(grid, column, WH_INK_PLAIN, "%s", point->reason);
    }
}

static shown_t find_shown(const wh_paces_t *paces) {
    shown_t shown = {paces->base.late > 0, paces->base.lost > 0};
    for (size_t i = 0; i < paces->count; ++i) {
        shown.late = shown.late || paces->paces[i].point.late > 0;
        shown.lost = shown.lost || paces->paces[i].point.lost > 0;
    }
    return shown;
}

static size_t count_ok(const wh_paces_t *paces) {
    size_t ok = paces->base.verdict == WH_SWEEP_OK ? 1 : 0;
    for (size_t i = 0; i < paces->count; ++i) {
        ok += paces->paces[i].point.verdict == WH_SWEEP_OK ? 1 : 0;
    }
    return ok;
}

static void print_unlooked(const wh_paces_t *paces, FILE *out) {
    wh_print_unlooked_t unlooked = {"! ", "run", 0, 0, 0, 0};
    wh_print_unlooked_add(&unlooked, &paces->base);
    for (size_t i = 0; i < paces->count; ++i) {
        wh_print_unlooked_add(&unlooked, &paces->paces[i].point);
    }
    wh_print_unlooked(&unlooked, out);
}

int wh_paces_print_table(const wh_paces_t *paces, FILE *out, const wh_style_t *style) {
    const size_t ok = count_ok(paces);
    const shown_t shown = find_shown(paces);
    wh_grid_t *grid = wh_grid_new(style, 1, NULL);
    wh_grid_columns(grid, "faster;result;simulated s{3};wafers/h{1};gain %{2}");
    wh_grid_columns(grid, shown.late && shown.lost ? "too long{0};lost{0};why"
                          : shown.late             ? "too long{0};why"
                          : shown.lost             ? "lost{0};why"
                                                   : "why");
    add_row(grid, "(nothing)", &paces->base, HUGE_VAL, &shown);
    for (size_t i = 0; i < paces->count; ++i) {
        if (paces->paces[i].point.verdict != WH_SWEEP_UNDONE) {
            add_row(grid, paces->paces[i].name, &paces->paces[i].point, paces->paces[i].gain, &shown);
        }
    }
    wh_style_put(out, paces->run.script);
    fprintf(out, ", each with %.6g %% less time\n\n", 100 * paces->share);
    wh_grid_print(grid, out);
    fputc('\n', out);
    wh_style_print(style, out, ok == paces->count + 1 ? WH_INK_GOOD : WH_INK_BAD, "%zu of %zu runs ok", ok,
                   paces->count + 1);
    fputc('\n', out);
    print_unlooked(paces, out);
    return ferror(out) ? -1 : 0;
}

/* --------------------------------------------------------------------------------------------------- JSON */

static json_t *pace(const void *subject, size_t i) {
    const wh_paced_run_t *of = &((const wh_paces_t *)subject)->paces[i];
    return of->point.verdict == WH_SWEEP_UNDONE
               ? NULL
               : wh_sweep_put_run(&of->point,
                                  wh_json_set(json_object(), "name %s gain %g", of->name, of->gain));
}

int wh_paces_print_json(const wh_paces_t *paces, FILE *out) {
    bool is_whole = true;
    for (size_t i = 0; i < paces->count; ++i) {
        is_whole = is_whole && paces->paces[i].point.verdict != WH_SWEEP_UNDONE;
    }
    json_t *root =
        wh_json_set(json_object(), "format %d ok %i interrupted %i script %s saved %g", 1,
                    count_ok(paces) == paces->count + 1, !is_whole, paces->run.script, paces->share);
    wh_json_put(root, "base", wh_sweep_put_run(&paces->base, json_object()));
    wh_json_put(root, "faster", wh_json_list(pace, paces, paces->count));
    const int status = wh_json_print(root, out);
    json_decref(root);
    return status;
}
