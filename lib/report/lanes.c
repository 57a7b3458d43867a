#include "lanes.h"

#include <stdlib.h>

#include "../text/array.h"
#include "../text/utf8.h"

/* Half of the height that a bar or a signal takes in its lane. */
#define HALF 0.34

/* Pixels, except MOST_LETTERS: the number of letters of a name that have room. */
enum { ROW = 24, MOST_LETTERS = 28, LEAST_ABOVE = 6, LEAST_PITCH = 3 };

#define EDGED "using 1:3:1:2:($3-%g):($3+%g) with boxxyerror lw 0.6 dt 1 fc"
#define EDGE "border lc rgb '#000000'"

bool wh_plot_lanes_open(wh_plot_lanes_t *lanes, wh_plots_t *plots, const char *name, size_t count) {
    *lanes = (wh_plot_lanes_t){.plots = plots, .count = count, .above = LEAST_ABOVE};
    if (!wh_plots_open(plots, &lanes->plot, name, NULL)) {
        return false;
    }
    lanes->out = wh_memory_need(open_memstream(&lanes->tics, &lanes->size));
    return true;
}

/* A lane's height in the plot; the first lane is the highest. */
static double lane_height(const wh_plot_lanes_t *lanes, size_t lane) {
    return (double)(lanes->count - 1 - lane);
}

void wh_plot_lanes_name(wh_plot_lanes_t *lanes, const char *name, const char *what) {
    char text[WH_NAME_SIZE + 40];
    (void)snprintf(text, sizeof text, "%s%s%s", name, what[0] != '\0' ? " " : "", what);
    const size_t letters = wh_utf8_count(text);
    lanes->letters = letters > lanes->letters ? letters : lanes->letters;
    fputs(lanes->named > 0 ? ", " : "", lanes->out);
    wh_plot_put_tic(lanes->out, text);
    fprintf(lanes->out, " %g", lane_height(lanes, lanes->named++));
}

void wh_plot_lanes_begin(wh_plot_lanes_t *lanes, const char *title) {
    const size_t letters = lanes->letters < MOST_LETTERS ? lanes->letters : MOST_LETTERS;
    const wh_plot_frame_t frame = {.panels = 1,
                                   .panel_height = (int)lanes->count * ROW,
                                   .left = 14 + (int)(letters * 66 / 10),
                                   .above = lanes->above,
                                   .keys_wrap = lanes->above > LEAST_ABOVE};
    if (fclose(lanes->out) != 0) {
        wh_memory_out();
    }
    lanes->duration = lanes->plots->end_s - lanes->plots->begin_s;
    wh_plot_begin(&lanes->plot, &frame, title, lanes->plots->begin_s, lanes->plots->end_s);
    wh_plot_panel(&lanes->plot, "");
    fprintf(lanes->plot.script, "set yrange [-0.5:%zu.5]\nset ytics scale 0 (%s)\n", lanes->count - 1,
            lanes->tics);
    free(lanes->tics);
    lanes->tics = NULL;
}

void wh_plot_lanes_bar(wh_plot_lanes_t *lanes, size_t lane, double begin, double end) {
    const double values[] = {end, lane_height(lanes, lane)};
    wh_plot_row(&lanes->plot, begin, values, 2);
    ++lanes->bars;
}

void wh_plot_lanes_label(wh_plot_lanes_t *lanes, size_t lane, double begin, double end, const char *text,
                         bool on_dark) {
    wh_plot_fitting_label(&lanes->plot, begin, end, text);
    fprintf(lanes->plot.script, ", %g center front%s\n", lane_height(lanes, lane),
            on_dark ? " textcolor rgb '#ffffff'" : "");
}

/* Begins the next part of the plot command. */
static void put_part(wh_plot_lanes_t *lanes) {
    fputs(lanes->drawn++ == 0 ? "plot " : ", \\\n  ", lanes->plot.script);
}

/* Defines how bars are drawn: as boxes, or as strokes as wide as a lane. Strokes are used if the bars of a
 * lane are nearer to each other than LEAST_PITCH pixels on average. A box without an edge counts for a
 * pixel only if it covers the pixel's middle; strokes blend. */
static void put_styles(const wh_plot_lanes_t *lanes) {
    FILE *out = lanes->plot.script;
    fprintf(out,
            "dense = %d * %zu * abs(to_s - from_s) > (W - %d) * %.12g\n"
            "bars = dense ? \"using 1:3:($2-$1):(0) with vectors nohead lw %g dt 1 lc\" : \"",
            LEAST_PITCH, lanes->bars, lanes->plot.frame.left + 10, lanes->duration * (double)lanes->count,
            2 * HALF * ROW);
    fprintf(out, EDGED "\"\n", HALF, HALF);
    fputs("solid = dense ? '' : \"fs solid " EDGE "\"\n"
          "hatched = dense ? '' : \"fs pattern 4 " EDGE "\"\n"
          "crossed = dense ? '' : \"fs pattern 2 " EDGE "\"\n",
          out);
}

void wh_plot_lanes_draw(wh_plot_lanes_t *lanes, size_t block, const wh_plot_look_t *look) {
    if (block == SIZE_MAX) {
        return;
    }
    if (lanes->drawn == 0) {
        put_styles(lanes);
    }
    put_part(lanes);
    fprintf(lanes->plot.script, "'%s.dat' index %zu ", lanes->plot.name, block);
    if (look->keeps_edge) {
        fprintf(lanes->plot.script, EDGED " rgb '%s' fs %s " EDGE " ", HALF, HALF, look->colour, look->fill);
    } else {
        fprintf(lanes->plot.script, "@bars rgb '%s' @%s ", look->colour, look->fill);
    }
    if (look->text) {
        fprintf(lanes->plot.script, "title '%s'", look->text);
    } else {
        fputs("notitle", lanes->plot.script);
    }
}

void wh_plot_lanes_signal(wh_plot_lanes_t *lanes, size_t block, size_t lane, const char *style) {
    if (block == SIZE_MAX) {
        return;
    }
    put_part(lanes);
    fprintf(lanes->plot.script, "'%s.dat' index %zu using 1:(%g+%g*$2) with %s lt 1 notitle",
            lanes->plot.name, block, lane_height(lanes, lane) - HALF, 2 * HALF, style);
}

/* Ends the plot; gnuplot draws the empty lanes with NaN, since it refuses a plot command without
 * anything. */
void wh_plot_lanes_end(wh_plot_lanes_t *lanes) {
    fputs(lanes->drawn == 0 ? "plot NaN notitle\n" : "\n", lanes->plot.script);
    wh_plots_close(lanes->plots, &lanes->plot);
}
