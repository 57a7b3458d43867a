/* The whole state of a session, kept and put back: motion control's and the simulator's. */
#include <stdlib.h>
#include <string.h>

#include "../sim/snapshot.h"
#include "clocks.h"
#include "ports.h"

/* The name of the type of userdata. */
#define SAVED "wh.saved_state"

/* The state of motion control; the bytes of the link's other side follow. */
typedef struct {
    wh_track_t track;
    wh_command_t command;
    wh_machine_cache_t cache;
    wh_mcs_seen_t seen;
    wh_origin_t origins[WH_GRIPPERS];
    wh_mcs_held_t held[WH_MCS_ROBOTS];
    int64_t stop_slice; /* of a STOP that comes at a slice; with it what it stops, and who said it */
    uint32_t stop_axes;
    bool is_stop_asked;
    wh_mcs_armed_t armed;
    int64_t edge_seq; /* of the scans so far: their samples are not kept */
    uint32_t edge_number;
    uint32_t pass_number; /* of the armings of beams so far, likewise */
    size_t size;          /* of `bytes` */
    uint8_t bytes[];
} saved_t;

static bool is_local(const wh_mcs_t *mcs) {
    return mcs->link == &mcs->local.simulator.link;
}

static void keep_state(const wh_mcs_t *mcs, saved_t *saved) {
    saved->track = mcs->track;
    saved->command = mcs->command;
    saved->cache = mcs->cache;
    saved->seen = mcs->heard.seen;
    memcpy(saved->origins, mcs->heard.origins.of, sizeof saved->origins);
    memcpy(saved->held, mcs->held, sizeof saved->held);
    saved->stop_slice = mcs->stop.at_slice;
    saved->stop_axes = mcs->stop.slice_axes;
    saved->is_stop_asked = mcs->stop.is_asked;
    saved->armed = mcs->armed;
    saved->edge_seq = mcs->measuring.edge.seq;
    saved->edge_number = mcs->measuring.edge.number;
    saved->pass_number = mcs->measuring.pass.number;
}

static void put_back(wh_mcs_t *mcs, const saved_t *saved) {
    mcs->track = saved->track;
    mcs->command = saved->command;
    mcs->cache = saved->cache;
    mcs->heard.seen = saved->seen;
    memcpy(mcs->heard.origins.of, saved->origins, sizeof saved->origins);
    wh_origins_look(&mcs->heard.origins, &mcs->state);
    memcpy(mcs->held, saved->held, sizeof mcs->held);
    mcs->stop.at_slice = saved->stop_slice;
    mcs->stop.slice_axes = saved->stop_axes;
    mcs->stop.is_asked = saved->is_stop_asked;
    mcs->armed = saved->armed;
    wh_mcs_free_edge(&mcs->measuring.edge);
    mcs->measuring.edge = (wh_mcs_edge_t){.seq = saved->edge_seq, .number = saved->edge_number};
    wh_pass_free(&mcs->measuring.pass);
    mcs->measuring.pass = (wh_pass_t){.seq = saved->edge_seq, .number = saved->pass_number};
    mcs->recorder.slice = saved->track.slice;
    /* The check begins anew: it would take the restored places for a motion. */
    mcs->local.collision.world = NULL;
}

/* Keeps the stations' clockwork beside the userdata on top of the stack. */
static void keep_clocks(lua_State *L, const wh_mcs_t *mcs) {
    if (mcs->clocks) {
        void *bytes = lua_newuserdatauv(L, mcs->clocks->state_bytes, 0);
        memcpy(bytes, mcs->clocks->state, mcs->clocks->state_bytes);
        (void)lua_setiuservalue(L, -2, 1);
    }
    if (mcs->clocks && mcs->clocks->ports) {
        void *bytes = lua_newuserdatauv(L, mcs->clocks->ports->state_bytes, 0);
        memcpy(bytes, mcs->clocks->ports->state, mcs->clocks->ports->state_bytes);
        (void)lua_setiuservalue(L, -2, 2);
    }
}

static void put_clocks_back(lua_State *L, const wh_mcs_t *mcs, int saved) {
    if (mcs->clocks && lua_getiuservalue(L, saved, 1) == LUA_TUSERDATA) {
        memcpy(mcs->clocks->state, lua_touserdata(L, -1), mcs->clocks->state_bytes);
        lua_pop(L, 1);
    }
    if (mcs->clocks && mcs->clocks->ports && lua_getiuservalue(L, saved, 2) == LUA_TUSERDATA) {
        memcpy(mcs->clocks->ports->state, lua_touserdata(L, -1), mcs->clocks->ports->state_bytes);
        lua_pop(L, 1);
    }
}

/* Pushes room for these bytes, with the state of motion control. */
static saved_t *push_saved(lua_State *L, const wh_mcs_t *mcs, size_t size) {
    saved_t *saved = lua_newuserdatauv(L, sizeof *saved + size, 2);
    keep_clocks(L, mcs);
    memset(saved, 0, sizeof *saved);
    keep_state(mcs, saved);
    saved->size = size;
    if (!luaL_getmetatable(L, SAVED)) {
        lua_pop(L, 1);
        (void)luaL_newmetatable(L, SAVED);
    }
    lua_setmetatable(L, -2);
    return saved;
}

static void save_local(lua_State *L, const wh_mcs_t *mcs) {
    const wh_simulator_t *simulator = &mcs->local.simulator;
    const size_t most = wh_simulator_saved_size(simulator);
    saved_t *saved = push_saved(L, mcs, most);
    (void)wh_simulator_save(simulator, saved->bytes, most, &saved->size);
}

