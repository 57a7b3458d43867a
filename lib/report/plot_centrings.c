/* Plots of centrings on the way: the blade's frame with the crossings and the circles through them, its
 * middle enlarged, and the residuals. */
#include <math.h>

#include "../math/trig.h"
#include "../record/centring_words.h"
#include "plots_internal.h"

/* The number of points of a drawn circle. */
#define CIRCLE_POINTS 181
/* The residuals' scale reaches by this factor beyond those that count, and at least this far, um. */
#define AIR 1.6
#define LEAST_SCALE 1.0
/* Room around the wafer, as a part of its radius; the least that the middle shows, mm. */
#define MARGIN 1.12
#define LEAST_MIDDLE 0.25

enum { RIM_IN, RIM_OUT, NOTCH, OTHER, UNJUDGED, KINDS };
enum { CANDIDATES = 2 };

typedef struct {
    const wh_centring_record_t *centring;
    const wh_record_t *record;
    wh_centring_words_t words;
    size_t nominal, kinds[KINDS], circles[CANDIDATES], middles[CANDIDATES], residuals[CANDIDATES];
    double scale; /* of the residuals, um */
} shown_t;

/* --------------------------------------------------------------------------------------------------- data */

static size_t put_circle(wh_plot_t *plot, const char *of, double x, double y, double radius) {
    wh_plot_block(plot, of, "x, y (mm), on the blade");
    for (int i = 0; i < CIRCLE_POINTS; ++i) {
        const double angle = i * 2 * (double)WH_PI / (CIRCLE_POINTS - 1);
        const double across = y + radius * wh_sin(angle);
        wh_plot_row(plot, x + radius * wh_cos(angle), &across, 1);
    }
    return wh_plot_end_block(plot);
}

static int kind_of(const wh_centring_record_t *centring, size_t k) {
    if (centring->centres.count == 0) {
        return UNJUDGED;
    }
    const wh_crossing_use_t use = centring->centres.candidates[0].use[k];
    if (use != WH_CROSSING_USED) {
        return use == WH_CROSSING_NOTCH ? NOTCH : OTHER;
    }
    return centring->crossings[k].crossing.edge == WH_CROSSING_IN ? RIM_IN : RIM_OUT;
}

static int beam_of(const shown_t *shown, size_t k) {
    const wh_latch_order_t order =
        wh_layout_beams_at(shown->record->layout, (size_t)shown->centring->station);
    return shown->centring->crossings[k].crossing.beam - order.first + 1;
}

static void put_kind(wh_plot_t *plot, shown_t *shown, int kind) {
    static const char *const of[KINDS] = {"crossings of the rim, coming in", "crossings of the rim, leaving",
                                          "crossings left out for the notch", "crossings of none of the rim",
                                          "crossings that nothing is told of"};
    wh_plot_block(plot, of[kind], "x, y (mm), on the blade, beam");
    for (size_t k = 0; k < shown->centring->count; ++k) {
        const wh_crossing_t *crossing = &shown->centring->crossings[k].crossing;
        const double row[] = {crossing->y, beam_of(shown, k)};
        if (kind_of(shown->centring, k) == kind) {
            wh_plot_row(plot, crossing->x, row, 2);
        }
    }
    shown->kinds[kind] = wh_plot_end_block(plot);
}

static void put_candidate(wh_plot_t *plot, shown_t *shown, int32_t i) {
    const wh_centring_record_t *centring = shown->centring;
    const wh_centre_t *centre = &centring->centres.candidates[i];
    shown->circles[i] = shown->middles[i] = shown->residuals[i] = SIZE_MAX;
    if (i >= centring->centres.count) {
        return;
    }
    shown->circles[i] = put_circle(plot, "fitted circle", centre->x, centre->y, centre->radius);
    wh_plot_block(plot, "its centre", "x, y (mm), on the blade");
    wh_plot_row(plot, centre->x, &centre->y, 1);
    shown->middles[i] = wh_plot_end_block(plot);
    wh_plot_block(plot, "residuals", "crossing, distance from the centre less the radius (um)");
    for (size_t k = 0; k < centring->count; ++k) {
        const double um = 1000 * wh_centring_residual(centring, i, k);
        wh_plot_row(plot, (double)k + 1, &um, 1);
        shown->scale = centre->use[k] == WH_CROSSING_USED ? fmax(shown->scale, AIR * fabs(um)) : shown->scale;
    }
    shown->residuals[i] = wh_plot_end_block(plot);
}

