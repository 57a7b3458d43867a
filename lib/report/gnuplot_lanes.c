#include "gnuplot_lanes.h"

#include <stdlib.h>
#include <string.h>

#include "../text/utf8.h"

/* Pixels; names have room for so many letters. */
enum { ROW = 24, MOST_LETTERS = 28, LEAST_ABOVE = 6, LEAST_PITCH = 3 };

#define EDGED "using 1:3:1:2:($3-%g):($3+%g) with boxxyerror lw 0.6 dt 1 fc"
#define EDGE "border lc rgb '#000000'"

void wh_lanes_open(wh_lanes_t *lanes, wh_plot_t *plot, size_t count) {
    memset(lanes, 0, sizeof *lanes);
    lanes->plot = plot;
    lanes->count = count;
    lanes->above = LEAST_ABOVE;
    lanes->out = open_memstream(&lanes->tics, &lanes->size);
    if (!lanes->out) {
        abort();
    }
}

double wh_lanes_height(const wh_lanes_t *lanes, size_t lane) {
    return (double)(lanes->count - 1 - lane);
}

void wh_lanes_name(wh_lanes_t *lanes, const char *name, const char *what) {
    char text[WH_NAME_SIZE + 40];
    (void)snprintf(text, sizeof text, "%s%s%s", name, what[0] != '\0' ? " " : "", what);
    const size_t letters = wh_utf8_count(text);
    lanes->letters = letters > lanes->letters ? letters : lanes->letters;
    fputs(lanes->named > 0 ? ", " : "", lanes->out);
    wh_plot_put_text(lanes->out, text);
    fprintf(lanes->out, " %g", wh_lanes_height(lanes, lanes->named++));
}

void wh_lanes_begin(wh_lanes_t *lanes, const wh_plots_t *plots, const char *title) {
    const size_t letters = lanes->letters < MOST_LETTERS ? lanes->letters : MOST_LETTERS;
    const wh_plot_frame_t frame = {.panels = 1,
                                   .panel_height = (int)lanes->count * ROW,
                                   .left = 14 + (int)(letters * 66 / 10),
                                   .above = lanes->above,
                                   .keys_wrap = lanes->above > LEAST_ABOVE};
    if (fclose(lanes->out) != 0) {
        abort();
    }
    lanes->duration = wh_plots_end_s(plots) - wh_plots_begin_s(plots);
    wh_plot_begin(lanes->plot, &frame, title, wh_plots_begin_s(plots), wh_plots_end_s(plots));
    wh_plot_panel(lanes->plot, "");
    fprintf(lanes->plot->script, "set yrange [-0.5:%zu.5]\nset ytics scale 0 (%s)\n", lanes->count - 1,
            lanes->tics);
    free(lanes->tics);
    lanes->tics = NULL;
}

void wh_lanes_bar(wh_lanes_t *lanes, size_t lane, double begin, double end) {
    const double values[] = {end, wh_lanes_height(lanes, lane)};
    wh_plot_row(lanes->plot, begin, values, 2);
    ++lanes->bars;
}

void wh_lanes_label(wh_lanes_t *lanes, size_t lane, double begin, double end, const char *text,
                    bool on_dark) {
    wh_plot_fitting_label(lanes->plot, begin, end, text);
    fprintf(lanes->plot->script, ", %g center front%s\n", wh_lanes_height(lanes, lane),
            on_dark ? " textcolor rgb '#ffffff'" : "");
}

/* A plot command's next part. */
static void put_part(wh_lanes_t *lanes) {
    fputs(lanes->drawn++ == 0 ? "plot " : ", \\\n  ", lanes->plot->script);
}

/* What bars are drawn with: as boxes, or, those of a lane being nearer to each other than LEAST_PITCH on average, as strokes as
 * wide as a lane. Boxes without an edge are sampled where a pixel's middle is, strokes are blended. */
static void put_styles(const wh_lanes_t *lanes) {
    FILE *out = lanes->plot->script;
    fprintf(out,
            "dense = %d * %zu * abs(to_s - from_s) > (W - %d) * %.12g\n"
            "bars = dense ? \"using 1:3:($2-$1):(0) with vectors nohead lw %g dt 1 lc\" : \"",
            LEAST_PITCH, lanes->bars, lanes->plot->frame.left + 10, lanes->duration * (double)lanes->count,
            2 * WH_LANES_HALF * ROW);
    fprintf(out, EDGED "\"\n", WH_LANES_HALF, WH_LANES_HALF);
    fputs("solid = dense ? '' : \"fs solid " EDGE "\"\n"
          "hatched = dense ? '' : \"fs pattern 4 " EDGE "\"\n"
          "crossed = dense ? '' : \"fs pattern 2 " EDGE "\"\n",
          out);
}

void wh_lanes_draw_bars(wh_lanes_t *lanes, size_t block, const wh_lanes_look_t *look) {
    if (block == SIZE_MAX) {
        return;
    }
    if (lanes->drawn == 0) {
        put_styles(lanes);
    }
    put_part(lanes);
    fprintf(lanes->plot->script, "'%s.dat' index %zu ", lanes->plot->name, block);
    if (look->keeps_edge) {
        fprintf(lanes->plot->script, EDGED " rgb '%s' fs %s " EDGE " ", WH_LANES_HALF, WH_LANES_HALF,
                look->colour, look->fill);
    } else {
        fprintf(lanes->plot->script, "@bars rgb '%s' @%s ", look->colour, look->fill);
    }
    if (look->text) {
        fprintf(lanes->plot->script, "title '%s'", look->text);
    } else {
        fputs("notitle", lanes->plot->script);
    }
}

void wh_lanes_draw_signal(wh_lanes_t *lanes, size_t block, size_t lane, const char *style) {
    if (block == SIZE_MAX) {
        return;
    }
    put_part(lanes);
    fprintf(lanes->plot->script, "'%s.dat' index %zu using 1:(%g+%g*$2) with %s lt 1 notitle",
            lanes->plot->name, block, wh_lanes_height(lanes, lane) - WH_LANES_HALF, 2 * WH_LANES_HALF, style);
}

/* A plot command without anything is an error: then lanes are drawn that are empty. */
void wh_lanes_end(wh_lanes_t *lanes) {
    if (lanes->drawn == 0) {
        fputs("plot NaN notitle", lanes->plot->script);
    }
    fputc('\n', lanes->plot->script);
}