static void save_partner(lua_State *L, wh_mcs_t *mcs) {
    const wh_mcs_partners_t *partners = &mcs->wanted.partners;
    uint8_t *bytes = lua_newuserdatauv(L, WH_MCS_SAVED_BYTES, 0);
    const size_t size = partners->save ? partners->save(partners->user, bytes) : 0;
    if (size == 0) {
        wh_mcs_raise(L, mcs, partners->save ? WH_STATUS_NO_ANSWER : WH_STATUS_NOT_RESTORED,
                     partners->save ? "the state of the last slice has not come"
                                    : "this simulator does not tell all that it is");
    }
    memcpy(push_saved(L, mcs, size)->bytes, bytes, size);
}

/* native.save(): everything that the next slice depends on, as a value for native.restore. Raises if the link
 * cannot tell the state of its other side. */
static int save_state(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    if (is_local(mcs)) {
        save_local(L, mcs);
    } else {
        save_partner(L, mcs);
    }
    return 1;
}

static wh_status_t restore_local(lua_State *L, wh_mcs_t *mcs, const saved_t *saved) {
    wh_simulator_t *simulator = &mcs->local.simulator;
    wh_snapshot_room_t *room = lua_newuserdatauv(L, sizeof *room, 0);
    room->wafers = lua_newuserdatauv(L, (mcs->state.wafer_count + 1) * sizeof *room->wafers, 0);
    room->grippers = lua_newuserdatauv(L, (mcs->state.gripper_count + 1) * sizeof *room->grippers, 0);
    const wh_status_t status = wh_simulator_load(simulator, saved->bytes, saved->size, room);
    if (status == WH_OK) {
        wh_simulator_view(simulator, &mcs->state);
        mcs->state.seq = saved->track.slice;
        mcs->state.utime = saved->track.slice * saved->track.slice_us;
    }
    return status;
}

/* Before the first slice the link has no state: the cell is as in the layout. */
static wh_status_t restore_partner(wh_mcs_t *mcs, const saved_t *saved) {
    const wh_mcs_partners_t *partners = &mcs->wanted.partners;
    wh_state_t state;
    memset(&state, 0, sizeof state);
    wh_simulator_view(&mcs->local.simulator, &state);
    const wh_status_t status = partners->restore
                                   ? partners->restore(partners->user, saved->bytes, saved->size, &state)
                                   : WH_STATUS_NOT_RESTORED;
    if (status == WH_OK) {
        mcs->state = state;
    }
    return status;
}

/* native.restore(saved): restores everything. Raises if the link does not take it; then nothing has
 * changed. */
static int restore_state(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const saved_t *saved = luaL_checkudata(L, 1, SAVED);
    const wh_status_t status = is_local(mcs) ? restore_local(L, mcs, saved) : restore_partner(mcs, saved);
    if (status != WH_OK) {
        const wh_mcs_partners_t *partners = &mcs->wanted.partners;
        const char *why = partners->lossy ? partners->lossy->explain(partners->user, status) : NULL;
        wh_mcs_raise(L, mcs, status, status == WH_STATUS_NOT_RESTORED ? "all is as it was" : why);
    }
    put_back(mcs, saved);
    put_clocks_back(L, mcs, 1);
    const wh_mcs_listener_t *listener = &mcs->wanted.listener;
    if (listener->set_back) {
        listener->set_back(listener->user, &mcs->command, &mcs->state);
    }
    return 0;
}

static bool is_held_otherwise(const saved_t *saved, const wh_mcs_t *mcs) {
    bool differs = false;
    for (size_t i = 0; i < WH_MCS_ROBOTS; ++i) {
        differs = differs || strcmp(saved->held[i].command, mcs->held[i].command) != 0;
    }
    return differs;
}

/* A free place may still tell the job of its last error. */
static bool is_armed_otherwise(const wh_mcs_armed_t *saved, const wh_mcs_armed_t *armed) {
    bool differs = false;
    for (size_t i = 0; i < WH_MCS_ALARMS; ++i) {
        differs = differs || saved->alarms[i] != armed->alarms[i] ||
                  (armed->alarms[i] != WH_OK && saved->alarm_jobs[i] != armed->alarm_jobs[i]);
    }
    return differs;
}

/* A carrier may be told to come before any slice. */
static bool are_ports_otherwise(lua_State *L, const wh_mcs_t *mcs, int saved) {
    const struct wh_ports *ports = mcs->clocks ? mcs->clocks->ports : NULL;
    bool differs = false;
    if (ports && lua_getiuservalue(L, saved, 2) == LUA_TUSERDATA) {
        differs = memcmp(lua_touserdata(L, -1), ports->state, ports->state_bytes) != 0;
        lua_pop(L, 1);
    }
    return differs;
}

/* native.differs(saved): true if a slice was played since, a fault is on its way, or an armed error, a held
 * command or a carrier has come or gone, or a controller is otherwise. */
static int differs_from_saved(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const saved_t *saved = luaL_checkudata(L, 1, SAVED);
    lua_pushboolean(L, saved->track.slice != mcs->track.slice ||
                           saved->command.fault_count != mcs->command.fault_count ||
                           is_armed_otherwise(&saved->armed, &mcs->armed) || is_held_otherwise(saved, mcs) ||
                           are_ports_otherwise(L, mcs, 1) ||
                           memcmp(saved->armed.controllers, mcs->armed.controllers,
                                  sizeof saved->armed.controllers) != 0);
    return 1;
}

/* native.most_undone(): the most commands that UNDO takes back. */
static int count_most(lua_State *L) {
    lua_pushinteger(L, WH_MCS_UNDONE);
    return 1;
}

const luaL_Reg wh_mcs_saved_functions[] = {{"save", save_state},
                                           {"restore", restore_state},
                                           {"differs", differs_from_saved},
                                           {"most_undone", count_most},
                                           {NULL, NULL}};
