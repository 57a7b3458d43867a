/* Segments, played slice by slice, one at a time. */
#include <math.h>
#include <string.h>

#include "../script/wh_module_values.h"
#include "../text/clock.h"
#include "carrying.h"
#include "clocks.h"
#include "counted.h"
#include "native.h"
#include "playing.h"
#include "ramp.h"

/* Plays one slice: the command goes in, the state comes out, and the listeners get both. */
static wh_status_t exchange_slice(wh_mcs_t *mcs) {
    wh_command_from_track(&mcs->command, &mcs->cache, &mcs->track);
    wh_mcs_clocks_send(mcs);
    const wh_mcs_partners_t *partners = &mcs->wanted.partners;
    if (partners->lossy && !mcs->lanes && mcs->track.segment_slice == mcs->track.segment_slices) {
        partners->lossy->await(partners->user);
    }
    wh_mcs_keep_slice(mcs);
    const wh_status_t status = mcs->link->exchange(mcs->link, &mcs->command, &mcs->state);
    for (size_t i = 0; i < mcs->listeners.count; ++i) {
        mcs->listeners.of[i].hear(mcs->listeners.of[i].user, &mcs->command, &mcs->state);
    }
    wh_mcs_look_at_controllers(mcs, mcs->command.seq);
    mcs->command.fault_count = 0;
    mcs->command.scan = (wh_scan_order_t){.kind = WH_SCAN_KEEP};
    mcs->command.latch = (wh_latch_order_t){.kind = WH_LATCH_KEEP};
    return status;
}

bool wh_mcs_stop_has_come(const wh_mcs_t *mcs) {
    return mcs->stop.is_requested || mcs->stop.refused != 0 || mcs->track.slice >= mcs->stop.at_slice;
}

void wh_mcs_stop_standing(wh_mcs_t *mcs) {
    mcs->stop.stands = true;
}

bool wh_mcs_is_told_to_stop(const wh_mcs_t *mcs) {
    return mcs->stop.is_requested || mcs->stop.refused != 0;
}

void wh_mcs_stop(wh_mcs_t *mcs) {
    mcs->stop.is_requested = true;
    mcs->stop.axes = WH_MCS_ALL;
}

/* With tasks, the mechanism's user is looked up when the slice has come back. */
bool wh_mcs_stop_mechanism(wh_mcs_t *mcs, const char *name) {
    uint32_t axes = 0;
    if (!wh_mcs_find_mechanism(mcs, name, &axes)) {
        return false;
    }
    if (mcs->lanes) {
        mcs->stop.axes = axes | (mcs->stop.is_requested ? mcs->stop.axes : 0);
        mcs->stop.is_requested = true;
    } else if (mcs->recorder.running != WH_NONE && (mcs->running.axes & axes) != 0) {
        wh_mcs_stop(mcs);
    }
    return true;
}

const char *wh_mcs_take_stop(wh_mcs_t *mcs, uint32_t *axes) {
    const bool requested = mcs->stop.is_requested;
    *axes = requested ? mcs->stop.axes : mcs->stop.slice_axes;
    if (!requested) {
        mcs->stop.at_slice = INT64_MAX;
    }
    mcs->stop.is_requested = mcs->stop.stands = false;
    return requested || mcs->stop.is_asked ? "by a request" : "by stop_in";
}

/* A study's decisions then know of it. */
static bool slows_down(wh_mcs_t *mcs) {
    const int32_t stop = mcs->layout->stop;
    const bool is_usual = stop == WH_LAYOUT_STOP_USUAL && mcs->wanted.slows_down;
    const bool slows = stop == WH_LAYOUT_STOP_RAMP || is_usual;
    if (slows) {
        wh_decisions_measured(mcs->wanted.decisions, "a STOP that slows down");
    }
    return slows;
}

/* By a STOP, or by the controller of the only robot that moves without tasks. */
__attribute__((noreturn)) static void raise_stopped(lua_State *L, wh_mcs_t *mcs) {
    uint32_t all = 0;
    for (size_t robot = 0; robot < WH_MCS_ROBOTS; ++robot) {
        if ((mcs->stop.refused >> robot & 1U) != 0) {
            wh_mcs_raise_condition(L, mcs, robot);
        }
    }
    wh_mcs_raise(L, mcs, WH_STATUS_STOPPED, wh_mcs_take_stop(mcs, &all));
}

void wh_mcs_note_refused(wh_mcs_t *mcs, wh_status_t status) {
    if (status == WH_STATUS_STOPPED && mcs->stop.is_by_link) {
        wh_sandbox_stop(mcs->sandbox);
    }
    mcs->stop.is_by_link = status == WH_STATUS_STOPPED;
}

void wh_mcs_raise_refused(lua_State *L, wh_mcs_t *mcs, wh_status_t status) {
    const wh_mcs_partners_t *partners = &mcs->wanted.partners;
    wh_mcs_raise(L, mcs, status,
                 partners->lossy ? partners->lossy->explain(partners->user, status)
                                 : "the simulator refused a slice");
}

