/* Calibrating an edge sensor: scans of a wafer that a robot carried from place to place, and the
 * sensor's errors from them (align/calibration.h). lua/mcs/calibration.lua moves arm and chuck. */
#include "../align/calibration.h"

#include <math.h>
#include <string.h>

#include "../script/wh_module_values.h"
#include "native.h"

/* The name of the type of userdata. */
#define TURN "wh.edge_turn"
/* Samples whose speed differs by more than this share from that of most samples do not count. */
#define STEADY 1e-3
/* The cost of an estimate in the instruction budget, for each sample. */
#define STEPS_PER_SAMPLE 20

/* A scan for the calibration, without believed errors. */
typedef struct {
    double speed;
    size_t count;
    wh_rim_point_t points[];
} turn_t;

void wh_mcs_push_sensor_error(lua_State *L, const wh_sensor_error_t *error) {
    lua_createtable(L, 0, 4);
    wh_lua_set_number(L, "offset", error->offset);
    wh_lua_set_number(L, "zero", error->zero);
    wh_lua_set_number(L, "gain", error->gain);
    wh_lua_set_number(L, "latency", error->latency);
}

static wh_rim_point_t point_of(const wh_mcs_edge_t *edge, const wh_sensor_t *sensor, size_t i, double speed) {
    const int64_t k = edge->order.first + (edge->order.count > 0 ? (int64_t)i : -(int64_t)i);
    const bool is_here = (int32_t)i < edge->taken && edge->samples[i] != WH_NONE;
    const wh_glance_t glance = {.turn = wh_sensor_angle(sensor, k)};
    wh_rim_point_t point = wh_sensor_point(sensor, NULL, &glance, is_here ? edge->samples[i] : 0);
    if (!is_here || fabs(edge->speeds[i] - speed) > STEADY * fabs(speed)) {
        point.sight = WH_SIGHT_COVERED;
    }
    return point;
}

/* native.edge_turn(): the last scan as a value for native.calibrate. The chuck reaches its speed before the
 * first sample or soon after it, so it has that speed in the middle of the turn. */
static int edge_turn(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_mcs_edge_t *edge = &mcs->measuring.edge;
    const wh_scanner_t *scanner = wh_layout_scanner(mcs->layout, edge->order.gripper);
    luaL_argcheck(L, edge->samples && scanner, 1, "there was no scan");
    const size_t count = (size_t)(edge->order.count < 0 ? -edge->order.count : edge->order.count);
    turn_t *turn = lua_newuserdatauv(L, sizeof *turn + count * sizeof *turn->points, 0);
    wh_decisions_measured(mcs->wanted.decisions, "a scan of a wafer's edge");
    wh_sandbox_charge(L, (uint64_t)count);
    turn->count = count;
    turn->speed = edge->taken > 0 ? edge->speeds[edge->taken / 2] : 0;
    for (size_t i = 0; i < count; ++i) {
        turn->points[i] = point_of(edge, &scanner->sensor, i, turn->speed);
    }
    (void)luaL_newmetatable(L, TURN);
    lua_setmetatable(L, -2);
    return 1;
}

static wh_calibration_scan_t read_scan(lua_State *L, int list, int place) {
    wh_calibration_scan_t scan;
    memset(&scan, 0, sizeof scan);
    lua_rawgeti(L, list, place);
    lua_getfield(L, -1, "way_x");
    lua_getfield(L, -2, "way_y");
    lua_getfield(L, -3, "turn");
    const turn_t *turn = luaL_checkudata(L, -1, TURN);
    scan.points = turn->points;
    scan.count = turn->count;
    scan.speed = turn->speed;
    scan.way_x = luaL_checknumber(L, -3);
    scan.way_y = luaL_checknumber(L, -2);
    lua_pop(L, 4);
    return scan;
}

static void push_calibration(lua_State *L, const wh_calibration_t *found) {
    wh_mcs_push_sensor_error(L, &found->error);
    wh_lua_set_number(L, "sd_offset", found->sd_offset);
    wh_lua_set_number(L, "sd_zero", found->sd_zero);
    wh_lua_set_number(L, "sd_gain", found->sd_gain);
    wh_lua_set_number(L, "sd_latency", found->sd_latency);
    wh_lua_set_number(L, "x", found->x);
    wh_lua_set_number(L, "y", found->y);
    wh_lua_set_number(L, "mismatch", found->mismatch);
}

/* native.calibrate(chuck, list of { turn, way_x, way_y }, radius, sd_way): the errors of the sensor at the
 * chuck, { offset, zero, gain, latency, sd_offset, sd_zero, sd_gain, sd_latency, mismatch, x, y: of the
 * wafer's centre in the first scan }; or nil, the name of the status, and the scan's number, from 1, if
 * only one scan is wrong. */
static int calibrate_sensor(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_scanner_t *scanner =
        wh_layout_scanner(mcs->layout, wh_mcs_index(L, 1, mcs->state.gripper_count));
    wh_calibration_scan_t scans[WH_CALIBRATION_SCANS];
    wh_calibration_t found;
    int32_t bad = WH_NONE;
    size_t longest = 1;
    luaL_checktype(L, 2, LUA_TTABLE);
    const size_t count = lua_rawlen(L, 2);
    luaL_argcheck(L, scanner && count <= WH_CALIBRATION_SCANS, 2, "too many scans");
    for (size_t i = 0; i < count; ++i) {
        scans[i] = read_scan(L, 2, (int)i + 1);
        longest = scans[i].count > longest ? scans[i].count : longest;
    }
    wh_rim_point_t *points = lua_newuserdatauv(L, longest * sizeof *points, 0);
    wh_rim_ray_t *rays = lua_newuserdatauv(L, longest * sizeof *rays, 0);
    wh_sandbox_charge(L, STEPS_PER_SAMPLE * (uint64_t)longest * count);
    const wh_status_t status =
        wh_calibration_solve(&scanner->sensor, luaL_checknumber(L, 3), luaL_checknumber(L, 4), scans, count,
                             points, rays, &found, &bad);
    if (status == WH_OK) {
        push_calibration(L, &found);
        return 1;
    }
    lua_pushnil(L);
    lua_pushstring(L, wh_status_name(status));
    if (bad != WH_NONE) {
        lua_pushinteger(L, bad + 1);
    }
    return bad != WH_NONE ? 3 : 2;
}

const luaL_Reg wh_mcs_calibration_functions[] = {
    {"edge_turn", edge_turn}, {"calibrate", calibrate_sensor}, {NULL, NULL}};
