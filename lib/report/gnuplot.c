#include "gnuplot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../grasp/grasp.h"
#include "../text/array.h"
#include "../text/utf8.h"

/* Pixels: below the last panel for the axis; right of the panels, without limits and with them; for two
 * more rows of a key. */
enum { BELOW = 38, RIGHT = 10, RIGHT_OF_LIMITS = 58, KEY_ROWS = 28, COLUMN_MM = 170 };

/* -------------------------------------------------------------------------------------------------- texts */

static size_t put_character(FILE *out, const char *c) {
    const size_t bytes = wh_utf8_bytes(c);
    const bool is_control = (unsigned char)*c < ' ' || *c == 127;
    if (bytes == 0 || is_control) {
        fputc(bytes == 0 ? '?' : ' ', out);
        return 1;
    }
    fwrite(c, 1, bytes, out);
    return bytes;
}

/* Writes text between single quotes. Characters in `doubled` are written twice; gnuplot then takes them
 * literally. */
static void put_quoted(FILE *out, const char *text, const char *doubled) {
    fputc('\'', out);
    for (const char *c = text; *c;) {
        if (strchr(doubled, *c)) {
            fputc(*c, out);
        }
        c += put_character(out, c);
    }
    fputc('\'', out);
}

void wh_plot_put_text(FILE *out, const char *text) {
    put_quoted(out, text, "'");
}

void wh_plot_put_tic(FILE *out, const char *text) {
    put_quoted(out, text, "'%");
}

/* Writes a comment, which ends with its line. A backslash at its end would continue it on the next line. */
static void put_comment(FILE *out, const char *text) {
    for (const char *c = text; *c;) {
        if (*c == '\\') {
            fputc('/', out);
            ++c;
        } else {
            c += put_character(out, c);
        }
    }
    fputc('\n', out);
}

/* ------------------------------------------------------------------------------------------------- script */

static void put_size(const wh_plot_t *plot) {
    const wh_plot_frame_t *frame = &plot->frame;
    const int height = (int)frame->panels * (frame->panel_height + frame->above) + BELOW;
    fprintf(plot->script,
            "if (!exists('width_mm')) width_mm = %d\n"
            "reset\n"
            "W = width_mm / 25.4 * 96\n"
            "top = width_mm < 120 ? %d : 0\n"
            "H = %d.0 + top\n"
            "set encoding utf8\n"
            "set terminal svg size W, H fixed noenhanced background rgb '#ffffff' font 'sans-serif,10' name "
            "'%s'\n"
            "set output '%s.svg'\n",
            COLUMN_MM, frame->keys_wrap ? KEY_ROWS : 0, height, plot->name, plot->name);
}

static const char *const look = "set linetype 1 lc rgb '#000000' lw 1.1 dt 1 pt 4 ps 0.45\n"
                                "set linetype 2 lc rgb '#1f4e8c' lw 1.1 dt (10,4) pt 6 ps 0.45\n"
                                "set linetype 3 lc rgb '#9c1c1c' lw 1.1 dt (3,3) pt 8 ps 0.45\n"
                                "set linetype 4 lc rgb '#2b6b2b' lw 1.1 dt (12,3,3,3) pt 10 ps 0.45\n"
                                "set linetype 5 lc rgb '#5c3a86' lw 1.1 dt (6,3,2,3,2,3) pt 12 ps 0.45\n"
                                "set linetype 6 lc rgb '#8a6d00' lw 1.1 dt (2,5) pt 2 ps 0.45\n"
                                "set linetype cycle 6\n"
                                "set style line 9 lc rgb '#000000' lw 0.8 dt (5,4)\n"
                                "set border 3 lw 0.7\n"
                                "set tics nomirror scale 0.5\n"
                                "set grid xtics lc rgb '#d0d0d0' lw 0.5 dt 1\n"
                                "set key at graph 1, graph 1.03 bottom right horizontal samplen 2\n"
                                "set style fill solid border lc rgb '#000000'\n";

void wh_plot_begin(wh_plot_t *plot, const wh_plot_frame_t *frame, const char *title, double begin,
                   double end) {
    plot->frame = *frame;
    fputs("# ", plot->script);
    put_comment(plot->script, title);
    fprintf(plot->script, "# To draw it again: gnuplot %s.gp; in one column: gnuplot -e width_mm=85 %s.gp\n",
            plot->name, plot->name);
    put_size(plot);
    fputs(look, plot->script);
    const int right = frame->limits ? RIGHT_OF_LIMITS : RIGHT;
    fprintf(plot->script, "set lmargin at screen %d / W\nset rmargin at screen 1 - %d / W\n", frame->left,
            right);
    if (end > begin) {
        fprintf(plot->script,
                "if (!exists('from_s')) from_s = %.12g\n"
                "if (!exists('to_s')) to_s = %.12g\n"
                "set xrange [from_s:to_s]\n"
                "# Whether so many letters fit between two times.\n"
                "fits(letters, a, b) = a >= from_s && b <= to_s && \\\n"
                "    letters * 6.4 + 4 < 1.0 * (b - a) / (to_s - from_s) * (W - %d)\n",
                begin, end, frame->left + right);
    }
    fputs("set multiplot\n", plot->script);
}

