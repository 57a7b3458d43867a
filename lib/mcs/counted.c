#include "counted.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "clocks.h"
#include "flow_held.h"
#include "playing.h"

/* Asking costs about as much as playing a slice: fewer slices are not worth it, and where something may be
 * decided it is soon asked again. */
#define FEW 4

/* A listener hears of every so many slices that are left out, while something moves: curves that go through
 * these are smooth enough for a page. */
#define HEARD_US 10000

/* ------------------------------------------------------------------------------ how many may be left out? */

/* A track goes on without an answer until its segment's last slice. */
static int64_t until_end(const wh_mcs_t *mcs, const wh_track_t *track, const wh_awaited_t *awaited) {
    const bool waits = track->segment.kind == WH_SEGMENT_SENSOR;
    if (waits && (wh_mcs_sensors(mcs, awaited) >> track->segment.gripper & 1U) != 0) {
        return 0;
    }
    return track->segment_slices - track->segment_slice - 1;
}

static int64_t until_segment_ends(const wh_mcs_t *mcs) {
    int64_t slices = INT64_MAX;
    if (!mcs->lanes) {
        return until_end(mcs, &mcs->track, &mcs->running.awaited);
    }
    for (size_t i = 0; i < mcs->lanes->count; ++i) {
        const wh_lane_t *lane = &mcs->lanes->of[i];
        const int64_t its = lane->stop.ramp.is_on || lane->is_held || wh_mcs_is_held_back(mcs, lane) ? 0
                            : lane->is_busy ? until_end(mcs, &lane->track, &lane->awaited)
                                            : INT64_MAX;
        slices = its < slices ? its : slices;
    }
    return slices;
}

static int64_t until_stop(const wh_mcs_t *mcs) {
    return mcs->stop.at_slice - mcs->track.slice - 1;
}

/* The axes that the running segments move. */
static uint32_t moving_axes(const wh_mcs_t *mcs) {
    uint32_t axes = mcs->lanes ? 0 : wh_quiet_axes(&mcs->track);
    for (size_t i = 0; mcs->lanes && i < mcs->lanes->count; ++i) {
        const wh_lane_t *lane = &mcs->lanes->of[i];
        axes |= lane->is_busy ? wh_quiet_axes(&lane->track) & lane->axes : 0;
    }
    return axes;
}

/* The track whose segment moves the axis; null: none does. */
static const wh_track_t *track_of(const wh_mcs_t *mcs, size_t axis) {
    const wh_track_t *found = mcs->lanes ? NULL : &mcs->track;
    for (size_t i = 0; mcs->lanes && i < mcs->lanes->count; ++i) {
        const wh_lane_t *lane = &mcs->lanes->of[i];
        found = lane->is_busy && (lane->axes >> axis & 1U) != 0 ? &lane->track : found;
    }
    return found;
}

static void jump(wh_track_t *track, int64_t slices) {
    track->segment_slice += slices - 1;
    track->slice += slices - 1;
    (void)wh_track_next(track, 0);
}

/* Axes that stand move by rounding alone, rad and mm. */
#define STILL 1e-9

/* True if these axes stand to the segment's end. */
static bool stand_still(const wh_track_t *track, uint32_t axes, int64_t slices) {
    wh_track_t there = *track;
    bool stand = true;
    jump(&there, slices);
    for (size_t axis = 0; axes >> axis != 0; ++axis) {
        stand =
            stand && ((axes >> axis & 1U) == 0 || wh_real_abs(there.axes[axis] - track->axes[axis]) < STILL);
    }
    return stand;
}

/* How far the axis is after so many slices of its segment. */
static wh_real_t way_after(const wh_track_t *track, size_t axis, int64_t slices) {
    wh_track_t there = *track;
    jump(&there, slices);
    return wh_real_abs(there.axes[axis] - track->axes[axis]);
}

