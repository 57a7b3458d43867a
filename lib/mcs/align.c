/* Estimates the wafer on the chuck from a scan of its edge, with align/align.h, from the samples that the
 * states have brought (edge_scan.c).
 *
 * Motion control knows the sensor and the wafers from the layout, and the sensor's errors that a calibration
 * (calibration.c) has found. It does not know other true errors, such as a wafer's own rim. A sample that
 * never came counts as covered: an unseen part of the rim is not assumed to be without a notch. */
#include <stdlib.h>
#include <string.h>

#include "../align/align.h"
#include "../align/merge.h"
#include "../record/scans.h"
#include "../script/wh_module_values.h"
#include "../text/array.h"
#include "native.h"

/* The cost of an estimate in the instruction budget, for each sample. */
#define STEPS_PER_SAMPLE 4

/* The number of samples of each kind. */
typedef struct {
    int32_t rim, nothing, covered, missed;
} sights_t;

static void count_sight(sights_t *sights, wh_sight_t sight) {
    sights->rim += sight == WH_SIGHT_RIM ? 1 : 0;
    sights->nothing += sight == WH_SIGHT_NOTHING ? 1 : 0;
    sights->covered += sight == WH_SIGHT_COVERED ? 1 : 0;
}

static void make_points(const wh_mcs_edge_t *edge, const wh_sensor_t *sensor,
                        const wh_sensor_error_t *believed, size_t count, wh_rim_point_t points[],
                        sights_t *sights) {
    for (size_t i = 0; i < count; ++i) {
        const int32_t sample = (int32_t)i < edge->taken ? edge->samples[i] : WH_NONE;
        const int64_t k = edge->order.first + (edge->order.count > 0 ? (int64_t)i : -(int64_t)i);
        const wh_glance_t glance = {.turn = wh_sensor_angle(sensor, k),
                                    .speed = sample < 0 ? 0 : edge->speeds[i]};
        points[i] = wh_sensor_point(sensor, believed, &glance, sample < 0 ? 0 : sample);
        if (sample < 0) {
            points[i].sight = WH_SIGHT_COVERED;
            ++sights->missed;
        } else {
            count_sight(sights, points[i].sight);
        }
    }
}

/* The place of the scan's sample i in a turn. */
static size_t place_of(const wh_mcs_edge_t *edge, int32_t samples, size_t i) {
    const int64_t k = edge->order.first + (edge->order.count > 0 ? (int64_t)i : -(int64_t)i);
    return (size_t)((k % samples + samples) % samples);
}

/* Merges the kept turns into the last one. */
static void merge_turns(const wh_mcs_turns_t *turns, const wh_mcs_edge_t *edge, size_t count,
                        wh_rim_point_t points[]) {
    for (size_t i = 0; turns->turns > 0 && i < count; ++i) {
        wh_rim_point_t here[WH_MERGE_TURNS] = {points[i]};
        for (size_t t = 0; t < turns->turns; ++t) {
            here[t + 1] = turns->points[t * (size_t)turns->samples + place_of(edge, turns->samples, i)];
        }
        points[i] = wh_rim_points_merge(here, turns->turns + 1);
    }
}

void wh_mcs_free_turns(wh_mcs_turns_t *turns) {
    free(turns->points);
    *turns = (wh_mcs_turns_t){NULL, 0, 0};
}

/* The direction of the wafer's mark: of a notch, or of the primary flat. */
static void push_mark(lua_State *L, const wh_rim_t *nominal, const wh_align_result_t *result) {
    static const char *const names[] = {NULL, "notch", "primary flat", "secondary flat"};
    const bool is_notch = result->mark == WH_ALIGN_MARK_NOTCH;
    const double own = is_notch ? nominal->notch.direction : nominal->flats[0].direction;
    if (result->mark != WH_ALIGN_MARK_NONE) {
        wh_lua_set_text(L, "mark", names[result->mark]);
        wh_lua_set_number(L, "direction", result->turn + own);
        wh_lua_set_number(L, "sd_direction", result->sd_turn);
    }
}

static void push_circle(lua_State *L, const wh_align_result_t *result) {
    const wh_circle_t *circle = &result->circle;
    wh_lua_set_number(L, "x", circle->x);
    wh_lua_set_number(L, "y", circle->y);
    wh_lua_set_number(L, "radius", circle->radius);
    wh_lua_set_number(L, "sd_centre", circle->sd_centre);
    wh_lua_set_integer(L, "used", (lua_Integer)circle->used);
    wh_lua_set_integer(L, "masked", (lua_Integer)result->masked);
}

static void push_limits(lua_State *L, const wh_align_limits_t *limits, const wh_rim_t *nominal) {
    lua_createtable(L, 0, 7);
    wh_lua_set_number(L, "eccentricity", limits->eccentricity);
    wh_lua_set_number(L, "radius", nominal->radius);
    wh_lua_set_number(L, "radius_off", limits->radius_off);
    wh_lua_set_number(L, "sd_centre", limits->sd_centre);
    wh_lua_set_number(L, "sd_direction", limits->sd_turn);
    wh_lua_set_integer(L, "samples", WH_SCAN_LEAST);
    if (nominal->notch.depth > 0) {
        wh_lua_set_number(L, "notch_depth", nominal->notch.depth);
    }
    lua_setfield(L, -2, "limits");
}