__attribute__((noreturn)) static void refuse_slice(lua_State *L, wh_mcs_t *mcs, wh_status_t status) {
    wh_mcs_note_refused(mcs, status);
    wh_mcs_raise_refused(L, mcs, status);
}

/* A slice that was refused, or did not go out, has not taken place: the next one has its number, and begins
 * where it began. A slice without an answer may have taken place. */
static bool has_gone_out(const wh_mcs_t *mcs) {
    const wh_mcs_partners_t *partners = &mcs->wanted.partners;
    return partners->lossy && partners->lossy->reached(partners->user) >= mcs->track.slice;
}

wh_status_t wh_mcs_play_slice(wh_mcs_t *mcs, const wh_real_t before[WH_AXES]) {
    const wh_status_t status = exchange_slice(mcs);
    if (status != WH_OK && !has_gone_out(mcs)) {
        memcpy(mcs->track.axes, before, sizeof mcs->track.axes);
        --mcs->track.slice;
        wh_mcs_drop_slice(mcs);
    }
    wh_vacuum_watch_slice(&mcs->running.watch, mcs->state.sensors);
    return status;
}

/* Plays up to WH_MCS_SLICES_PER_CHARGE slices of the segment; fewer if the sandbox must stop: over a link
 * at a wall-clock rate a portion may take seconds. */
static wh_track_state_t play_portion(wh_mcs_t *mcs, wh_status_t *status) {
    wh_track_state_t state = WH_TRACK_MOVING;
    const double begin = wh_clock_seconds();
    for (int64_t i = 0; i < WH_MCS_SLICES_PER_CHARGE && *status == WH_OK && state == WH_TRACK_MOVING; ++i) {
        wh_real_t before[WH_AXES];
        i += i > 0 ? wh_mcs_leave_out(mcs, WH_MCS_SLICES_PER_CHARGE - 1 - i) : 0;
        memcpy(before, mcs->track.axes, sizeof before);
        state = wh_track_next(&mcs->track, wh_mcs_sensors(mcs, &mcs->running.awaited));
        if (state == WH_TRACK_MOVING) {
            *status = wh_mcs_play_slice(mcs, before);
        }
        if (wh_sandbox_stopping(mcs->sandbox) || wh_mcs_stop_has_come(mcs)) {
            break;
        }
    }
    mcs->recorder.record->wall_s += wh_clock_seconds() - begin;
    return state;
}

wh_status_t wh_mcs_resume(wh_mcs_t *mcs) {
    const wh_mcs_partners_t *partners = &mcs->wanted.partners;
    if (!partners->lossy) {
        return WH_OK;
    }
    const wh_status_t status = partners->lossy->resume(partners->user);
    const int64_t reached = partners->lossy->reached(partners->user);
    mcs->track.slice = reached < mcs->track.slice ? reached : mcs->track.slice;
    return status;
}

bool wh_mcs_begin_ramp(wh_mcs_t *mcs, wh_ramp_t *ramp, const wh_track_t *track) {
    return slows_down(mcs) && wh_ramp_begin(ramp, track, wh_carrying_matters(mcs->layout));
}

/* A STOP has come between two slices: what moves goes on along its way until it stands. A controller that
 * refuses motion meanwhile ends that. */
static void slow_down(lua_State *L, wh_mcs_t *mcs) {
    wh_ramp_t ramp;
    if (mcs->stop.refused != 0 || mcs->stop.stands || !wh_mcs_begin_ramp(mcs, &ramp, &mcs->track)) {
        return;
    }
    const int64_t first = mcs->track.slice;
    wh_real_t before[WH_AXES];
    memcpy(before, mcs->track.axes, sizeof before);
    while (mcs->stop.refused == 0 && !wh_sandbox_stopping(mcs->sandbox) && wh_ramp_next(&ramp, &mcs->track)) {
        mcs->running.slows_down = true;
        const wh_status_t status = wh_mcs_play_slice(mcs, before);
        mcs->running.slows_down = false;
        if (status != WH_OK) {
            refuse_slice(L, mcs, status);
        }
        memcpy(before, mcs->track.axes, sizeof before);
    }
    wh_sandbox_charge(L, wh_mcs_steps(mcs->track.slice - first));
}

/* Ends the segment if a STOP has come; first it slows down if it `moves`. */
static void heed_stop(lua_State *L, wh_mcs_t *mcs, bool moves) {
    if (wh_mcs_stop_has_come(mcs) && moves) {
        slow_down(L, mcs);
    }
    if (wh_mcs_stop_has_come(mcs)) {
        raise_stopped(L, mcs);
    }
}

static bool is_refused(const wh_mcs_t *mcs, wh_status_t status) {
    return status != WH_OK && !(status == WH_STATUS_STOPPED && wh_mcs_is_told_to_stop(mcs));
}

