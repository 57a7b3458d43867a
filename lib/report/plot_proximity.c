/* Plots of curves: proximity, axes, clearances; and offsets at the end. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../layout/axes.h"
#include "../math/trig.h"
#include "../text/array.h"
#include "plots_internal.h"

/* With more wafers than this the plots number them. */
#define MOST_NAMED 40

/* Half of the least range that a plot shows, mm. */
#define LEAST_OFFSET 0.1

/* ---------------------------------------------------------------------------------------------- proximity */

/* Shades the times at which a gripper holds a wafer. The first panel also names the wafer. */
static void shade_holds(const wh_plots_t *plots, wh_plot_t *plot, int32_t gripper) {
    const wh_layout_t *layout = plots->document->signals->layout;
    size_t count = 0;
    wh_plot_hold_t *holds = wh_plots_holds(plots, gripper, &count);
    for (size_t i = 0; i < count; ++i) {
        fprintf(plot->script,
                "set object rect from %.12g, graph 0 to %.12g, graph 1 behind fs solid noborder "
                "fc rgb '#e4e4e4'\n",
                holds[i].begin_s, holds[i].end_s);
        if (plot->panel == 1) {
            const char *name = layout->wafers[holds[i].wafer].name;
            wh_plot_fitting_label(plot, holds[i].begin_s, holds[i].end_s, name);
            fputs(", graph 0.88 center\n", plot->script);
        }
    }
    free(holds);
}

/* Draws a panel of lengths. They range from nothing to many times the limit, hence a logarithmic axis.
 * Values below the axis' end are drawn on it. */
static void put_length(const wh_plots_t *plots, wh_plot_t *plot, int32_t g, const char *name, int column,
                       double low, double limit, double high) {
    char label[60];
    (void)snprintf(label, sizeof label, "|%s| (mm)", name);
    wh_plot_panel(plot, label);
    shade_holds(plots, plot, g);
    wh_plot_limit_label(plot, '<', limit, "mm");
    fprintf(plot->script,
            "low = %.9g\nset logscale y\nset yrange [low:%.9g]\n"
            "plot '%s.dat' index 0 using 1:($%d > low ? $%d : low) with lines lt 1 notitle",
            low, high, plot->name, column, column);
    wh_plot_limit_curve(plot, limit);
    fputc('\n', plot->script);
}

static void put_planar(const wh_plots_t *plots, wh_plot_t *plot, int32_t g, double limit) {
    wh_plot_panel(plot, "n1_proj_n2");
    shade_holds(plots, plot, g);
    wh_plot_limit_label(plot, '>', limit, "");
    fprintf(plot->script, "set yrange [%.9g:%.9g]\nplot '%s.dat' index 0 using 1:4 with lines lt 1 notitle",
            1 - 2 * (1 - limit), 1 + 0.1 * (1 - limit), plot->name);
    wh_plot_limit_curve(plot, limit);
    fputc('\n', plot->script);
}

static void put_proximity(wh_plots_t *plots, int32_t g) {
    static const wh_plot_frame_t frame = {
        .panels = 3, .panel_height = 92, .left = 66, .above = 12, .limits = true};
    const wh_signals_t *signals = plots->document->signals;
    const wh_layout_t *layout = signals->layout;
    const wh_path_t *curves = signals->proximity[g];
    const wh_plot_curves_t values = {
        {&curves[WH_MEASURE_PROJZ], &curves[WH_MEASURE_PROJXY], &curves[WH_MEASURE_PLANAR]},
        WH_MEASURES,
        1,
        false,
        &signals->nearest[g]};
    const wh_tolerance_t *limits = &layout->grasp.tolerance;
    const char *name = layout->grippers[g].name;
    char title[WH_NAME_SIZE + 100];
    wh_plot_t plot;
    if (curves[WH_MEASURE_PROJZ].list.count == 0 || !wh_plots_open(plots, &plot, "proximity", name)) {
        return;
    }
    (void)snprintf(title, sizeof title, "%s against the wafer that it holds (grey), or else would take",
                   name);
    wh_plot_begin(&plot, &frame, title, plots->begin_s, plots->end_s);
    wh_plot_block(&plot, name, "t (s), |dr_proj_z| (mm), |dr_proj_xy| (mm), n1_proj_n2, wafer (from 0)");
    (void)wh_plot_curves(&plot, &values, wh_signals_seconds(signals, 1));
    put_length(plots, &plot, g, "dr_proj_z", 2, limits->projz / 50, limits->projz,
               limits->projz * 4 > WH_SIGNALS_REACH ? limits->projz * 4 : WH_SIGNALS_REACH);
    put_length(plots, &plot, g, "dr_proj_xy", 3, limits->projxy / 50000, limits->projxy,
               2 * layout->grasp.near_projxy);
    put_planar(plots, &plot, g, limits->planar);
    wh_plots_close(plots, &plot);
}

