/* The smallest gaps of a run: of what, between which two parts, when, and against which limit. */
#include "print_internal.h"

enum { PAIR, GAP, LIMIT, AT, BETWEEN };

const char *wh_print_clearance(size_t kind) {
    static const char *const texts[WH_CLEARANCES] = {
        "blade to the wafer above", "blade to the wafer below", "blade to the cell", "held wafer to another",
        "held wafer to a ledge",    "held wafer to the cell",   "arm to the cell",   "arm to itself"};
    return texts[kind];
}

static wh_grid_t *new_grid(const wh_printer_t *report) {
    wh_grid_t *grid = wh_grid_new(report->style, 1);
    const wh_grid_digits_t gap = {3, 3, false, 0};
    wh_grid_text_column(grid, "smallest gap");
    wh_grid_number_column(grid, "mm", gap);
    wh_grid_text_column(grid, "limit mm");
    wh_grid_number_column(grid, "at s", wh_print_seconds());
    wh_grid_text_column(grid, "between");
    return grid;
}

static const char *part_name(const wh_printer_t *report, int32_t part) {
    const char *name = wh_layout_part_name(report->record->layout, part);
    return name ? name : "";
}

static void add_row(const wh_printer_t *report, wh_grid_t *grid, size_t kind) {
    const wh_clearance_t *least = &report->record->clearances[kind];
    const wh_layout_t *layout = report->record->layout;
    const wh_real_t limit = layout->world.limits[kind];
    const bool found = least->parts[0] != WH_NONE;
    const bool kept = !(least->gap < limit);
    if (!found && !(limit > 0)) {
        return;
    }
    wh_grid_row(grid);
    wh_grid_text(grid, PAIR, WH_INK_PLAIN, "%s", wh_print_clearance(kind));
    if (limit > 0) {
        wh_grid_text(grid, LIMIT, kept ? WH_INK_GOOD : WH_INK_BAD, "%g %s", (double)limit,
                     kept ? "kept" : "not kept");
    }
    if (!found) {
        wh_grid_text(grid, BETWEEN, WH_INK_DIM, "never nearer than %g mm", (double)WH_CLEARANCE_RANGE);
        return;
    }
    wh_grid_number(grid, GAP, kept ? WH_INK_PLAIN : WH_INK_BAD, (double)least->gap);
    wh_grid_number(grid, AT, WH_INK_PLAIN, (double)((int64_t)least->slice * layout->slice_us) / 1e6);
    wh_grid_text(grid, BETWEEN, WH_INK_PLAIN, "%s and %s", part_name(report, least->parts[0]),
                 part_name(report, least->parts[1]));
}

int wh_print_clearances(const wh_printer_t *report) {
    if (!report->record->checked) {
        return 0;
    }
    wh_grid_t *grid = new_grid(report);
    for (size_t kind = 0; kind < WH_CLEARANCES; ++kind) {
        add_row(report, grid, kind);
    }
    wh_print_title(report, "Clearances");
    return wh_grid_print(grid, report->out);
}
