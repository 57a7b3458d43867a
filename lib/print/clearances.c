/* The smallest gaps of a run: their kind, the two parts, the time and the limit; and the gaps over time. */
#include "print_internal.h"

/* Columns of a curve. Its name and its scale stand beside it. */
#define MOST_COLUMNS 72
#define LEAST_COLUMNS 20
#define BESIDE_COLUMNS 42

#define LEVELS 8

enum { PAIR, GAP, LIMIT, AT, BETWEEN };

/* The things that a kind of clearance lies between, in words: at most 24 letters. */
static const char *const clearances[WH_CLEARANCES] = {
    "blade to the wafer above", "blade to the wafer below", "blade to the cell", "held wafer to another",
    "held wafer to a ledge",    "held wafer to the cell",   "arm to the cell",   "arm to itself"};

static const char *part_name(const wh_printer_t *printer, int32_t part) {
    const char *name = wh_layout_part_name(printer->record->layout, part);
    return name ? name : "";
}

static void add_row(const wh_printer_t *printer, wh_grid_t *grid, size_t kind) {
    const wh_clearance_t *least = &printer->record->clearances[kind];
    const wh_layout_t *layout = printer->record->layout;
    const wh_real_t limit = layout->world.limits[kind];
    const bool found = least->parts[0] != WH_NONE;
    const bool kept = wh_clearance_is_kept(least->gap, limit);
    if (!found && !(limit > 0)) {
        return;
    }
    wh_grid_named_row(grid, clearances[kind]);
    if (limit > 0) {
        wh_grid_text(grid, LIMIT, kept ? WH_INK_GOOD : WH_INK_BAD, "%g %s", limit,
                     kept ? "kept" : "not kept");
    }
    if (!found) {
        wh_grid_text(grid, BETWEEN, WH_INK_DIM, "never nearer than %g mm", WH_CLEARANCE_RANGE);
        return;
    }
    wh_grid_number(grid, GAP, kept ? WH_INK_PLAIN : WH_INK_BAD, least->gap);
    wh_grid_number(grid, AT, WH_INK_PLAIN, (double)((int64_t)least->slice * layout->slice_us) / 1e6);
    wh_grid_text(grid, BETWEEN, WH_INK_PLAIN, "%s and %s", part_name(printer, least->parts[0]),
                 part_name(printer, least->parts[1]));
}

/* ---------------------------------------------------------------------------------------------- over time */

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

/* A round scale, at least three times limit and minimum. */
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

static void draw_curve(const wh_printer_t *printer, const plot_t *plot) {
    for (size_t column = 0; column < plot->columns; ++column) {
        const wh_real_t gap = gap_in_column(printer->record->curves, plot, column);
        const size_t level = gap < plot->top ? (size_t)(gap / plot->top * LEVELS) : LEVELS - 1;
        const bool bad = gap < plot->limit || !(gap > 0);
        wh_style_print(printer->style, printer->out, bad ? WH_INK_BAD : WH_INK_PLAIN, "%s",
                       block(printer->style, level));
    }
}

/* The column with the run's smallest gap. */
static size_t column_of(const wh_curves_t *curves, const plot_t *plot, uint64_t slice) {
    const uint64_t all = curves->count * curves->slices;
    const uint64_t at = slice > curves->first ? slice - curves->first - 1 : 0;
    const uint64_t column = at * plot->columns / all;
    return column < plot->columns ? (size_t)column : plot->columns - 1;
}

static void print_curve(const wh_printer_t *printer, const plot_t *plot) {
    const wh_record_t *record = printer->record;
    const wh_clearance_t *least = &record->clearances[plot->kind];
    const int indent = (int)column_of(record->curves, plot, least->slice);
    fprintf(printer->out, "%-24s  ", clearances[plot->kind]);
    draw_curve(printer, plot);
    fprintf(printer->out, "  0 to %g mm\n%26s%*s^ %.3f mm at %.3f s\n", plot->top, "", indent, "", least->gap,
            (double)((int64_t)least->slice * record->layout->slice_us) / 1e6);
}

static size_t columns_of(const wh_printer_t *printer) {
    const size_t width = printer->style->width;
    const size_t room = width > BESIDE_COLUMNS ? width - BESIDE_COLUMNS : 0;
    size_t columns = width == 0 || room > MOST_COLUMNS ? MOST_COLUMNS : room;
    columns = columns > LEAST_COLUMNS ? columns : LEAST_COLUMNS;
    return columns < printer->record->curves->count ? columns : printer->record->curves->count;
}

static void print_curves(const wh_printer_t *printer) {
    const wh_record_t *record = printer->record;
    bool titled = false;
    if (!record->curves || record->curves->count == 0) {
        return;
    }
    for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
        const wh_clearance_t *least = &record->clearances[kind];
        const wh_real_t limit = record->layout->world.limits[kind];
        if (least->parts[0] == WH_NONE || !(limit > 0 || !(least->gap > 0))) {
            continue;
        }
        if (!titled) {
            wh_print_title(printer, "Clearances over time");
            titled = true;
        }
        const plot_t plot = {kind, columns_of(printer), top_of(limit, least->gap), limit};
        print_curve(printer, &plot);
    }
}

void wh_print_clearances(const wh_printer_t *printer) {
    if (!printer->record->checked) {
        return;
    }
    wh_grid_t *grid = wh_grid_new(printer->style, 1, "smallest gap;mm{3};limit mm;at s{3,6};between");
    for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
        add_row(printer, grid, kind);
    }
    wh_print_titled(printer, "Clearances", grid);
    print_curves(printer);
}