void wh_plots_proximity(wh_plots_t *plots) {
    for (size_t g = 0; g < plots->document->signals->layout->machine.gripper_count; ++g) {
        put_proximity(plots, (int32_t)g);
    }
}

/* --------------------------------------------------------------------------------------------------- axes */

typedef struct {
    const char *label;
    const char *unit; /* the unit of the axes; empty: not known */
    bool is_speed;
} axis_panel_t;

static const axis_panel_t axis_panels[] = {
    {"position (mm)", "mm", false}, {"position (\u00b0)", "rad", false}, {"position (mm or rad)", "", false},
    {"speed (mm/s)", "mm", true},   {"speed (\u00b0/s)", "rad", true},   {"speed (mm/s or rad/s)", "", true}};
#define AXIS_PANELS (sizeof axis_panels / sizeof axis_panels[0])

static bool is_in(const wh_signals_t *signals, size_t axis, const axis_panel_t *panel) {
    const char *unit = wh_layout_axis_unit(signals->layout, axis);
    return signals->axes[axis].list.count > 0 && strcmp(panel->unit, unit ? unit : "") == 0;
}

/* The number of curves that a panel shows, and the range of their values. */
typedef struct {
    size_t curves;
    double low, high;
} axis_range_t;

static axis_range_t look_at(const wh_signals_t *signals, const axis_panel_t *panel) {
    axis_range_t range = {0, HUGE_VAL, -HUGE_VAL};
    for (size_t axis = 0; axis < signals->axis_count; ++axis) {
        const wh_path_t *curve = &signals->axes[axis];
        if (is_in(signals, axis, panel)) {
            ++range.curves;
            for (size_t i = 0; i < curve->list.count; ++i) {
                const double value = panel->is_speed ? wh_path_slope(curve, i) : wh_path_value(curve, i);
                range.low = value < range.low ? value : range.low;
                range.high = value > range.high ? value : range.high;
            }
        }
    }
    return range;
}

/* gnuplot finds no range for axes that stand still. A key of many entries is set closer, to fit into one
 * column. */
static void put_axis_panel(const wh_plots_t *plots, wh_plot_t *plot, const axis_panel_t *panel) {
    const wh_signals_t *signals = plots->document->signals;
    const axis_range_t range = look_at(signals, panel);
    int line = 0;
    wh_plot_panel(plot, panel->label);
    if (range.high - range.low < 1e-6) {
        fprintf(plot->script, "set yrange [%.9g:%.9g]\n", range.low - 1, range.high + 1);
    }
    fprintf(plot->script, "set key width %d\n", range.curves > 2 ? -2 : 0);
    for (size_t axis = 0; axis < signals->axis_count; ++axis) {
        if (is_in(signals, axis, panel)) {
            const bool turns = strcmp(panel->unit, "rad") == 0;
            const wh_plot_curves_t curve = {
                {&signals->axes[axis]}, 1, turns ? WH_PI / 180 : 1, panel->is_speed, NULL};
            char name[WH_NAME_SIZE + 8];
            wh_layout_name_axis(signals->layout, axis, name, sizeof name);
            wh_plot_block(plot, name, panel->is_speed ? "t (s), speed" : "t (s), position");
            const size_t block = wh_plot_curves(plot, &curve, wh_signals_seconds(signals, 1));
            ++line;
            fprintf(plot->script, "%s'%s.dat' index %zu using 1:2 with linespoints pn 9 lt %d title ",
                    line == 1 ? "plot " : ", \\\n  ", plot->name, block, line);
            wh_plot_put_text(plot->script, name);
        }
    }
    fputc('\n', plot->script);
}