static void put_data(wh_plot_t *plot, shown_t *shown) {
    shown->scale = LEAST_SCALE;
    shown->nominal =
        put_circle(plot, "nominal wafer in the middle", 0, 0, shown->record->layout->wafer_diameter / 2);
    for (int kind = 0; kind < KINDS; ++kind) {
        put_kind(plot, shown, kind);
    }
    for (int32_t i = 0; i < CANDIDATES; ++i) {
        put_candidate(plot, shown, i);
    }
}

/* -------------------------------------------------------------------------------------------------- words */

static void put_place(FILE *script, const wh_centring_record_t *centring, int32_t i) {
    const wh_centre_t *centre = &centring->centres.candidates[i];
    const wh_centring_offset_t offset = wh_centring_offset(centring, i);
    if (isnan(offset.dx)) {
        fprintf(script, "x %.4f, y %.4f mm on the blade", centre->x, centre->y);
    } else {
        fprintf(script, "dX %.4f, dY %.4f mm", offset.dx, offset.dy);
    }
}

/* The title of a candidate. */
static const char *title_of(const wh_centring_record_t *centring, int i) {
    if (centring->status == WH_OK) {
        return i == 0 ? "fitted" : "as near as the same";
    }
    return centring->centres.count < 2 ? "not likely" : i == 0 ? "likelier place" : "other place";
}

static void draw_words(wh_plot_t *plot, const shown_t *shown) {
    const wh_centring_record_t *centring = shown->centring;
    const wh_centring_t *known = &centring->known;
    const wh_centre_t *centre = centring->centres.count > 0 ? &centring->centres.candidates[0] : NULL;
    const bool is_double = centring->status != WH_OK && centring->centres.count > 1;
    FILE *script = plot->script;
    fputs("set label 4 ", script);
    wh_plot_put_text(script, shown->words.lines[0]);
    fputs(" at screen 9 / W, screen 1 - 12 / H\nset label 5 '", script);
    if (centre) {
        put_place(script, centring, 0);
        fputs(is_double ? " or " : "", script);
        if (is_double) {
            put_place(script, centring, 1);
        }
        fprintf(script,
                "' at screen 9 / W, screen 1 - 26 / H\nset label 6 'sd %.2f \u00b5m, radius %.4f mm, ",
                1000 * centre->sd_centre, centre->radius);
    } else {
        fputs("no place is told' at screen 9 / W, screen 1 - 26 / H\nset label 6 '", script);
    }
    fprintf(script, "used %d, missed %lld' at screen 9 / W, screen 1 - 40 / H\n",
            centre ? (int)centre->used : 0, (long long)centring->missed);
    fprintf(script, "set label 8 'notch: %s' at screen 9 / W, screen 1 - 54 / H\n",
            !(known->notch_width > 0) ? "none"
            : known->notch_known      ? "its direction is known by ALIGN"
            : centring->repeated      ? "not told by a log, its direction counts as not known"
                                      : "its direction is not known");
}

/* ------------------------------------------------------------------------------------------------- panels */

/* `title` may be null. */
static void draw_block(wh_plot_t *plot, size_t block, const char *look, const char *title) {
    if (block != SIZE_MAX) {
        fprintf(plot->script, ", \\\n  '%s.dat' index %zu using 1:2 %s %s", plot->name, block, look,
                title ? "title " : "notitle");
    }
    if (block != SIZE_MAX && title) {
        wh_plot_put_text(plot->script, title);
    }
}

/* Draws the place of the notch as an alignment knows it. */
static void draw_notch(wh_plot_t *plot, const shown_t *shown) {
    const wh_centring_t *known = &shown->centring->known;
    if (known->notch_width > 0 && known->notch_known) {
        const double x = known->radius * wh_cos(known->notch_direction);
        const double y = known->radius * wh_sin(known->notch_direction);
        fprintf(plot->script,
                "set arrow 1 from first %.6g, first %.6g to first %.6g, first %.6g lw 0.8\n"
                "set label 7 'notch' at first %.6g, first %.6g center\n",
                0.8 * x, 0.8 * y, x, y, 0.68 * x, 0.68 * y);
    }
}

