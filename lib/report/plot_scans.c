/* Plots of edge scans: rho over theta with the fitted circle, and the residuals. */
#include <math.h>
#include <stdlib.h>

#include "../math/trig.h"
#include "../text/array.h"
#include "plots_internal.h"

/* The number of points of the drawn circle. */
#define CIRCLE_POINTS 361
/* The residuals' scale reaches by this factor beyond those that count. */
#define AIR 1.25

enum { SAMPLES, COUNTING, MASKED, CIRCLE, BLOCKS };

typedef struct {
    const wh_edge_scan_t *scan;
    wh_edge_point_t *samples;
    wh_status_t status;
    wh_align_result_t result;
    wh_scan_words_t words;
    size_t blocks[BLOCKS]; /* SIZE_MAX: the plot does not have it */
    double most;           /* residual that counts, um */
} shown_t;

static double degrees(double rad) {
    return rad * 180 / (double)WH_PI;
}

static void put_rim(wh_plot_t *plot, shown_t *shown) {
    wh_plot_block(plot, "samples that see the rim", "theta (degrees), rho (mm), in the chuck's frame");
    for (int32_t i = 0; i < shown->scan->taken; ++i) {
        if (!isnan(shown->samples[i].radius)) {
            wh_plot_row(plot, degrees(shown->samples[i].angle), &shown->samples[i].radius, 1);
        }
    }
    shown->blocks[SAMPLES] = wh_plot_end_block(plot);
}

static void put_residuals(wh_plot_t *plot, shown_t *shown, bool counts) {
    wh_plot_block(plot, counts ? "residuals of samples that count" : "residuals of masked samples",
                  "theta (degrees), rho less the circle (um)");
    for (int32_t i = 0; i < shown->scan->taken; ++i) {
        const wh_edge_point_t *sample = &shown->samples[i];
        const double um = 1000 * sample->residual;
        if (!isnan(um) && sample->counts == counts) {
            wh_plot_row(plot, degrees(sample->angle), &um, 1);
            shown->most = counts ? fmax(shown->most, fabs(um)) : shown->most;
        }
    }
    shown->blocks[counts ? COUNTING : MASKED] = wh_plot_end_block(plot);
}

static void put_circle(wh_plot_t *plot, shown_t *shown) {
    const wh_circle_t *circle = &shown->result.circle;
    wh_plot_block(plot, "fitted circle", "theta (degrees), rho (mm)");
    for (int i = 0; circle->radius > 0 && i < CIRCLE_POINTS; ++i) {
        const double theta = i * 2 * (double)WH_PI / (CIRCLE_POINTS - 1);
        const double rho = wh_circle_radius(circle, 0, wh_cos(theta), wh_sin(theta));
        wh_plot_row(plot, degrees(theta), &rho, 1);
    }
    shown->blocks[CIRCLE] = wh_plot_end_block(plot);
}

/* Draws a line at the angle where the axis sees the notch or flat; it fits a panel of any scale. */
static void draw_mark(wh_plot_t *plot, const shown_t *shown) {
    const double at = degrees(wh_edge_scan_mark_at(&shown->result));
    if (!isnan(at)) {
        fprintf(plot->script,
                "set arrow 1 from first %.9g, graph 0 to first %.9g, graph 1 nohead lw 0.8 dt (5,4)\n"
                "set label 3 '%s%s' at first %.9g, graph 0.08 %s offset %s, 0\n",
                at, at, shown->result.mark == WH_ALIGN_MARK_NOTCH ? "notch" : "flat",
                shown->words.is_sure ? "" : ", not sure", at, at > 180 ? "right" : "left",
                at > 180 ? "-0.5" : "0.5");
    }
}

static void draw_block(wh_plot_t *plot, const shown_t *shown, int block, const char *look) {
    if (shown->blocks[block] != SIZE_MAX) {
        fprintf(plot->script, ", \\\n  '%s.dat' index %zu using 1:2 %s", plot->name, shown->blocks[block],
                look);
    }
}

