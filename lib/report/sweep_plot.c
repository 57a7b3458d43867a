#include "sweep_plot.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "../text/svg.h"

/* Units of the picture; each is about a pixel. */
enum { WIDTH = 760, LEFT = 90, RIGHT = 24, TOP = 56, PANEL = 170, BETWEEN = 26, LANE = 16, BELOW = 54 };

/* The number of combinations of the other parameters that get a name; the rest is grey. */
#define NAMED 8

static const char *const colours[NAMED] = {"#0b5fa5", "#b84a00", "#00745a", "#8b3a8f",
                                           "#756000", "#5a6673", "#c2185b", "#2e7d32"};

typedef struct {
    const char *name;
    size_t offset; /* of the figure within a point */
} panel_t;

static const panel_t panels[] = {{"simulated time, s", offsetof(wh_sweep_point_t, simulated_s)},
                                 {"wafers per hour", offsetof(wh_sweep_point_t, wafers_per_hour)},
                                 {"largest |dr_proj_z|, mm", offsetof(wh_sweep_point_t, projz)},
                                 {"largest |dr_proj_xy|, mm", offsetof(wh_sweep_point_t, projxy)},
                                 {"smallest gap, mm", offsetof(wh_sweep_point_t, gap)}};
#define PANELS (sizeof panels / sizeof panels[0])

/* Maps a value to the picture, along one direction. */
typedef struct {
    double low, high, from, to;
} scale_t;

typedef struct {
    const wh_script_sweep_t *sweep;
    FILE *out;
    size_t series; /* combinations of all parameters but the first */
    scale_t x;
} drawing_t;

static double figure_of(const wh_sweep_point_t *point, const panel_t *panel) {
    double value;
    memcpy(&value, (const char *)point + panel->offset, sizeof value);
    return value;
}

static double place(const scale_t *scale, double value) {
    return scale->from + (value - scale->low) / (scale->high - scale->low) * (scale->to - scale->from);
}

static const char *colour_of(size_t series) {
    return series < NAMED ? colours[series] : "#9aa3ad";
}

/* --------------------------------------------------------------------------------------------------- axes */

/* A step of 1, 2 or 5 times a power of ten; about five steps fit in. */
static double tick_step(const scale_t *scale) {
    const double rough = (scale->high - scale->low) / 5;
    const double power = pow(10, floor(log10(rough)));
    const double ratio = rough / power;
    return power * (ratio < 1.5 ? 1 : ratio < 3.5 ? 2 : ratio < 7.5 ? 5 : 10);
}

static void draw_ticks(const drawing_t *d, const scale_t *scale, bool is_x, double top, double bottom) {
    const double step = tick_step(scale);
    const int64_t last = (int64_t)floor(scale->high / step + 1e-9);
    for (int64_t i = (int64_t)ceil(scale->low / step - 1e-9); i <= last; ++i) {
        const double value = (double)i * step;
        const double at = place(scale, value);
        char text[WH_SWEEP_VALUE];
        wh_sweep_text(value, text);
        if (is_x) {
            fprintf(d->out,
                    "<path class=\"grid\" d=\"M%.1f %.1fV%.1f\"/><text class=\"x\" x=\"%.1f\" y=\"%.1f\">%s"
                    "</text>\n",
                    at, top, bottom, at, bottom + 16, text);
        } else {
            fprintf(
                d->out,
                "<path class=\"grid\" d=\"M%d %.1fH%d\"/><text class=\"y\" x=\"%d\" y=\"%.1f\">%s</text>\n",
                LEFT, at, WIDTH - RIGHT, LEFT - 8, at + 4, text);
        }
    }
}

/* The scale reaches a little beyond the figures; a single value gets room on both sides. */
static scale_t scale_of(const drawing_t *d, const panel_t *panel, double top) {
    double low = HUGE_VAL;
    double high = -HUGE_VAL;
    for (size_t i = 0; i < d->sweep->point_count; ++i) {
        const double value = figure_of(&d->sweep->points[i], panel);
        low = isfinite(value) ? fmin(low, value) : low;
        high = isfinite(value) ? fmax(high, value) : high;
    }
    const double room = fmax(0.05 * (high - low), 1e-3 + 1e-3 * fabs(high));
    const scale_t scale = {low - room, high + room, top + PANEL, top};
    return scale;
}

static bool has_any(const drawing_t *d, const panel_t *panel) {
    for (size_t i = 0; i < d->sweep->point_count; ++i) {
        if (isfinite(figure_of(&d->sweep->points[i], panel))) {
            return true;
        }
    }
    return false;
}

/* ------------------------------------------------------------------------------------------------- points */

static double x_of(const drawing_t *d, size_t point) {
    return place(&d->x, wh_sweep_value(d->sweep, point, 0));
}

static size_t series_of(const drawing_t *d, size_t point) {
    return d->series > 0 ? point % d->series : 0;
}

static void draw_curve(const drawing_t *d, const panel_t *panel, const scale_t *y, size_t series) {
    bool goes_on = false;
    fprintf(d->out, "<path class=\"curve\" stroke=\"%s\" d=\"", colour_of(series));
    for (size_t i = series; i < d->sweep->point_count; i += d->series) {
        const double value = figure_of(&d->sweep->points[i], panel);
        if (isfinite(value)) {
            fprintf(d->out, "%c%.1f %.1f", goes_on ? 'L' : 'M', x_of(d, i), place(y, value));
        }
        goes_on = isfinite(value);
    }
    fputs("\"/>\n", d->out);
}