static void draw_blade(wh_plot_t *plot, const shown_t *shown) {
    static const char *const looks[KINDS][2] = {
        {"with points lc rgb '#000000' pt 9 ps 0.7", "rim, in"},
        {"with points lc rgb '#000000' pt 11 ps 0.7", "rim, out"},
        {"with points lc rgb '#9c1c1c' pt 4 ps 0.8 lw 1.4", "notch"},
        {"with points lc rgb '#5c3a86' pt 2 ps 0.7 lw 1.4", "none of the rim"},
        {"with points lc rgb '#5c3a86' pt 6 ps 0.7 lw 1.4", "not judged"}};
    const bool is_double = shown->centring->status != WH_OK && shown->centring->centres.count > 1;
    const double reach = MARGIN * shown->record->layout->wafer_diameter / 2;
    wh_plot_panel(plot, "y on the blade (mm)");
    draw_words(plot, shown);
    draw_notch(plot, shown);
    fprintf(plot->script,
            "set label 2 'x on the blade (mm)' at graph 0.5, graph 0 center offset 0, -2.2\n"
            "set format x '%%g'\nset rmargin at screen 0.52\nset size ratio -1\n"
            "set xrange [-%.6g:%.6g]\nset yrange [-%.6g:%.6g]\nset xtics 100\nset ytics 100\n"
            "set key at screen 1 - 10 / W, screen 1 - 72 / H top right vertical\n",
            reach, reach, reach, reach);
    fprintf(
        plot->script,
        "plot '%s.dat' index %zu using 1:2 with lines lc rgb '#808080' lw 0.8 dt (2,3) title 'nominal, in "
        "the middle'",
        plot->name, shown->nominal);
    draw_block(plot, shown->circles[0], "with lines lc rgb '#1f4e8c' lw 1.1 dt 1",
               title_of(shown->centring, 0));
    draw_block(plot, shown->circles[1], "with lines lc rgb '#9c1c1c' lw 1.1 dt (6,4)",
               title_of(shown->centring, 1));
    for (int kind = 0; kind < KINDS; ++kind) {
        draw_block(plot, shown->kinds[kind], looks[kind][0],
                   kind == NOTCH && is_double ? "notch, by the likelier" : looks[kind][1]);
    }
    fputs("\nunset arrow\nset size noratio\n", plot->script);
}

/* A step of 1, 2 or 5 times a power of ten: one or two steps are within the reach. */
static double step_within(double reach) {
    const double power = pow(10, floor(log10(reach / 2)));
    const double times = reach / 2 / power;
    return power * (times > 5 ? 10 : times > 2 ? 5 : times > 1 ? 2 : 1);
}

/* Draws the right half of the panel, below the key. */
static void draw_middle(wh_plot_t *plot, const shown_t *shown) {
    double reach = LEAST_MIDDLE;
    for (int32_t i = 0; i < shown->centring->centres.count; ++i) {
        const wh_centre_t *centre = &shown->centring->centres.candidates[i];
        reach = fmax(reach, 1.3 * fmax(fabs(centre->x), fabs(centre->y)));
    }
    fprintf(plot->script,
            "unset label\nset lmargin at screen 0.66\nset rmargin at screen 0.97\n"
            "set tmargin at screen 1 - (top + 190) / H\n"
            "set label 1 'middle, y (mm)' at screen 0.59, graph 0.5 center rotate by 90\n"
            "set label 2 'middle, x (mm)' at graph 0.5, graph 0 center offset 0, -2.2\n"
            "set xrange [-%.6g:%.6g]\nset yrange [-%.6g:%.6g]\nset xtics %.6g\nset ytics %.6g\n"
            "set size ratio -1\nunset key\n",
            reach, reach, reach, reach, step_within(reach), step_within(reach));
    fputs("plot '+' using (0):(0) every ::::0 with points lc rgb '#808080' pt 1 ps 1 notitle", plot->script);
    draw_block(plot, shown->middles[0], "with points lc rgb '#1f4e8c' pt 7 ps 0.5", NULL);
    draw_block(plot, shown->middles[1], "with points lc rgb '#9c1c1c' pt 6 ps 0.7 lw 1.4", NULL);
    fprintf(plot->script,
            "\nset size noratio\nset lmargin at screen %d / W\nset rmargin at screen 1 - 10 / W\n",
            plot->frame.left);
}

