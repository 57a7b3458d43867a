/* The fields of a layout that judge a run: wafer, tolerance, neighbourhood, checking, slice, seating. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../math/trig.h"
#include "layout_internal.h"

static double default_thickness(double diameter) {
    static const struct {
        double diameter, thickness;
    } standard[] = {{100, 0.525}, {125, 0.625}, {150, 0.675}, {200, 0.725}, {300, 0.775}};
    for (size_t i = 0; i < sizeof standard / sizeof standard[0]; ++i) {
        if (diameter <= standard[i].diameter) {
            return standard[i].thickness;
        }
    }
    return standard[4].thickness;
}

/* The notch shows people and prealigners how the wafer is turned. For the checks the wafer stays a disc. */
static void read_notch(wh_reader_t *reader, wh_layout_t *layout) {
    if (wh_reader_open(reader, "notch", "at depth")) {
        layout->notch = wh_rad_from_deg(wh_reader_number(reader, "at", 0, -360, 360));
        layout->notch_depth = wh_reader_number(reader, "depth", 1, 0, layout->wafer_diameter / 4);
        wh_reader_leave(reader);
    }
}

static void read_wafer(wh_reader_t *reader, wh_layout_t *layout) {
    layout->wafer_diameter = 300;
    layout->wafer_thickness = default_thickness(300);
    layout->notch_depth = 1;
    if (wh_reader_open(reader, "wafer", "diameter thickness notch")) {
        layout->wafer_diameter = wh_reader_number(reader, "diameter", 300, 1, 1000);
        layout->wafer_thickness =
            wh_reader_number(reader, "thickness", default_thickness(layout->wafer_diameter), 0.01, 100);
        read_notch(reader, layout);
        wh_reader_leave(reader);
    }
}

static void read_limits(wh_reader_t *reader, wh_tolerance_t *tolerance) {
    (void)wh_reader_open(reader, "tolerance", "projz projxy planar");
    tolerance->projz = wh_reader_number(reader, "projz", tolerance->projz, 1e-9, 1e6);
    tolerance->projxy = wh_reader_number(reader, "projxy", tolerance->projxy, 1e-6, 1e6);
    tolerance->planar = wh_reader_number(reader, "planar", tolerance->planar, 0, 0.999999999999);
    wh_reader_leave(reader);
}

static void read_tolerance(wh_reader_t *reader, wh_layout_t *layout) {
    const char *presets[WH_TOLERANCE_PRESETS + 1] = {NULL};
    const char *name = "own";
    for (size_t i = 0; i < WH_TOLERANCE_PRESETS; ++i) {
        presets[i] = wh_tolerance_preset(i, &layout->grasp.tolerance);
    }
    layout->grasp.tolerance = wh_tolerance_paper();
    const int type = wh_reader_push(reader, "tolerance");
    if (type != LUA_TTABLE && type != LUA_TNIL && type != LUA_TSTRING) {
        wh_reader_fail(reader, "tolerance", "\"paper\", \"strict\" or { projz = , projxy = , planar = }");
    }
    lua_pop(reader->L, 1);
    if (type == LUA_TTABLE) {
        read_limits(reader, &layout->grasp.tolerance);
    } else {
        const int preset = wh_reader_choice(reader, "tolerance", 0, presets);
        name = wh_tolerance_preset((size_t)preset, &layout->grasp.tolerance);
    }
    snprintf(layout->tolerance_name, sizeof layout->tolerance_name, "%s", name);
}

static void read_near(wh_reader_t *reader, wh_layout_t *layout) {
    const wh_real_t twice = 2 * layout->grasp.tolerance.projxy;
    layout->grasp.near_projxy = twice < WH_REAL(1e6) ? twice : WH_REAL(1e6);
    if (wh_reader_open(reader, "near", "projz projxy")) {
        layout->grasp.near_projz = wh_reader_number(reader, "projz", layout->grasp.near_projz, 1e-9, 1e6);
        layout->grasp.near_projxy = wh_reader_number(reader, "projxy", layout->grasp.near_projxy, 1e-9, 1e6);
        wh_reader_leave(reader);
    }
}

/* A slice is a whole number of microseconds, so that times of slices are exact. */
static void read_slice(wh_reader_t *reader, wh_layout_t *layout) {
    const double slice = wh_reader_number(reader, "slice", 0.001, 1e-6, 1);
    const double exact = slice * 1e6;
    layout->slice_us = llround(exact);
    if (fabs(exact - (double)layout->slice_us) > 1e-6 * exact) {
        lua_pushnumber(reader->L, slice);
        wh_reader_fail(reader, "slice", "a whole number of microseconds, in s");
    }
}

/* How a released wafer comes to lie, and the limits above which its place is reported. */
static void read_placing(wh_reader_t *reader, wh_cell_t *cell) {
    cell->settle = wh_reader_boolean(reader, "settle", false);
    if (wh_reader_open(reader, "placing", "off_centre askew")) {
        cell->off_centre = wh_reader_number(reader, "off_centre", 0, 0, 1000);
        cell->askew = wh_rad_from_deg(wh_reader_number(reader, "askew", 0, 0, 90));
        wh_reader_leave(reader);
    }
}

void wh_layout_read_checks(wh_reader_t *reader, wh_layout_t *layout) {
    static const char *const checks[] = {"sampled", "swept", NULL};
    layout->grasp = wh_grasp_config_default();
    read_wafer(reader, layout);
    read_tolerance(reader, layout);
    read_near(reader, layout);
    read_slice(reader, layout);
    layout->grasp.check =
        wh_reader_choice(reader, "check", 0, checks) == 0 ? WH_CHECK_SAMPLED : WH_CHECK_SWEPT;
    layout->grasp.seat = wh_reader_boolean(reader, "seat", false);
    read_placing(reader, &layout->cell);
}
