/* What a scan of a wafer's edge says of the wafer on the chuck: the estimate of align/align.h over the
 * samples that the states have brought (edge_scan.c).
 *
 * Motion control knows the sensor and the wafers as the layout says they should be. What is truly off, such
 * as a sensor's latency or one wafer's own rim, it does not know. A sample that never came counts as one that
 * something covers: what is not seen is not told to be without a notch. */
#include <string.h>

#include "../align/align.h"
#include "../script/wh_module_values.h"
#include "native.h"

/* What an estimate costs of the instruction budget, for each sample. */
#define STEPS_PER_SAMPLE 4

/* How many samples are of each kind. */
typedef struct {
    int32_t rim, nothing, covered, missed;
} sights_t;

static void count_sight(sights_t *sights, wh_sight_t sight) {
    sights->rim += sight == WH_SIGHT_RIM ? 1 : 0;
    sights->nothing += sight == WH_SIGHT_NOTHING ? 1 : 0;
    sights->covered += sight == WH_SIGHT_COVERED ? 1 : 0;
}

static void make_points(const wh_mcs_edge_t *edge, const wh_sensor_t *sensor, size_t count,
                        wh_rim_point_t points[], sights_t *sights) {
    for (size_t i = 0; i < count; ++i) {
        const int32_t sample = (int32_t)i < edge->taken ? edge->samples[i] : WH_NONE;
        const int64_t k = edge->order.first + (edge->order.count > 0 ? (int64_t)i : -(int64_t)i);
        const wh_glance_t glance = {.turn = wh_sensor_angle(sensor, k)};
        points[i] = wh_sensor_point(sensor, NULL, &glance, sample < 0 ? 0 : sample);
        if (sample < 0) {
            points[i].sight = WH_SIGHT_COVERED;
            ++sights->missed;
        } else {
            count_sight(sights, points[i].sight);
        }
    }
}

/* What the wafer should be; without marks if these are not to be looked for. `glass`: the light that comes
 * through it. */
static wh_rim_t expected_rim(const wh_rim_t *nominal, bool with_marks, double glass) {
    wh_rim_t rim = *nominal;
    rim.transmission = glass;
    if (!with_marks) {
        rim.notch.depth = 0;
        memset(rim.flats, 0, sizeof rim.flats);
    }
    return rim;
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

static void push_sights(lua_State *L, const sights_t *sights) {
    wh_lua_set_integer(L, "seen", sights->rim);
    wh_lua_set_integer(L, "nothing", sights->nothing);
    wh_lua_set_integer(L, "covered", sights->covered);
    wh_lua_set_integer(L, "missed", sights->missed);
}

/* native.estimate_edge(with marks, glass): what the last scan says of its wafer, all in the chuck's frame, mm
 * and rad: `verdict`, the name of a status; the numbers of samples, by what they see; the `limits`; with a
 * circle its centre, `x` and `y`; with a verdict of OK and a mark the `mark` and its `direction`. */
static int estimate_edge(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_mcs_edge_t *edge = &mcs->edge;
    const wh_scanner_t *scanner = wh_layout_scanner(mcs->layout, edge->order.gripper);
    luaL_argcheck(L, edge->samples && scanner, 1, "there was no scan");
    const size_t count = (size_t)(edge->order.count < 0 ? -edge->order.count : edge->order.count);
    const wh_rim_t nominal =
        expected_rim(mcs->layout->nominal_rim, lua_toboolean(L, 1) != 0, luaL_checknumber(L, 2));
    const wh_align_limits_t limits = wh_align_limits_default();
    wh_rim_point_t *points = lua_newuserdatauv(L, count * sizeof *points, 0);
    wh_rim_ray_t *rays = lua_newuserdatauv(L, count * sizeof *rays, 0);
    wh_align_result_t result;
    sights_t sights;
    memset(&result, 0, sizeof result);
    memset(&sights, 0, sizeof sights);
    wh_decisions_measured(mcs->decisions, "a scan of a wafer's edge");
    wh_sandbox_charge(L, STEPS_PER_SAMPLE * (uint64_t)count);
    make_points(edge, &scanner->sensor, count, points, &sights);
    const wh_rim_scan_t scan = {points, count, 0, scanner->sensor.pixel};
    const wh_status_t status = wh_align_estimate(&scan, &scanner->sensor, &nominal, &limits, rays, &result);
    lua_createtable(L, 0, 16);
    wh_lua_set_text(L, "verdict", wh_status_name(status == WH_OK ? result.verdict : status));
    push_sights(L, &sights);
    push_limits(L, &limits, &nominal);
    if (result.circle.used > 0) {
        push_circle(L, &result);
    }
    if (status == WH_OK && result.verdict == WH_OK) {
        push_mark(L, &nominal, &result);
    }
    return 1;
}

const luaL_Reg wh_mcs_align_functions[] = {{"estimate_edge", estimate_edge}, {NULL, NULL}};
