/* The MCS host's figures: what the time goes into, wafers put, cycles, and how near the axes come to their ends. */
#include "mcs_internal.h"

/* What a marked cycle costs of the instruction budget, being outside of Lua's memory cap. */
#define STEPS_PER_CYCLE 256
#define STEPS_PER_BYTE 4

/* ----------------------------------------------------------------------------------------------------- time */

wh_task_t wh_mcs_task(lua_State *L, const wh_mcs_t *mcs, const wh_segment_t *segment) {
    bool for_vacuum = false;
    if (segment->kind == WH_SEGMENT_DWELL) {
        lua_getfield(L, 1, "vacuum");
        for_vacuum = lua_toboolean(L, -1) != 0;
        lua_pop(L, 1);
    }
    return wh_activity_task(&mcs->track, segment, for_vacuum);
}

void wh_mcs_count_slice(wh_mcs_t *mcs) {
    const wh_share_t share = wh_activity_count(&mcs->record->activity, &mcs->task, &mcs->track, &mcs->state);
    if (mcs->running != WH_NONE) {
        ++mcs->record->commands[mcs->running].shares[share];
    }
}

/* --------------------------------------------------------------------------------------------------- wafers */

/* The events of the running command begin here. */
static size_t first_event(const wh_mcs_t *mcs) {
    size_t first = mcs->record->event_count;
    while (first > 0 && mcs->record->events[first - 1].command == mcs->running) {
        --first;
    }
    return first;
}

static bool cell_complained(const wh_mcs_t *mcs, size_t from) {
    bool complained = false;
    for (size_t i = from; i < mcs->record->event_count; ++i) {
        complained = complained || wh_mcs_is_complaint(&mcs->record->events[i].event);
    }
    return complained;
}

/* Lies in a slot, and nobody but the chuck there holds it. */
static bool find_put(const wh_mcs_t *mcs, int32_t w, wh_put_record_t *put) {
    const wh_wafer_t *wafer = &mcs->state.wafers[w];
    wh_place_t place;
    if (!wh_cell_locate(&mcs->simulator.cell, &wafer->base_from_wafer, &place)) {
        return false;
    }
    put->wafer = w;
    put->station = place.station;
    put->slot = place.slot;
    put->slice = mcs->track.slice;
    return wafer->holder == WH_NONE || wafer->holder == mcs->layout->places[place.station].chuck;
}

static bool is_known(const wh_mcs_t *mcs, size_t first, int32_t wafer) {
    bool known = false;
    for (size_t i = first; i < mcs->record->put_count; ++i) {
        known = known || mcs->record->puts[i].wafer == wafer;
    }
    return known;
}

void wh_mcs_count_puts(wh_mcs_t *mcs) {
    const size_t from = first_event(mcs);
    const size_t known = mcs->record->put_count;
    wh_put_record_t put;
    if (cell_complained(mcs, from)) {
        return;
    }
    for (size_t i = from; i < mcs->record->event_count; ++i) {
        const wh_event_t *event = &mcs->record->events[i].event;
        const bool let_go = event->kind == WH_EVENT_RELEASED || event->kind == WH_EVENT_HANDED_OVER;
        if (let_go && !is_known(mcs, known, event->wafer) && find_put(mcs, event->wafer, &put)) {
            wh_record_add_put(mcs->record, &put);
        }
    }
}

/* native.cycle(name): the next one begins. */
static int begin_cycle(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    size_t length = 0;
    const char *name = luaL_checklstring(L, 1, &length);
    if (mcs->running != WH_NONE) {
        wh_mcs_raise(L, wh_mcs_of(L), WH_STATUS_BUSY, "a cycle within a command");
    }
    wh_sandbox_charge(L, STEPS_PER_CYCLE + STEPS_PER_BYTE * (uint64_t)length);
    wh_record_add_cycle(mcs->record, wh_sandbox_line(L, mcs->script), name, mcs->track.slice);
    return 0;
}

/* ---------------------------------------------------------------------------------------------------- reach */

static void look_at_axis(const wh_mcs_t *mcs, size_t axis, wh_real_t at) {
    const wh_travel_t *travel = &mcs->layout->machine.robot.travel[axis];
    wh_travel_margin_t *least = &mcs->record->reach[mcs->reach_station].axes[axis];
    const bool is_max = travel->max - at < at - travel->min;
    const wh_real_t margin = is_max ? travel->max - at : at - travel->min;
    if (least->slot == 0 || margin < least->margin) {
        least->margin = margin > 0 ? margin : 0;
        least->at = at;
        least->is_max = is_max;
        least->slot = mcs->reach_slot;
    }
}

/* Where a line passes base's axis, R is least between its ends; all else runs one way. */
static void look_at_line(const wh_mcs_t *mcs, const wh_line_t *line) {
    const wh_real_t outward = line->direction.x;
    const wh_real_t level = outward * outward + line->direction.y * line->direction.y;
    const wh_real_t R = line->from[WH_AXIS_R];
    if (outward < 0 && -R * outward < level * line->path.distance) {
        look_at_axis(mcs, WH_AXIS_R, R * wh_real_abs(line->direction.y) / wh_real_sqrt(level));
    }
}

void wh_mcs_look_at_reach(wh_mcs_t *mcs) {
    if (mcs->reach_slot == 0) {
        return;
    }
    if (mcs->track.segment.kind == WH_SEGMENT_LINE) {
        look_at_line(mcs, &mcs->track.plan.line);
    }
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        look_at_axis(mcs, axis, mcs->track.axes[axis]);
    }
}

/* native.reach(station, slot): what is rehearsed from now on goes there; without arguments: it is no longer looked at. */
static int look_at_station(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const size_t stations = mcs->layout->station_count;
    mcs->reach_slot = (int32_t)luaL_optinteger(L, 2, 0);
    if (mcs->reach_slot != 0) {
        mcs->reach_station = wh_mcs_index(L, 1, stations);
        wh_record_begin_reach(mcs->record, stations);
    }
    return 0;
}

const luaL_Reg wh_mcs_figure_functions[] = {{"cycle", begin_cycle}, {"reach", look_at_station}, {NULL, NULL}};
