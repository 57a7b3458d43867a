/* Edge scans: the sensor at a prealigner is armed with the next slice's command, and the samples that the
 * states bring are collected.
 *
 * Each state carries the samples of its own slice, and the number of samples up to it. So states that
 * come twice add nothing. States that never came (in a free run) leave holes, which are counted. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../math/trig.h"
#include "../script/wh_module_values.h"
#include "../text/array.h"
#include "native.h"

static int32_t magnitude_of_count(int32_t count) {
    return count < 0 ? -count : count;
}

static bool is_of(const wh_mcs_edge_t *edge, const wh_scan_t *scan) {
    const wh_scan_order_t *order = &edge->order;
    return edge->samples && scan->number > edge->before && scan->gripper == order->gripper &&
           scan->count == order->count && scan->first == order->first;
}

/* Follows the chuck's speed, as the sensor sees it. A scan's last state does not tell the turn. */
static void follow_chuck(wh_mcs_edge_t *edge, const wh_scan_t *scan, double slice_s) {
    if (!scan->armed) {
        return;
    }
    if (edge->turn_seq > 0) {
        edge->speed = (scan->turn - edge->turn) / ((double)(edge->seq - edge->turn_seq) * slice_s);
    }
    edge->turn = scan->turn;
    edge->turn_seq = edge->seq;
}

static void collect_samples(wh_mcs_edge_t *edge, const wh_scan_t *scan) {
    const int32_t begin = scan->taken - scan->sample_count;
    for (; edge->taken < begin; ++edge->taken) {
        edge->samples[edge->taken] = WH_NONE;
        ++edge->missed;
    }
    for (; edge->taken < scan->taken; ++edge->taken) {
        edge->samples[edge->taken] = scan->samples[edge->taken - begin];
        edge->speeds[edge->taken] = edge->speed;
    }
    edge->armed = scan->armed;
}

/* Takes only a state of a later slice than the last one: in a free run a state may come again. */
void wh_mcs_hear(wh_mcs_t *mcs, const wh_state_t *state) {
    wh_mcs_edge_t *edge = &mcs->measuring.edge;
    if (!state->physics || state->seq <= edge->seq) {
        return;
    }
    const wh_scan_t *scan = &state->physics->scan;
    const bool was_armed = edge->armed;
    edge->seq = state->seq;
    edge->number = scan->number;
    wh_pass_hear(&mcs->measuring.pass, state);
    if (is_of(edge, scan)) {
        follow_chuck(edge, scan, (double)mcs->layout->slice_us / 1e6);
        collect_samples(edge, scan);
        if (was_armed && !edge->armed) {
            wh_mcs_tell(mcs, WH_MCS_EDGE_SCANNED, NULL);
        }
    }
}

void wh_mcs_hear_slice(void *user, const wh_command_t *command, const wh_state_t *state) {
    wh_mcs_t *mcs = user;
    wh_pass_follow(&mcs->measuring.pass, command);
    wh_mcs_hear(mcs, state);
}

void wh_mcs_free_edge(wh_mcs_edge_t *edge) {
    free(edge->samples);
    free(edge->speeds);
    edge->samples = NULL;
    edge->speeds = NULL;
}

/* native.arm_edge(gripper, first, count): from the end of the next slice on the sensor at this chuck takes
 * `count` samples, each when the chuck turns past its angle. If `count` is below 0, the chuck turns
 * clockwise. Data collected before is deleted. */
static int arm_edge(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_mcs_edge_t *edge = &mcs->measuring.edge;
    const wh_scanning_t scanning = wh_layout_scanning(mcs->layout);
    const int64_t count = luaL_checkinteger(L, 3);
    const int64_t most = (int64_t)WH_SCAN_TURNS * WH_SENSOR_SAMPLES;
    const wh_scan_order_t order = {WH_SCAN_ARM, wh_mcs_index(L, 1, mcs->state.gripper_count),
                                   count < -most || count > most ? 0 : (int32_t)count,
                                   luaL_checkinteger(L, 2)};
    luaL_argcheck(L, wh_scanning_check(&scanning, &order) == WH_OK, 3, "no scan of an edge sensor");
    wh_mcs_free_edge(edge);
    edge->samples = wh_array_new((size_t)magnitude_of_count(order.count), sizeof *edge->samples);
    edge->speeds = wh_array_new((size_t)magnitude_of_count(order.count), sizeof *edge->speeds);
    edge->speed = 0;
    edge->turn_seq = 0;
    edge->order = order;
    edge->before = edge->number;
    edge->taken = 0;
    edge->missed = 0;
    edge->armed = true;
    mcs->command.scan = order;
    return 0;
}

/* native.disarm_edge(): disarms with the next slice, if samples are still to come. Collected data stays. */
static int disarm_edge(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    if (mcs->measuring.edge.armed) {
        mcs->command.scan = (wh_scan_order_t){.kind = WH_SCAN_DISARM};
    }
    return 0;
}

/* native.edge(): the data collected since arm_edge, nil without one. `samples` are as many as were asked for,
 * `count`: dark pixels, or -1 if none has come (`missed` of them), because its state was lost or the scan has
 * ended before. `first` is the number of the first sample, `is_armed` tells whether more will come. */
static int read_edge(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_mcs_edge_t *edge = &mcs->measuring.edge;
    if (!edge->samples) {
        return 0;
    }
    wh_decisions_measured(mcs->wanted.decisions, "a scan of a wafer's edge");
    const int32_t count = magnitude_of_count(edge->order.count);
    wh_sandbox_charge(L, (uint64_t)count);
    lua_createtable(L, 0, 5);
    lua_createtable(L, count, 0);
    for (int32_t i = 0; i < count; ++i) {
        lua_pushinteger(L, i < edge->taken ? edge->samples[i] : WH_NONE);
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -2, "samples");
    wh_lua_set_integer(L, "first", edge->order.first);
    wh_lua_set_integer(L, "count", edge->order.count);
    wh_lua_set_integer(L, "missed", edge->missed + count - edge->taken);
    wh_lua_set_boolean(L, "is_armed", edge->armed);
    return 1;
}

/* The angle in which the chuck comes from rest to its full speed. */
static double run_up(const wh_limits_t *limits) {
    const double speed = limits->speed;
    const bool is_short = speed * limits->jerk < limits->acceleration * limits->acceleration;
    const double time = is_short ? 2 * sqrt(speed / limits->jerk)
                                 : speed / limits->acceleration + limits->acceleration / limits->jerk;
    return speed * time / 2;
}

void wh_mcs_push_edge_sensor(lua_State *L, const wh_layout_t *layout, const wh_scanner_t *scanner) {
    const wh_sensor_t *sensor = &scanner->sensor;
    lua_createtable(L, 0, 7);
    wh_lua_set_integer(L, "samples", sensor->samples);
    wh_lua_set_integer(L, "pixels", wh_sensor_pixels(sensor));
    wh_lua_set_number(L, "pixel", sensor->pixel);
    wh_lua_set_number(L, "middle", sensor->middle);
    wh_lua_set_number(L, "length", sensor->length);
    wh_lua_set_number(L, "run_up", run_up(&layout->machine.chuck_limits));
    wh_mcs_push_sensor_error(L, &layout->believed[scanner - layout->scanners]);
    lua_setfield(L, -2, "believed");
}

const luaL_Reg wh_mcs_edge_functions[] = {
    {"arm_edge", arm_edge}, {"disarm_edge", disarm_edge}, {"edge", read_edge}, {NULL, NULL}};