void wh_plots_axes(wh_plots_t *plots) {
    wh_plot_frame_t frame = {.panel_height = 88, .left = 66, .above = 22};
    wh_plot_t plot;
    for (size_t i = 0; i < AXIS_PANELS; ++i) {
        frame.panels += look_at(plots->document->signals, &axis_panels[i]).curves > 0 ? 1 : 0;
    }
    if (frame.panels == 0 || !wh_plots_open(plots, &plot, "axes", NULL)) {
        return;
    }
    wh_plot_begin(&plot, &frame, "Axes: where they stand and how fast they are", plots->begin_s,
                  plots->end_s);
    for (size_t i = 0; i < AXIS_PANELS; ++i) {
        if (look_at(plots->document->signals, &axis_panels[i]).curves > 0) {
            put_axis_panel(plots, &plot, &axis_panels[i]);
        }
    }
    wh_plots_close(plots, &plot);
}

/* --------------------------------------------------------------------------------------------- clearances */

/* True if a gap below WH_CLEARANCE_RANGE was measured; wider gaps are not known. */
static bool is_known(const wh_record_t *record, size_t kind) {
    const bool is_measured =
        record->checked && record->curves && record->clearances[kind].parts[0] != WH_NONE;
    for (size_t bin = 0; is_measured && bin < record->curves->count; ++bin) {
        if (record->curves->gaps[kind][bin] < WH_CLEARANCE_RANGE) {
            return true;
        }
    }
    return false;
}

static void put_gaps(const wh_plots_t *plots, wh_plot_t *plot, size_t kind) {
    const wh_curves_t *curves = plots->document->record->curves;
    wh_plot_block(plot, wh_clearance_name((wh_clearance_kind_t)kind),
                  "t (s), smallest gap since the point before (mm)");
    for (size_t bin = 0; bin < curves->count; ++bin) {
        const int64_t slice = (int64_t)wh_curves_end(curves, bin);
        const double gap = curves->gaps[kind][bin];
        if (gap < WH_CLEARANCE_RANGE) {
            wh_plot_row(plot, wh_signals_seconds(plots->document->signals, slice), &gap, 1);
        } else {
            wh_plot_gap(plot);
        }
    }
}

static void put_clearance(const wh_plots_t *plots, wh_plot_t *plot, size_t kind) {
    const double limit = plots->document->signals->layout->world.limits[kind];
    char words[60];
    wh_text_words(words, sizeof words, wh_clearance_name((wh_clearance_kind_t)kind));
    wh_plot_panel(plot, "gap (mm)");
    put_gaps(plots, plot, kind);
    const size_t block = wh_plot_end_block(plot);
    if (limit > 0) {
        wh_plot_limit_label(plot, '>', limit, "mm");
    }
    fprintf(plot->script,
            "set label '%s' at graph 1, graph 1.1 right\n"
            "low = 0.1\nset logscale y\nset yrange [low:%g]\n"
            "plot '%s.dat' index %zu using 1:($2 > low ? $2 : low) with linespoints lt 1 pt 7 ps 0.2 notitle",
            words, WH_CLEARANCE_RANGE, plot->name, block);
    if (limit > 0) {
        wh_plot_limit_curve(plot, limit);
    }
    fputc('\n', plot->script);
}

void wh_plots_clearances(wh_plots_t *plots) {
    const wh_record_t *record = plots->document->record;
    wh_plot_frame_t frame = {.panel_height = 58, .left = 58, .above = 22, .limits = true};
    wh_plot_t plot;
    for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
        frame.panels += is_known(record, kind) ? 1 : 0;
    }
    if (frame.panels == 0 || !wh_plots_open(plots, &plot, "clearances", NULL)) {
        return;
    }
    wh_plot_begin(&plot, &frame, "The smallest gaps, known from 20 mm down", plots->begin_s, plots->end_s);
    for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
        if (is_known(record, kind)) {
            put_clearance(plots, &plot, kind);
        }
    }
    wh_plots_close(plots, &plot);
}

