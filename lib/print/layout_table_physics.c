#include "layout_table_internal.h"

#define MS WH_REAL(1e3)

static void begin(wh_grid_t *grid, const char *what) {
    wh_grid_row(grid);
    wh_grid_text(grid, 0, WH_INK_PLAIN, "%s", what);
}

static int print_holding(const wh_listing_t *listing) {
    const wh_vacuum_config_t *vacuum = &listing->layout->physics.vacuum;
    const wh_pads_t *pads = &listing->layout->physics.pads;
    wh_grid_t *grid = wh_grid_new(listing->style, 1);
    wh_grid_text_column(grid, "of all grippers");
    wh_grid_text_column(grid, "");
    if (vacuum->build <= 0 && vacuum->vent <= 0) {
        begin(grid, "vacuum");
        wh_grid_text(grid, 1, WH_INK_PLAIN, "ideal: an open valve holds at once");
    } else {
        begin(grid, "vacuum");
        wh_grid_text(grid, 1, WH_INK_PLAIN, "builds in %g ms, vents in %g ms, is at %g without a wafer",
                     (double)(vacuum->build * MS), (double)(vacuum->vent * MS), (double)vacuum->idle);
        begin(grid, "thresholds");
        wh_grid_text(grid, 1, WH_INK_PLAIN, "sensor on at %g, off below %g; lets go below %g",
                     (double)vacuum->on, (double)vacuum->off, (double)vacuum->release);
    }
    if (pads->mass > 0) {
        begin(grid, "pads");
        wh_grid_text(grid, 1, WH_INK_PLAIN, "friction %g, %g N of vacuum, a wafer of %.4g kg",
                     (double)pads->friction, (double)pads->force, (double)pads->mass);
    }
    return wh_listing_finish(listing, "Holding", grid);
}

/* ------------------------------------------------------------------------------------------------------ faults */

static const char *target_of(const wh_layout_t *layout, const wh_fault_t *fault) {
    if (fault->target == WH_NONE) {
        return "all";
    }
    return wh_fault_is_of_wafer(fault->kind) ? layout->wafers[fault->target].name
                                             : layout->grippers[fault->target].name;
}

static void add_fault(const wh_listing_t *listing, wh_grid_t *grid, const wh_fault_t *fault) {
    const double slice_s = (double)listing->layout->slice_us / 1e6;
    begin(grid, wh_fault_name(fault->kind));
    wh_grid_text(grid, 1, WH_INK_PLAIN, "%s", target_of(listing->layout, fault));
    wh_grid_text(grid, 2, WH_INK_PLAIN, "%.10g", (double)(fault->from - 1) * slice_s);
    if (fault->until == WH_FAULT_FOREVER) {
        wh_grid_text(grid, 3, WH_INK_DIM, "it is cleared");
    } else {
        wh_grid_text(grid, 3, WH_INK_PLAIN, "%.10g", (double)(fault->until - 1) * slice_s);
    }
    if (fault->kind == WH_FAULT_LEAK || fault->kind == WH_FAULT_SLOW_VACUUM) {
        wh_grid_text(grid, 4, WH_INK_PLAIN, "%g%s", (double)fault->value,
                     fault->kind == WH_FAULT_LEAK ? "" : " s");
    }
}

static int print_faults(const wh_listing_t *listing) {
    const wh_physics_t *physics = &listing->layout->physics;
    wh_grid_t *grid = wh_grid_new(listing->style, 1);
    wh_grid_text_column(grid, "fault");
    wh_grid_text_column(grid, "of");
    wh_grid_text_column(grid, "from s");
    wh_grid_text_column(grid, "until s");
    wh_grid_text_column(grid, "value");
    for (size_t i = 0; i < physics->fault_count; ++i) {
        add_fault(listing, grid, &physics->faults[i]);
    }
    return wh_listing_finish(listing, "Faults on purpose", grid);
}

int wh_listing_print_physics(const wh_listing_t *listing) {
    const int status = print_holding(listing);
    return status | print_faults(listing);
}