/* A straight segment goes one way: the farther, the later. */
static int64_t slices_within(const void *user, size_t axis, wh_real_t way) {
    const wh_track_t *track = track_of(user, axis);
    const bool is_straight =
        track && (track->segment.kind == WH_SEGMENT_LINE || track->segment.kind == WH_SEGMENT_AXES);
    const int64_t all = is_straight ? track->segment_slices - track->segment_slice - 1 : 0;
    int64_t low = 0, high = all;
    if (all < FEW || !stand_still(track, wh_quiet_still(track), all)) {
        return 0;
    }
    if (way_after(track, axis, all) <= way) {
        return all;
    }
    while (high - low > 1) {
        const int64_t middle = low + (high - low) / 2;
        if (way_after(track, axis, middle) <= way) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

static uint32_t still_axes(const wh_mcs_t *mcs) {
    uint32_t axes = mcs->lanes ? 0 : wh_quiet_still(&mcs->track);
    for (size_t i = 0; mcs->lanes && i < mcs->lanes->count; ++i) {
        const wh_lane_t *lane = &mcs->lanes->of[i];
        axes |= lane->is_busy ? wh_quiet_still(&lane->track) & lane->axes : 0;
    }
    return axes;
}

static int64_t until_something_meets(const wh_mcs_t *mcs) {
    const wh_quiet_stroke_t stroke = {mcs, still_axes(mcs), slices_within};
    return wh_quiet_slices(&mcs->local.counted->quiet, &mcs->local.simulator, &mcs->command, moving_axes(mcs),
                           &stroke);
}

/* The slices that each kind of decision allows; what is cheap to ask comes first. */
static int64_t (*const limits[])(const wh_mcs_t *mcs) = {until_segment_ends, until_stop, wh_mcs_clocks_quiet,
                                                         until_something_meets};

static int64_t count_left_out(const wh_mcs_t *mcs, int64_t most) {
    int64_t slices = most;
    for (size_t i = 0; i < sizeof limits / sizeof limits[0] && slices >= FEW; ++i) {
        const int64_t allowed = limits[i](mcs);
        slices = allowed < slices ? allowed : slices;
    }
    return slices >= FEW ? slices : 0;
}

/* ------------------------------------------------------------------------------------------- leaving out */

static void jump_all(wh_mcs_t *mcs, int64_t slices) {
    if (!mcs->lanes) {
        jump(&mcs->track, slices);
        return;
    }
    for (size_t i = 0; i < mcs->lanes->count; ++i) {
        if (mcs->lanes->of[i].is_busy) {
            jump(&mcs->lanes->of[i].track, slices);
        }
    }
    wh_mcs_show_lanes(mcs);
    mcs->track.slice += slices;
}

/* Motion control and the simulator are then behind them. */
static void pass_some(wh_mcs_t *mcs, int64_t slices) {
    jump_all(mcs, slices);
    wh_command_from_track(&mcs->command, &mcs->cache, &mcs->track);
    wh_quiet_pass(&mcs->local.simulator, &mcs->command, slices);
}

/* The listener gets the state after the last of them, which is the one that playing them gives. */
static void tell_listener(const wh_mcs_t *mcs) {
    const wh_mcs_listener_t *listener = &mcs->wanted.listener;
    if (listener->slice) {
        wh_state_t state = mcs->state;
        state.seq = mcs->command.seq;
        state.utime = mcs->command.utime;
        state.event_count = 0;
        listener->slice(listener->user, &mcs->command, &state);
    }
}

static void pass_and_tell(wh_mcs_t *mcs, int64_t slices, bool moves) {
    const int64_t heard = HEARD_US / mcs->track.slice_us;
    const int64_t most = moves && mcs->wanted.listener.slice ? (heard > 1 ? heard : 1) : slices;
    for (int64_t left = slices, next = 0; left > 0; left -= next) {
        next = left < most ? left : most;
        pass_some(mcs, next);
        tell_listener(mcs);
    }
}

/* Those who count slices are then behind them, too. */
static void pass_slices(wh_mcs_t *mcs, int64_t slices) {
    wh_record_t *record = mcs->recorder.record;
    const bool moves = moving_axes(mcs) != 0;
    pass_and_tell(mcs, slices, moves);
    if (mcs->local.collision.memory) {
        wh_collision_jump(&mcs->local.collision, mcs->local.simulator.table.slice, mcs->command.axes,
                          &mcs->state);
    }
    wh_mcs_clocks_pass(mcs, slices);
    wh_recorder_repeat(&mcs->recorder, slices, &mcs->state);
    mcs->recorder.part_count = 0;
    record->counted.left_out += slices;
    record->counted.moving += moves ? slices : 0;
    wh_mcs_keep_left_out(mcs, slices);
}

/* --------------------------------------------------------------------------------------------- verifying */

/* All that pass_some changes. */
typedef struct {
    wh_track_t track;
    wh_command_t command;
    wh_machine_cache_t cache;
    wh_simulator_t simulator;
    wh_gripper_t grippers[WH_GRIPPERS];
    wh_wafer_t *wafers;
    wh_lanes_t *lanes; /* null: there are none */
} saved_t;

static void save(const wh_mcs_t *mcs, saved_t *saved) {
    const wh_grasp_storage_t *storage = &mcs->local.simulator.table.storage;
    saved->track = mcs->track;
    saved->command = mcs->command;
    saved->cache = mcs->cache;
    saved->simulator = mcs->local.simulator;
    memcpy(saved->grippers, storage->grippers, storage->gripper_count * sizeof *storage->grippers);
    saved->wafers = wh_array_new(storage->wafer_count, sizeof *saved->wafers);
    memcpy(saved->wafers, storage->wafers, storage->wafer_count * sizeof *storage->wafers);
    saved->lanes = NULL;
    if (mcs->lanes) {
        saved->lanes = wh_array_new(1, sizeof *saved->lanes);
        *saved->lanes = *mcs->lanes;
    }
}

static void put_back(wh_mcs_t *mcs, saved_t *saved) {
    const wh_grasp_storage_t *storage = &saved->simulator.table.storage;
    mcs->track = saved->track;
    mcs->command = saved->command;
    mcs->cache = saved->cache;
    mcs->local.simulator = saved->simulator;
    memcpy(storage->grippers, saved->grippers, storage->gripper_count * sizeof *storage->grippers);
    memcpy(storage->wafers, saved->wafers, storage->wafer_count * sizeof *storage->wafers);
    if (saved->lanes) {
        *mcs->lanes = *saved->lanes;
    }
    free(saved->wafers);
    free(saved->lanes);
}

/* Leaves the stretch out to see what that gives, and goes back: it is played then. */
static void expect_stretch(wh_mcs_t *mcs, int64_t slices) {
    struct wh_counted *counted = mcs->local.counted;
    saved_t saved;
    const int64_t first = mcs->track.slice + 1;
    save(mcs, &saved);
    pass_some(mcs, slices);
    mcs->recorder.part_count = 0;
    wh_verify_expect(&counted->verify, first, &mcs->command, wh_simulator_hash(&mcs->local.simulator),
                     mcs->state.sensors);
    put_back(mcs, &saved);
    counted->again = mcs->track.slice + slices;
}

static void hear_slice(void *user, const wh_command_t *command, const wh_state_t *state) {
    const wh_mcs_t *mcs = user;
    wh_verify_t *verify = &mcs->local.counted->verify;
    const int64_t first = verify->first, last = verify->last;
    const uint64_t hash = command->seq == last ? wh_simulator_hash(&mcs->local.simulator) : 0;
    const char *difference = wh_verify_slice(verify, command, state, hash);
    const char *text = wh_mcs_running_text(mcs);
    if (difference && verify->difference[0] == '\0') {
        (void)snprintf(verify->difference, sizeof verify->difference,
                       "slices %lld to %lld%s%.100s: %s in slice %lld", (long long)first, (long long)last,
                       text ? ", " : "", text ? text : "", difference, (long long)command->seq);
    }
}

const char *wh_mcs_miscounted(const wh_mcs_t *mcs) {
    return mcs->local.counted ? mcs->local.counted->verify.difference : "";
}

int64_t wh_mcs_leave_out(wh_mcs_t *mcs, int64_t most) {
    struct wh_counted *counted = mcs->local.counted;
    if (!counted || mcs->track.slice < counted->again) {
        return 0;
    }
    const int64_t slices = count_left_out(mcs, most);
    if (slices == 0) {
        counted->again = mcs->track.slice + FEW;
        return 0;
    }
    if (wh_verify_takes(&counted->verify)) {
        expect_stretch(mcs, slices);
        return 0;
    }
    pass_slices(mcs, slices);
    return slices;
}

/* ---------------------------------------------------------------------------------------------- beginning */

/* A drawn delay of a valve goes by each slice, and so does the cell without errors of a look ahead. */
static bool goes_by_slices(const wh_mcs_t *mcs) {
    const wh_trial_cell_t *trial = mcs->local.trial;
    bool goes = trial && mcs->rehearsal.look_ahead;
    for (size_t g = 0; trial && g < mcs->layout->machine.gripper_count; ++g) {
        goes = goes || trial->lag[g] != 0;
    }
    goes = goes || (mcs->layout->collision && mcs->wanted.counts == WH_MCS_COUNT_BLIND);
    return goes || mcs->wanted.partners.connect || mcs->wanted.decisions;
}

void wh_mcs_begin_counting(lua_State *L, wh_mcs_t *mcs) {
    mcs->recorder.record->counted.is_wanted = mcs->wanted.counts != WH_MCS_COUNT_NONE;
    mcs->recorder.record->counted.is_verified = mcs->wanted.verify > 0;
    if (mcs->wanted.counts == WH_MCS_COUNT_NONE || goes_by_slices(mcs)) {
        return;
    }
    struct wh_counted *counted = lua_newuserdatauv(L, sizeof *counted, 0);
    lua_rawsetp(L, LUA_REGISTRYINDEX, counted);
    memset(counted, 0, sizeof *counted);
    wh_quiet_begin(&counted->quiet, &mcs->real->machine, mcs->real->physics.slice_s);
    counted->verify.wanted = mcs->wanted.verify;
    mcs->local.counted = counted;
    if (mcs->wanted.verify > 0) {
        wh_mcs_listen(mcs, hear_slice, mcs);
    }
}