/* ------------------------------------------------------------------------------------------------ offsets */

static bool lies(const wh_record_t *record, size_t wafer) {
    return record->wafers[wafer].place.station != WH_NONE;
}

static size_t count_lying(const wh_record_t *record, const wh_layout_t *layout) {
    size_t count = 0;
    for (size_t i = 0; record->wafers && i < layout->wafer_count; ++i) {
        count += lies(record, i) ? 1 : 0;
    }
    return count;
}

/* True if any wafer lies far enough from its slot's centre to be seen. */
static bool put_data(const wh_plots_t *plots, wh_plot_t *plot) {
    const wh_record_t *record = plots->document->record;
    double number = 0;
    bool is_seen = false;
    wh_plot_block(plot, "wafers that lie in slots", "number, dX (mm), dY (mm) in the slot's axes");
    for (size_t i = 0; i < plots->document->signals->layout->wafer_count; ++i) {
        if (lies(record, i)) {
            const wh_place_t *place = &record->wafers[i].place;
            const double offsets[] = {place->dx, place->dy};
            number += 1;
            is_seen = is_seen || fabs(offsets[0]) > LEAST_OFFSET || fabs(offsets[1]) > LEAST_OFFSET;
            wh_plot_row(plot, number, offsets, 2);
        }
    }
    (void)wh_plot_end_block(plot);
    return is_seen;
}

/* Writes a name such as "Wafer 1 in B 2" below each. */
static void put_names(const wh_plots_t *plots, wh_plot_t *plot) {
    const wh_layout_t *layout = plots->document->signals->layout;
    const wh_record_t *record = plots->document->record;
    size_t number = 0;
    fputs("set xtics rotate by 45 right (", plot->script);
    for (size_t i = 0; i < layout->wafer_count; ++i) {
        if (lies(record, i)) {
            const wh_place_t *place = &record->wafers[i].place;
            char name[2 * WH_NAME_SIZE + 20];
            (void)snprintf(name, sizeof name, "%s in %s %d", layout->wafers[i].name,
                           layout->stations[place->station].name, (int)place->slot);
            fputs(number > 0 ? ", " : "", plot->script);
            wh_plot_put_tic(plot->script, name);
            fprintf(plot->script, " %zu", ++number);
        }
    }
    fputs(")\n", plot->script);
}

void wh_plots_offsets(wh_plots_t *plots) {
    const size_t count = count_lying(plots->document->record, plots->document->signals->layout);
    wh_plot_frame_t frame = {.panels = 1, .panel_height = 190, .left = 66, .above = 22};
    wh_plot_t plot;
    if (count == 0 || !wh_plots_open(plots, &plot, "offsets", NULL)) {
        return;
    }
    wh_plot_begin(&plot, &frame, "How far beside their slots' centres wafers lie at the end", 0, 0);
    const bool is_seen = put_data(plots, &plot);
    wh_plot_panel(&plot, "offset (mm)");
    wh_plot_axis(&plot, count > MOST_NAMED ? "wafer" : "");
    fprintf(plot.script, "set xrange [0.5:%zu.5]\n", count);
    if (count <= MOST_NAMED) {
        put_names(plots, &plot);
        fputs("set bmargin at screen 90 / H\n", plot.script);
    }
    fprintf(plot.script,
            "%s\n"
            "plot 0 with lines lc rgb '#808080' lw 0.7 notitle, \\\n"
            "  '%s.dat' index 0 using 1:2 with points lt 1 pt 5 ps 0.6 title 'dX', \\\n"
            "  '%s.dat' index 0 using 1:3 with points lt 2 pt 6 ps 0.8 lw 1.3 title 'dY'\n",
            is_seen ? "set offsets 0, 0, graph 0.08, graph 0.08" : "set yrange [-0.1:0.1]", plot.name,
            plot.name);
    wh_plots_close(plots, &plot);
}
