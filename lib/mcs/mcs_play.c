/* The MCS host's hands: segments, played slice by slice. */
#include <math.h>

#include "../text/array.h"
#include "../text/clock.h"
#include "mcs_internal.h"

/* The budget is charged for slices in portions, so that a long wait can be ended within one. A slice costs as much time
 * as some twenty instructions of Lua. */
#define SLICES_PER_CHARGE 1024
#define STEPS_PER_SLICE 20

/* ---------------------------------------------------------------------------------------------------------- playing */

static void keep_events(wh_mcs_t *mcs) {
    for (size_t i = 0; i < mcs->state.event_count; ++i) {
        wh_record_add_event(mcs->record, mcs->state.utime, mcs->running, &mcs->state.events[i]);
    }
}

static wh_status_t exchange(wh_mcs_t *mcs) {
    wh_command_t *command = &mcs->command;
    wh_command_from_track(command, &mcs->cache, &mcs->track);
    wh_decisions_slice(mcs->decisions, command);
    const wh_status_t status = mcs->link->exchange(mcs->link, command, &mcs->state);
    command->fault_count = 0;
    if (mcs->state.event_count > 0) {
        keep_events(mcs);
    }
    if (status == WH_OK && mcs->collision.memory && mcs->link != &mcs->simulator.link) {
        wh_collision_observe(&mcs->collision, &mcs->state);
    }
    if (status == WH_OK && mcs->listener.slice) {
        mcs->listener.slice(mcs->listener.user, mcs);
    }
    return status;
}

static bool stop_has_come(const wh_mcs_t *mcs) {
    return mcs->track.slice >= mcs->stop_slice;
}

/* Plays up to SLICES_PER_CHARGE slices of the segment; fewer when the sandbox is to stop, for over a link at a
 * wall-clock rate a portion may take seconds. */
static wh_track_state_t play_portion(wh_mcs_t *mcs, wh_status_t *status) {
    wh_track_state_t state = WH_TRACK_MOVING;
    const double begin = wh_clock_seconds();
    for (int i = 0; i < SLICES_PER_CHARGE && *status == WH_OK && state == WH_TRACK_MOVING; ++i) {
        state = wh_track_next(&mcs->track, mcs->state.sensors);
        if (state == WH_TRACK_MOVING) {
            *status = exchange(mcs);
            mcs->was_off |= ~mcs->state.sensors;
            wh_mcs_count_slice(mcs);
        }
        if (wh_sandbox_stopping(mcs->sandbox) || stop_has_come(mcs)) {
            break;
        }
    }
    mcs->record->wall_s += wh_clock_seconds() - begin;
    return state;
}

static wh_track_state_t play_through(lua_State *L, wh_mcs_t *mcs) {
    wh_status_t status = WH_OK;
    wh_track_state_t state = WH_TRACK_MOVING;
    while (state == WH_TRACK_MOVING) {
        const int64_t before = mcs->track.slice;
        state = play_portion(mcs, &status);
        /* First, for a link that gave up waiting because of a stop returns with some status too. */
        wh_sandbox_charge(L, STEPS_PER_SLICE * (uint64_t)(mcs->track.slice - before));
        if (status != WH_OK) {
            wh_mcs_raise(L, mcs, status, "the simulator refused a slice");
        }
        if (stop_has_come(mcs)) {
            mcs->stop_slice = INT64_MAX;
            wh_mcs_raise(L, mcs, WH_STATUS_STOPPED, "by stop_in");
        }
    }
    return state;
}

/* --------------------------------------------------------------------------------------------------------- watching */

/* Whether a gripper goes anywhere in a segment: with the arm in each, with its chuck where that turns. */
static bool is_carried(const wh_mcs_t *mcs, const wh_segment_t *segment, size_t g) {
    const int32_t axis = mcs->layout->machine.mounts[g].axis;
    return axis == WH_NONE || (segment->kind == WH_SEGMENT_AXES &&
                               wh_real_abs(segment->target[axis] - mcs->track.axes[axis]) > 0);
}

/* The grippers that a wafer could be lost from, if their sensor is on. */
static uint32_t watch(const wh_mcs_t *mcs, const wh_segment_t *segment) {
    uint32_t watched = 0;
    for (size_t g = 0; g < mcs->state.gripper_count; ++g) {
        watched |= is_carried(mcs, segment, g) ? 1U << g : 0;
    }
    return watched;
}