void wh_plot_panel(wh_plot_t *plot, const char *label) {
    const wh_plot_frame_t *frame = &plot->frame;
    const int top = (int)plot->panel * (frame->panel_height + frame->above) + frame->above;
    const bool is_last = ++plot->panel == frame->panels;
    fprintf(plot->script,
            "\nset tmargin at screen 1 - (top + %d) / H\n"
            "set bmargin at screen 1 - (top + %d) / H\n"
            "unset label\nunset object\nunset logscale y\nset yrange [*:*]\nset ytics autofreq\n"
            "set format x '%s'\n",
            top, top + frame->panel_height, is_last ? "%g" : "");
    fputs("set label 1 ", plot->script);
    wh_plot_put_text(plot->script, label);
    fputs(" at screen 9 / W, graph 0.5 center rotate by 90\n", plot->script);
    if (is_last) {
        wh_plot_axis(plot, "t (s)");
    }
}

void wh_plot_axis(wh_plot_t *plot, const char *label) {
    fprintf(plot->script, "set label 2 '%s' at graph 0.5, screen 8 / H center\n", label);
}

void wh_plot_limit_label(wh_plot_t *plot, char side, double limit, const char *unit) {
    fprintf(plot->script, "set label '%c %.9g%s%s' at graph 1, first %.9g left offset 0.5, 0\n", side, limit,
            unit[0] != '\0' ? " " : "", unit, limit);
}

void wh_plot_fitting_label(wh_plot_t *plot, double begin, double end, const char *text) {
    fprintf(plot->script, "if (fits(%zu, %.12g, %.12g)) set label ", wh_utf8_count(text), begin, end);
    wh_plot_put_text(plot->script, text);
    fprintf(plot->script, " at %.12g", (begin + end) / 2);
}

void wh_plot_limit_curve(wh_plot_t *plot, double limit) {
    fprintf(plot->script, ", \\\n  %.9g with lines ls 9 notitle", limit);
}

/* --------------------------------------------------------------------------------------------------- data */

void wh_plot_block(wh_plot_t *plot, const char *of, const char *columns) {
    fputs("# ", plot->data);
    put_comment(plot->data, of);
    fprintf(plot->data, "# %s\n", columns);
    plot->has_rows = plot->is_gap = false;
}

void wh_plot_row(wh_plot_t *plot, double at, const double values[], size_t count) {
    fputs(plot->is_gap ? "\n" : "", plot->data);
    fprintf(plot->data, "%.12g", at);
    for (size_t i = 0; i < count; ++i) {
        fprintf(plot->data, " %.9g", values[i]);
    }
    fputc('\n', plot->data);
    plot->has_rows = true;
    plot->is_gap = false;
}

void wh_plot_gap(wh_plot_t *plot) {
    plot->is_gap = plot->has_rows;
}

size_t wh_plot_end_block(wh_plot_t *plot) {
    if (!plot->has_rows) {
        return SIZE_MAX;
    }
    fputs("\n\n", plot->data);
    plot->has_rows = false;
    return plot->blocks++;
}

/* ------------------------------------------------------------------------------------------------- curves */

/* A list of slices, in no order. */
typedef struct {
    int64_t *slices;
    size_t count, capacity;
} list_t;

static void add(list_t *list, int64_t slice) {
    list->slices = wh_array_grow(list->slices, list->count, &list->capacity, sizeof *list->slices);
    list->slices[list->count++] = slice;
}

/* The number of lines that the cubic from point `i` is cut into. They miss it by at most an eighth of its
 * greatest second derivative, which is at one of its ends, times a line's length squared. */
static int64_t pieces_of(const wh_path_t *curve, size_t i, double tolerance) {
    const int64_t span = curve->list.points[i + 1].slice - curve->list.points[i].slice;
    const double rise = wh_path_value(curve, i + 1) - wh_path_value(curve, i);
    const double from = (double)span * wh_path_slope(curve, i);
    const double to = (double)span * wh_path_slope(curve, i + 1);
    const double bend = fmax(fabs(6 * rise - 4 * from - 2 * to), fabs(6 * rise - 2 * from - 4 * to));
    const double pieces = ceil(sqrt(bend / (8 * tolerance)));
    return pieces < 1 ? 1 : pieces < (double)span ? (int64_t)pieces : span;
}

static size_t count_pieces(const wh_path_t *curve, double tolerance) {
    size_t count = 0;
    for (size_t i = 0; i + 1 < curve->list.count; ++i) {
        count += (size_t)pieces_of(curve, i, tolerance);
    }
    return count;
}

/* Adds the slices at which a curve is read. After its end comes one more, where it has no value. */
static void add_curve(list_t *list, const wh_path_t *curve) {
    const wh_points_t *points = &curve->list;
    const size_t most = 2 * points->count > WH_PLOT_ROWS ? 2 * points->count : WH_PLOT_ROWS;
    double tolerance = points->tolerance;
    while (count_pieces(curve, tolerance) > most) {
        tolerance *= 2;
    }
    for (size_t i = 0; i < points->count; ++i) {
        const int64_t slice = points->points[i].slice;
        add(list, slice);
        if (points->points[i].ends) {
            add(list, slice + 1);
        } else if (i + 1 < points->count) {
            const int64_t pieces = pieces_of(curve, i, tolerance);
            for (int64_t k = 1; k < pieces; ++k) {
                add(list, slice + k * (points->points[i + 1].slice - slice) / pieces);
            }
        }
    }
}

static int compare(const void *a, const void *b) {
    const int64_t first = *(const int64_t *)a;
    const int64_t second = *(const int64_t *)b;
    return (first > second) - (first < second);
}

/* The value that holds at a slice. `at` counts the steps that are passed. */
static int32_t follow(const wh_steps_t *steps, size_t *at, int64_t slice) {
    while (*at < steps->count && steps->steps[*at].slice <= slice) {
        ++*at;
    }
    return *at > 0 ? steps->steps[*at - 1].value : WH_NONE;
}

/* False if one of the curves has no value there. */
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