static wh_track_state_t play_through(lua_State *L, wh_mcs_t *mcs) {
    wh_status_t status = WH_OK;
    wh_track_state_t state = WH_TRACK_MOVING;
    if (wh_mcs_is_told_to_stop(mcs)) {
        raise_stopped(L, mcs);
    }
    status = wh_mcs_resume(mcs);
    if (is_refused(mcs, status)) {
        refuse_slice(L, mcs, status);
    }
    if (status != WH_OK) {
        raise_stopped(L, mcs);
    }
    while (state == WH_TRACK_MOVING) {
        const int64_t before = mcs->track.slice;
        state = play_portion(mcs, &status);
        /* Charge first: a link that gave up waiting because of a stop also returns a status. */
        wh_sandbox_charge(L, wh_mcs_steps(mcs->track.slice - before));
        if (is_refused(mcs, status)) {
            refuse_slice(L, mcs, status);
        }
        heed_stop(L, mcs, status == WH_OK && state == WH_TRACK_MOVING);
    }
    return state;
}

/* Begins a segment of the last rehearsal as planned there, in the track's present slice. */
static void begin_planned(lua_State *L, wh_mcs_t *mcs, wh_planned_t *planned) {
    *planned = mcs->rehearsal.planned.segments[wh_mcs_index(L, 1, mcs->rehearsal.planned.count)];
    planned->track.slice = mcs->track.slice;
    mcs->track = planned->track;
}

void wh_mcs_begin_segment(lua_State *L, wh_mcs_t *mcs, wh_planned_t *planned) {
    luaL_argcheck(L, !mcs->rehearsal.is_on, 1, "a rehearsal goes on");
    if (!mcs->link) {
        wh_mcs_raise(L, mcs, WH_STATUS_NO_LAYOUT, "cell was refused");
    }
    if (lua_isinteger(L, 1)) {
        begin_planned(L, mcs, planned);
    } else {
        wh_mcs_plan_segment(L, mcs, planned);
    }
}

/* native.play(segment or the number of a planned one): true if it ran to its end, false if its sensor did not
 * come on in time; then the gripper that lost its wafer meanwhile, or nil. */
static int play_segment(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_planned_t planned;
    wh_mcs_begin_segment(L, mcs, &planned);
    wh_mcs_check_segment(L, mcs, &planned.track.segment, mcs->running.axes);
    mcs->running.kept = wh_mcs_keep_segment(mcs, &mcs->track, &planned, UINT32_MAX);
    mcs->recorder.task = planned.task;
    mcs->running.awaited = planned.awaited;
    mcs->running.watch = (wh_vacuum_watch_t){.watched = planned.may_lose & mcs->state.sensors};
    const wh_segment_t *segment = &mcs->track.segment;
    wh_decisions_read(mcs->wanted.decisions, WH_DECISION_BEGIN,
                      segment->kind == WH_SEGMENT_SENSOR ? segment->gripper : WH_NONE,
                      (int32_t)planned.may_lose);
    const bool done = play_through(L, mcs) == WH_TRACK_DONE;
    const int32_t lost =
        wh_vacuum_watch_lost(&mcs->running.watch, mcs->track.valves, mcs->state.gripper_count);
    wh_decisions_read(mcs->wanted.decisions, WH_DECISION_END, lost, done);
    lua_pushboolean(L, done);
    if (lost == WH_NONE) {
        return 1;
    }
    lua_pushinteger(L, lost + 1);
    return 2;
}

/* native.stop_in(seconds, mechanism, asked): a STOP of that mechanism (nil: of all) comes at the first slice
 * at or after this many simulated seconds from now; seconds nil: none comes. `asked` true: an operator has
 * said STOP. Returns false and the names of all mechanisms if there is no such one. With a mechanism there
 * must be tasks. */
static int stop_in(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    uint32_t axes = WH_MCS_ALL;
    if (!lua_isnoneornil(L, 2) && !wh_mcs_find_mechanism(mcs, wh_lua_whole_text(L, 2), &axes)) {
        char names[WH_MCS_MECHANISMS_BYTES];
        wh_mcs_name_mechanisms(mcs, WH_MCS_ALL, names);
        lua_pushboolean(L, false);
        lua_pushstring(L, names);
        return 2;
    }
    mcs->stop.slice_axes = axes;
    mcs->stop.is_asked = lua_toboolean(L, 3);
    if (lua_isnoneornil(L, 1)) {
        mcs->stop.at_slice = INT64_MAX;
        return 0;
    }
    const double slices = ceil(luaL_checknumber(L, 1) * 1e6 / (double)mcs->track.slice_us);
    mcs->stop.at_slice = mcs->track.slice + (int64_t)slices;
    lua_pushboolean(L, true);
    return 1;
}

const luaL_Reg wh_mcs_play_functions[] = {{"play", play_segment}, {"stop_in", stop_in}, {NULL, NULL}};