/* The first of the watched whose sensor went off though its valve is open, or WH_NONE. */
static int32_t find_lost(const wh_mcs_t *mcs, uint32_t watched) {
    for (size_t g = 0; g < mcs->state.gripper_count; ++g) {
        if ((watched & mcs->was_off & 1U << g) != 0 && mcs->track.valves[g] == WH_VALVE_OPEN) {
            return (int32_t)g;
        }
    }
    return WH_NONE;
}

/* --------------------------------------------------------------------------------------------------------- segments */

static void keep_segment(wh_mcs_t *mcs, const wh_segment_t *segment) {
    mcs->segments =
        wh_array_grow(mcs->segments, mcs->segment_count, &mcs->segment_capacity, sizeof *mcs->segments);
    mcs->segments[mcs->segment_count++] = *segment;
}

static void look_ahead(lua_State *L, wh_mcs_t *mcs, const wh_segment_t *segment) {
    char reason[WH_MCS_REASON_BYTES] = "";
    if (mcs->judging && mcs->ahead) {
        if (mcs->ahead(mcs->ahead_user, mcs, segment, reason)) {
            wh_mcs_raise(L, mcs, WH_STATUS_COLLISION_AHEAD, reason);
        }
        wh_sandbox_charge(L, STEPS_PER_SLICE * (uint64_t)mcs->track.segment_slices);
        ++mcs->judged;
    }
}

static wh_track_state_t play_now(lua_State *L, wh_mcs_t *mcs, const wh_segment_t *segment) {
    if (mcs->keep_segments) {
        keep_segment(mcs, segment);
    }
    mcs->was_off = 0;
    return play_through(L, mcs);
}

/* native.play(segment): true when it ran to its end, false when its sensor did not come on in time; then the gripper that
 * lost its wafer meanwhile, or nil. */
static int play(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const wh_segment_t segment = wh_mcs_read_segment(L, mcs);
    const uint32_t carried = watch(mcs, &segment);
    const uint32_t watched = carried & mcs->state.sensors;
    mcs->task = wh_mcs_task(L, mcs, &segment);
    const wh_status_t status = wh_track_begin(&mcs->track, &segment);
    if (status != WH_OK) {
        wh_mcs_raise(L, mcs, status, NULL);
    }
    if (mcs->rehearsing) {
        look_ahead(L, mcs, &segment);
        wh_track_skip(&mcs->track);
        wh_mcs_look_at_reach(mcs);
        lua_pushboolean(L, 1);
        return 1;
    }
    wh_decisions_begin(mcs->decisions, &segment, carried);
    const bool done = play_now(L, mcs, &segment) == WH_TRACK_DONE;
    const int32_t lost = find_lost(mcs, watched);
    wh_decisions_end(mcs->decisions, done, lost);
    lua_pushboolean(L, done);
    if (lost == WH_NONE) {
        return 1;
    }
    lua_pushinteger(L, lost + 1);
    return 2;
}

void wh_mcs_end_rehearsal(wh_mcs_t *mcs) {
    if (mcs->rehearsing) {
        mcs->track = mcs->kept;
        mcs->rehearsing = false;
    }
}

/* native.rehearse(on, judged): from now on segments are only planned, and shown to `ahead` if judged; off: everything is
 * where it was. */
static int rehearse(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_mcs_end_rehearsal(mcs);
    if (lua_toboolean(L, 1)) {
        mcs->kept = mcs->track;
        mcs->rehearsing = true;
        mcs->judging = lua_toboolean(L, 2) != 0;
        mcs->judged = 0;
    }
    return 0;
}

/* native.stop_in(seconds): a STOP comes at the first slice at or after so many simulated seconds from now. */
static int stop_in(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const double slices = ceil(luaL_checknumber(L, 1) * 1e6 / (double)mcs->track.slice_us);
    mcs->stop_slice = mcs->track.slice + (int64_t)slices;
    return 0;
}

const luaL_Reg wh_mcs_play_functions[] = {
    {"play", play}, {"rehearse", rehearse}, {"stop_in", stop_in}, {NULL, NULL}};