/* The verdict stands above, so the plot itself says when it is not sure. */
static void draw_rim(wh_plot_t *plot, const shown_t *shown) {
    wh_plot_panel(plot, "\u03c1 (mm)");
    fputs("set xrange [0:360]\nset xtics 45\nset label 4 ", plot->script);
    wh_plot_put_text(plot->script, shown->words.lines[0]);
    fputs(" at graph 0, graph 1.16\n", plot->script);
    draw_mark(plot, shown);
    if (shown->blocks[SAMPLES] == SIZE_MAX) {
        fputs("set yrange [0:1]\n", plot->script);
    }
    /* The point is below the visible range: gnuplot needs something to plot. */
    fprintf(plot->script, "plot %s notitle", shown->blocks[SAMPLES] == SIZE_MAX ? "-1" : "NaN");
    draw_block(plot, shown, SAMPLES, "with points lt 1 pt 7 ps 0.12 title 'samples'");
    draw_block(plot, shown, CIRCLE, "with lines lt 3 title 'fitted circle'");
    fputc('\n', plot->script);
}

static void draw_residuals(wh_plot_t *plot, const shown_t *shown) {
    wh_plot_panel(plot, "residual (\u00b5m)");
    wh_plot_axis(plot, "\u03b8 (degrees)");
    draw_mark(plot, shown);
    const double most = shown->most > 0 ? AIR * shown->most : 1;
    fprintf(plot->script, "set yrange [-%.6g:%.6g]\n", most, most);
    fputs("plot 0 with lines lc rgb '#808080' lw 0.7 notitle", plot->script);
    draw_block(plot, shown, COUNTING, "with points lt 1 pt 7 ps 0.12 title 'count'");
    draw_block(plot, shown, MASKED, "with points lt 3 pt 2 ps 0.4 title 'masked'");
    fputc('\n', plot->script);
}

static void make_scan(wh_plots_t *plots, shown_t *shown) {
    static const wh_plot_frame_t frame = {.panels = 2, .panel_height = 130, .left = 66, .above = 40};
    const wh_layout_t *layout = plots->document->signals->layout;
    char of[WH_NAME_SIZE + 24];
    wh_plot_t plot;
    (void)snprintf(of, sizeof of, "%u_%s", (unsigned)shown->scan->number,
                   layout->grippers[shown->scan->gripper].name);
    if (!wh_plots_open(plots, &plot, "edge_scan", of)) {
        return;
    }
    wh_plot_begin(&plot, &frame, "An edge as the sensor saw it, in the chuck's frame, and the fitted circle",
                  0, 0);
    for (size_t i = 0; i < WH_SCAN_LINES; ++i) {
        fprintf(plot.script, "# %s\n", shown->words.lines[i]);
    }
    put_rim(&plot, shown);
    put_residuals(&plot, shown, true);
    put_residuals(&plot, shown, false);
    put_circle(&plot, shown);
    draw_rim(&plot, shown);
    draw_residuals(&plot, shown);
    wh_plots_close(plots, &plot);
}

void wh_plots_scans(wh_plots_t *plots) {
    const wh_signals_t *signals = plots->document->signals;
    for (size_t i = 0; i < signals->scans.count; ++i) {
        shown_t shown = {.scan = &signals->scans.list[i]};
        shown.samples = wh_array_new((size_t)shown.scan->taken + 1, sizeof *shown.samples);
        const double begin_s = wh_signals_seconds(signals, shown.scan->first_slice);
        const wh_edge_wish_t wish = wh_edge_wish_at(plots->document->record, begin_s);
        shown.status = wh_edge_scan_estimate(shown.scan, signals->layout, wish, shown.samples, &shown.result);
        wh_edge_scan_words(shown.scan, shown.status, &shown.result, &shown.words);
        make_scan(plots, &shown);
        free(shown.samples);
    }
}
