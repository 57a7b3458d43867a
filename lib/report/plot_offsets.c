/* Where wafers lie in their slots at the end. */
#include <math.h>

#include "plots_internal.h"

/* With more wafers than these they are numbered. */
#define NAMED 40

/* Half of the least range that is drawn, mm. */
#define LEAST 0.1

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

/* Returns whether any lies far enough beside to be seen. */
static bool put_data(const wh_plots_t *plots, wh_plot_t *plot) {
    const wh_record_t *record = plots->document->record;
    double number = 0;
    bool is_seen = false;
    wh_plot_block(plot, "wafers that lie in slots", "number, dX (mm), dY (mm) in the slot's axes");
    for (size_t i = 0; i < plots->document->signals->layout->wafer_count; ++i) {
        if (lies(record, i)) {
            const wh_place_t *place = &record->wafers[i].place;
            const double offsets[] = {(double)place->dx, (double)place->dy};
            number += 1;
            is_seen = is_seen || fabs(offsets[0]) > LEAST || fabs(offsets[1]) > LEAST;
            wh_plot_row(plot, number, offsets, 2);
        }
    }
    (void)wh_plot_end_block(plot);
    return is_seen;
}

/* "Wafer 1 in B 2" below each. */
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
            wh_plot_put_text(plot->script, name);
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
    wh_plot_axis(&plot, count > NAMED ? "wafer" : "");
    fprintf(plot.script, "set xrange [0.5:%zu.5]\n", count);
    if (count <= NAMED) {
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