/* Draws a disc for a run that is ok, and a red cross for another. */
static void draw_point(const drawing_t *d, size_t i, double y) {
    const double x = x_of(d, i);
    if (d->sweep->points[i].verdict == WH_SWEEP_OK) {
        fprintf(d->out, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>\n", x, y,
                colour_of(series_of(d, i)));
    } else {
        fprintf(d->out, "<path class=\"bad\" d=\"M%.1f %.1fl8 8m0 -8l-8 8\"/>\n", x - 4, y - 4);
    }
}

static void draw_panel(const drawing_t *d, const panel_t *panel, double top) {
    const scale_t y = scale_of(d, panel, top);
    fprintf(d->out, "<text class=\"title\" x=\"%d\" y=\"%.1f\">%s</text>\n", LEFT, top - 6, panel->name);
    draw_ticks(d, &y, false, top, top + PANEL);
    fprintf(d->out, "<rect class=\"frame\" x=\"%d\" y=\"%.1f\" width=\"%d\" height=\"%d\"/>\n", LEFT, top,
            WIDTH - LEFT - RIGHT, PANEL);
    for (size_t series = 0; series < d->series; ++series) {
        draw_curve(d, panel, &y, series);
    }
    for (size_t i = 0; i < d->sweep->point_count; ++i) {
        const double value = figure_of(&d->sweep->points[i], panel);
        if (isfinite(value)) {
            draw_point(d, i, place(&y, value));
        }
    }
}

/* Draws one line for each combination, which shows the runs that are ok. */
static void draw_lanes(const drawing_t *d, double top) {
    fprintf(d->out, "<text class=\"title\" x=\"%d\" y=\"%.1f\">ok, or failed (red cross)</text>\n", LEFT,
            top - 6);
    draw_ticks(d, &d->x, true, top, top + LANE * (double)d->series);
    for (size_t i = 0; i < d->sweep->point_count; ++i) {
        draw_point(d, i, top + LANE * ((double)series_of(d, i) + 0.5));
    }
}

/* --------------------------------------------------------------------------------------------- all of it */

/* Writes the combination's values beside its lane. */
static void draw_names(const drawing_t *d, double top) {
    for (size_t series = 0; series < d->series; ++series) {
        fprintf(d->out, "<text class=\"y\" x=\"%d\" y=\"%.1f\" style=\"fill:%s\">", LEFT - 8,
                top + LANE * ((double)series + 0.5) + 4, colour_of(series));
        for (size_t axis = 1; axis < d->sweep->axis_count; ++axis) {
            char text[WH_SWEEP_VALUE];
            wh_sweep_text(wh_sweep_value(d->sweep, series, axis), text);
            fputs(axis > 1 ? ", " : "", d->out);
            wh_svg_text(d->out, d->sweep->axes[axis].name);
            fprintf(d->out, "=%s", text);
        }
        fputs("</text>\n", d->out);
    }
}

static void draw_head(const drawing_t *d, double height) {
    fprintf(
        d->out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%.0f\" viewBox=\"0 0 %d %.0f\">\n"
        "<style>text{font:12px sans-serif;fill:#16202b}.x{text-anchor:middle}.y{text-anchor:end}"
        ".title{font-weight:600}.grid{stroke:#d3d9df}.frame{fill:none;stroke:#808b96}"
        ".curve{fill:none;stroke-width:1.5}.bad{stroke:#b3121f;stroke-width:2;fill:none}</style>\n"
        "<rect width=\"100%%\" height=\"100%%\" fill=\"#ffffff\"/>\n",
        WIDTH, height, WIDTH, height);
    fprintf(d->out, "<text class=\"title\" x=\"%d\" y=\"22\">", LEFT);
    wh_svg_text(d->out, d->sweep->run.script);
    fputs("</text>\n", d->out);
}

void wh_sweep_plot(const wh_script_sweep_t *sweep, FILE *out) {
    const wh_sweep_axis_t *axis = &sweep->axes[0];
    const double end = axis->start + axis->step * (double)(axis->count - 1);
    const double room = axis->count > 1 ? 0.02 * fabs(end - axis->start) : 1;
    const drawing_t d = {sweep,
                         out,
                         sweep->point_count / axis->count,
                         {fmin(axis->start, end) - room, fmax(axis->start, end) + room, LEFT, WIDTH - RIGHT}};
    double top = TOP;
    size_t shown = 0;
    for (size_t i = 0; i < PANELS; ++i) {
        shown += has_any(&d, &panels[i]) ? 1 : 0;
    }
    const double lanes = LANE * (double)d.series;
    draw_head(&d, TOP + (double)shown * (PANEL + BETWEEN) + lanes + BELOW);
    for (size_t i = 0; i < PANELS; ++i) {
        if (has_any(&d, &panels[i])) {
            draw_panel(&d, &panels[i], top);
            top += PANEL + BETWEEN;
        }
    }
    draw_lanes(&d, top);
    draw_names(&d, top);
    fprintf(out, "<text class=\"x\" x=\"%d\" y=\"%.1f\">", (LEFT + WIDTH - RIGHT) / 2, top + lanes + 38);
    wh_svg_text(out, axis->name);
    fputs("</text>\n</svg>\n", out);
}
