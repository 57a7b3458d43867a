/* How the smallest gaps went over a run: a line of blocks for each kind that has a limit or was touched. */
#include <string.h>

#include "print_internal.h"

/* Columns of a curve, where the terminal has room for its name and scale beside it. */
#define MOST_COLUMNS 72
#define LEAST_COLUMNS 20
#define BESIDE_COLUMNS 42

#define LEVELS 8

/* A curve as it is drawn. */
typedef struct {
    size_t kind, columns;
    wh_real_t top; /* the gap of a full block; wider ones look the same */
    wh_real_t limit;
} plot_t;

static const char *block(const wh_style_t *style, size_t level) {
    static const char *const blocks[LEVELS] = {"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
    static const char *const letters[LEVELS] = {"_", ".", ":", "-", "=", "+", "*", "#"};
    return style->utf8 ? blocks[level] : letters[level];
}

/* A round scale in which limit and minimum can be told from much. */
static wh_real_t top_of(wh_real_t limit, wh_real_t least) {
    static const wh_real_t tops[] = {1, 2, 5, 10};
    const wh_real_t wanted = 3 * (limit > least ? limit : least);
    for (size_t i = 0; i < sizeof tops / sizeof tops[0]; ++i) {
        if (wanted <= tops[i]) {
            return tops[i];
        }
    }
    return WH_CLEARANCE_RANGE;
}

/* The smallest gap of the bins in a column. */
static wh_real_t gap_in_column(const wh_curves_t *curves, const plot_t *plot, size_t column) {
    wh_real_t least = WH_CLEARANCE_RANGE;
    for (size_t bin = 0; bin < curves->count; ++bin) {
        if (bin * plot->columns / curves->count == column && curves->gaps[plot->kind][bin] < least) {
            least = curves->gaps[plot->kind][bin];
        }
    }
    return least;
}

static void draw_curve(const wh_printer_t *report, const plot_t *plot) {
    for (size_t column = 0; column < plot->columns; ++column) {
        const wh_real_t gap = gap_in_column(report->record->curves, plot, column);
        const size_t level = gap < plot->top ? (size_t)(gap / plot->top * LEVELS) : LEVELS - 1;
        const bool bad = gap < plot->limit || !(gap > 0);
        wh_style_print(report->style, report->out, bad ? WH_INK_BAD : WH_INK_PLAIN, "%s",
                       block(report->style, level));
    }
}

/* Where in the curve the run's smallest gap is. */
static size_t column_of(const wh_curves_t *curves, const plot_t *plot, uint64_t slice) {
    const uint64_t all = curves->count * curves->slices;
    const uint64_t at = slice > curves->first ? slice - curves->first - 1 : 0;
    const uint64_t column = at * plot->columns / all;
    return column < plot->columns ? (size_t)column : plot->columns - 1;
}

static void print_curve(const wh_printer_t *report, const plot_t *plot) {
    const wh_record_t *record = report->record;
    const wh_clearance_t *least = &record->clearances[plot->kind];
    const int indent = (int)column_of(record->curves, plot, least->slice);
    fprintf(report->out, "%-24s  ", wh_print_clearance(plot->kind));
    draw_curve(report, plot);
    fprintf(report->out, "  0 to %g mm\n%26s%*s^ %.3f mm at %.3f s\n", (double)plot->top, "", indent, "",
            (double)least->gap, (double)((int64_t)least->slice * record->layout->slice_us) / 1e6);
}

static size_t columns_of(const wh_printer_t *report) {
    const size_t width = report->style->width;
    const size_t room = width > BESIDE_COLUMNS ? width - BESIDE_COLUMNS : 0;
    size_t columns = width == 0 || room > MOST_COLUMNS ? MOST_COLUMNS : room;
    columns = columns > LEAST_COLUMNS ? columns : LEAST_COLUMNS;
    return columns < report->record->curves->count ? columns : report->record->curves->count;
}

int wh_print_curves(const wh_printer_t *report) {
    const wh_record_t *record = report->record;
    bool titled = false;
    if (!record->checked || !record->curves || record->curves->count == 0) {
        return 0;
    }
    for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
        const wh_clearance_t *least = &record->clearances[kind];
        const wh_real_t limit = record->layout->world.limits[kind];
        if (least->parts[0] == WH_NONE || !(limit > 0 || !(least->gap > 0))) {
            continue;
        }
        if (!titled) {
            wh_print_title(report, "Clearances over time");
            titled = true;
        }
        const plot_t plot = {kind, columns_of(report), top_of(limit, least->gap), limit};
        print_curve(report, &plot);
    }
    return 0;
}