/* A number tells the value that the scale leaves out. */
static void draw_beyond(wh_plot_t *plot, const shown_t *shown, int32_t i) {
    const wh_centring_record_t *centring = shown->centring;
    for (size_t k = 0; k < centring->count; ++k) {
        const double um = 1000 * wh_centring_residual(centring, i, k);
        if (fabs(um) > shown->scale) {
            fprintf(plot->script, "set label '%.1f' at first %zu, graph %s center textcolor rgb '%s'\n", um,
                    k + 1, um > 0 ? "0.94" : "0.06", i == 0 ? "#1f4e8c" : "#9c1c1c");
        }
    }
}

static void draw_residuals(wh_plot_t *plot, const shown_t *shown) {
    const wh_centring_record_t *centring = shown->centring;
    wh_plot_panel(plot, "residual (\u00b5m)");
    wh_plot_axis(plot, "crossings, in their order");
    fputs("set xtics (", plot->script);
    for (size_t k = 0; k < centring->count; ++k) {
        fprintf(plot->script, "%s'beam %d %s' %zu", k > 0 ? ", " : "", beam_of(shown, k),
                centring->crossings[k].crossing.edge == WH_CROSSING_IN ? "in" : "out", k + 1);
    }
    fprintf(plot->script,
            ")\nset xrange [0.5:%zu.5]\nset yrange [-%.6g:%.6g]\n"
            "set key at graph 1, graph 1.03 bottom right horizontal samplen 2\n",
            centring->count > 0 ? centring->count : 1, shown->scale, shown->scale);
    for (int32_t i = 0; i < centring->centres.count; ++i) {
        draw_beyond(plot, shown, i);
    }
    if (centring->centres.count == 0) {
        fputs("set label 3 'no place of the wafer is told' at graph 0.5, graph 0.6 center\n", plot->script);
    }
    fputs("plot 0 with lines lc rgb '#808080' lw 0.7 notitle", plot->script);
    draw_block(plot, shown->residuals[0], "with points lc rgb '#1f4e8c' pt 7 ps 0.5", title_of(centring, 0));
    draw_block(plot, shown->residuals[1], "with points lc rgb '#9c1c1c' pt 6 ps 0.7 lw 1.4",
               title_of(centring, 1));
    fputc('\n', plot->script);
}

static void make_centring(wh_plots_t *plots, size_t number, shown_t *shown) {
    static const wh_plot_frame_t frame = {.panels = 2, .panel_height = 260, .left = 66, .above = 70};
    const char *station = wh_record_station_name(shown->record, shown->centring->station);
    char of[WH_NAME_SIZE + 24];
    wh_plot_t plot;
    (void)snprintf(of, sizeof of, "%zu_%s", number, station);
    if (!wh_plots_open(plots, &plot, "centring", of)) {
        return;
    }
    wh_plot_begin(&plot, &frame, "A wafer as the beams at a door saw it, in the blade's frame", 0, 0);
    for (size_t i = 0; i < WH_CENTRING_LINES; ++i) {
        fprintf(plot.script, "# %s\n", shown->words.lines[i]);
    }
    put_data(&plot, shown);
    draw_blade(&plot, shown);
    draw_middle(&plot, shown);
    draw_residuals(&plot, shown);
    wh_plots_close(plots, &plot);
}

void wh_plots_centrings(wh_plots_t *plots) {
    const wh_record_t *record = plots->document->record;
    for (size_t i = 0; i < record->centring_count; ++i) {
        shown_t shown = {.record = record, .centring = &record->centrings[i]};
        wh_centring_words(record, shown.centring, &shown.words);
        make_centring(plots, i + 1, &shown);
    }
}
