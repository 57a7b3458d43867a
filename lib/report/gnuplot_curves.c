#include "gnuplot_curves.h"

#include <math.h>
#include <stdlib.h>

#include "../text/array.h"

/* Slices, in no order. */
typedef struct {
    int64_t *slices;
    size_t count, capacity;
} list_t;

static void add(list_t *list, int64_t slice) {
    list->slices = wh_array_grow(list->slices, list->count, &list->capacity, sizeof *list->slices);
    list->slices[list->count++] = slice;
}

/* Into how many lines a cubic is cut: they miss it by at most an eighth of its greatest second derivative, which is at one of
 * its ends, times a line's length squared. */
static int64_t pieces_of(const wh_path_point_t *a, const wh_path_point_t *b, double tolerance) {
    const int64_t span = b->slice - a->slice;
    const double rise = b->value - a->value;
    const double from = (double)span * a->slope;
    const double to = (double)span * b->slope;
    const double bend = fmax(fabs(6 * rise - 4 * from - 2 * to), fabs(6 * rise - 2 * from - 4 * to));
    const double pieces = ceil(sqrt(bend / (8 * tolerance)));
    return pieces < 1 ? 1 : pieces < (double)span ? (int64_t)pieces : span;
}

static size_t count_pieces(const wh_path_t *curve, double tolerance) {
    size_t count = 0;
    for (size_t i = 1; i < curve->count; ++i) {
        count += (size_t)pieces_of(&curve->points[i - 1], &curve->points[i], tolerance);
    }
    return count;
}

/* The slices at which a curve is read; after its end one at which there is none. */
static void add_curve(list_t *list, const wh_path_t *curve) {
    const size_t most = 2 * curve->count > WH_PLOT_ROWS ? 2 * curve->count : WH_PLOT_ROWS;
    double tolerance = curve->tolerance;
    while (count_pieces(curve, tolerance) > most) {
        tolerance *= 2;
    }
    for (size_t i = 0; i < curve->count; ++i) {
        const wh_path_point_t *point = &curve->points[i];
        add(list, point->slice);
        if (point->ends) {
            add(list, point->slice + 1);
        } else if (i + 1 < curve->count) {
            const int64_t pieces = pieces_of(point, &point[1], tolerance);
            for (int64_t k = 1; k < pieces; ++k) {
                add(list, point->slice + k * (point[1].slice - point->slice) / pieces);
            }
        }
    }
}

static int compare(const void *a, const void *b) {
    const int64_t first = *(const int64_t *)a;
    const int64_t second = *(const int64_t *)b;
    return (first > second) - (first < second);
}

/* The step that holds at a slice, from the one that held before on. */
static int32_t follow(const wh_steps_t *steps, size_t *at, int64_t slice) {
    while (*at < steps->count && steps->steps[*at].slice <= slice) {
        ++*at;
    }
    return *at > 0 ? steps->steps[*at - 1].value : WH_NONE;
}

/* False where one of the curves has no value. */
static bool read_row(const wh_plot_curves_t *of, int64_t slice, double slice_s, double values[]) {
    for (size_t k = 0; k < of->count; ++k) {
        double slope = 0;
        const double value = wh_path_read(of->curves[k], slice, &slope);
        values[k] = (of->slopes ? slope / slice_s : value) / of->scale;
        if (isnan(value)) {
            return false;
        }
    }
    return true;
}

static void put_rows(wh_plot_t *plot, const wh_plot_curves_t *of, const list_t *list, double slice_s) {
    double values[WH_MEASURES + 1];
    int32_t last = WH_NONE;
    size_t at = 0;
    for (size_t i = 0; i < list->count; ++i) {
        const int64_t slice = list->slices[i];
        if (i > 0 && slice == list->slices[i - 1]) {
            continue;
        }
        const int32_t wafer = of->wafers ? follow(of->wafers, &at, slice) : WH_NONE;
        const bool is_there = read_row(of, slice, slice_s, values);
        if (!is_there || wafer != last) {
            wh_plot_gap(plot);
        }
        if (is_there) {
            values[of->count] = wafer;
            wh_plot_row(plot, (double)slice * slice_s, values, of->count + (of->wafers ? 1 : 0));
        }
        last = wafer;
    }
}

size_t wh_plot_curves(wh_plot_t *plot, const wh_plot_curves_t *of, double slice_s) {
    list_t list = {0};
    for (size_t k = 0; k < of->count; ++k) {
        add_curve(&list, of->curves[k]);
    }
    if (list.count > 0) {
        qsort(list.slices, list.count, sizeof *list.slices, compare);
    }
    put_rows(plot, of, &list, slice_s);
    free(list.slices);
    return wh_plot_end_block(plot);
}