/* Pushes the dent most like a notch, if a notch was looked for. */
static void push_seen_notch(lua_State *L, const wh_notch_seen_t *seen) {
    if (seen->depth_most > 0) {
        wh_lua_set_number(L, "notch_depth", seen->depth);
        wh_lua_set_number(L, "notch_least", seen->depth_least);
        wh_lua_set_number(L, "notch_most", seen->depth_most);
        wh_lua_set_integer(L, "flank_right", (lua_Integer)seen->flanks[0]);
        wh_lua_set_integer(L, "flank_left", (lua_Integer)seen->flanks[1]);
        wh_lua_set_integer(L, "flank_least", WH_NOTCH_FLANK_LEAST);
        wh_lua_set_integer(L, "notch_off", (lua_Integer)seen->off);
        wh_lua_set_number(L, "narrow_at", seen->narrow_at);
        wh_lua_set_number(L, "width", seen->width);
        wh_lua_set_number(L, "width_least", seen->width_least);
    }
}

static void push_sights(lua_State *L, const sights_t *sights) {
    wh_lua_set_integer(L, "seen", sights->rim);
    wh_lua_set_integer(L, "nothing", sights->nothing);
    wh_lua_set_integer(L, "covered", sights->covered);
    wh_lua_set_integer(L, "missed", sights->missed);
}

static wh_sensor_error_t read_believed(lua_State *L, int argument) {
    static const char *const names[] = {"offset", "zero", "gain", "latency"};
    wh_sensor_error_t error = {0, 0, 0, 0};
    double *const fields[] = {&error.offset, &error.zero, &error.gain, &error.latency};
    luaL_checktype(L, argument, LUA_TTABLE);
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
        lua_getfield(L, argument, names[i]);
        *fields[i] = luaL_checknumber(L, -1);
        lua_pop(L, 1);
    }
    return error;
}

static size_t count_of(const wh_mcs_edge_t *edge) {
    return (size_t)(edge->order.count < 0 ? -edge->order.count : edge->order.count);
}

/* native.keep_turn(believed): the last scan, a turn, is of the next scan's wafer: estimates use both. */
static int keep_turn(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_mcs_turns_t *turns = &mcs->measuring.turns;
    const wh_mcs_edge_t *edge = &mcs->measuring.edge;
    const wh_scanner_t *scanner = wh_layout_scanner(mcs->layout, edge->order.gripper);
    const wh_sensor_error_t believed = read_believed(L, 1);
    luaL_argcheck(L, edge->samples && scanner && turns->turns + 1 < WH_MERGE_TURNS, 1, "no turn to be kept");
    const size_t count = count_of(edge);
    const size_t samples = (size_t)scanner->sensor.samples;
    wh_rim_point_t *points = lua_newuserdatauv(L, count * sizeof *points, 0);
    sights_t sights = {0, 0, 0, 0};
    make_points(edge, &scanner->sensor, &believed, count, points, &sights);
    if (!turns->points) {
        turns->points = wh_array_new(WH_MERGE_TURNS * samples, sizeof *turns->points);
        turns->samples = scanner->sensor.samples;
    }
    for (size_t i = 0; i < count; ++i) {
        turns->points[turns->turns * samples + place_of(edge, turns->samples, i)] = points[i];
    }
    ++turns->turns;
    return 0;
}

/* native.forget_turns(): the next scan is used alone. */
static int forget_turns(lua_State *L) {
    wh_mcs_free_turns(&wh_mcs_with_layout(L)->measuring.turns);
    return 0;
}

/* native.estimate_edge(with marks, glass, believed { offset, zero, gain, latency }): estimates the wafer
 * from the last scan and the kept turns, for a sensor with these errors, all in the chuck's frame, mm and
 * rad. Returns `verdict`, the name of a status; the numbers of samples, by kind; the `limits`; with a circle
 * its centre, `x` and `y`; the dent most like a notch, if one was looked for; with a verdict of OK and a
 * mark the `mark` and its `direction`. */
static int estimate_edge(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_mcs_edge_t *edge = &mcs->measuring.edge;
    const wh_scanner_t *scanner = wh_layout_scanner(mcs->layout, edge->order.gripper);
    luaL_argcheck(L, edge->samples && scanner, 1, "there was no scan");
    const size_t count = count_of(edge);
    const wh_edge_wish_t wish = {lua_toboolean(L, 1) == 0, luaL_checknumber(L, 2)};
    const wh_rim_t nominal = wh_edge_wish_rim(mcs->layout->nominal_rim, wish);
    const wh_align_limits_t limits = wh_align_limits_default();
    const wh_sensor_error_t believed = read_believed(L, 3);
    wh_rim_point_t *points = lua_newuserdatauv(L, count * sizeof *points, 0);
    wh_rim_ray_t *rays = lua_newuserdatauv(L, count * sizeof *rays, 0);
    wh_align_result_t result;
    sights_t sights;
    memset(&result, 0, sizeof result);
    memset(&sights, 0, sizeof sights);
    wh_decisions_measured(mcs->wanted.decisions, "a scan of a wafer's edge");
    wh_sandbox_charge(L, STEPS_PER_SAMPLE * (uint64_t)count);
    make_points(edge, &scanner->sensor, &believed, count, points, &sights);
    merge_turns(&mcs->measuring.turns, edge, count, points);
    const wh_rim_scan_t scan = {points, count, believed.offset, scanner->sensor.pixel};
    const wh_status_t status = wh_align_estimate(&scan, &scanner->sensor, &nominal, &limits, rays, &result);
    lua_createtable(L, 0, 28);
    wh_lua_set_text(L, "verdict", wh_status_name(status == WH_OK ? result.verdict : status));
    push_sights(L, &sights);
    push_limits(L, &limits, &nominal);
    if (result.circle.used > 0) {
        push_circle(L, &result);
        push_seen_notch(L, &result.notch_seen);
    }
    if (status == WH_OK && result.verdict == WH_OK) {
        push_mark(L, &nominal, &result);
    }
    return 1;
}

const luaL_Reg wh_mcs_align_functions[] = {
    {"estimate_edge", estimate_edge}, {"keep_turn", keep_turn}, {"forget_turns", forget_turns}, {NULL, NULL}};
