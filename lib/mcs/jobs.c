/* Jobs: lines that come while others are played; each job has its own task. */
#include "../script/wh_module_values.h"
#include "playing.h"

static wh_lane_t *lane_of(const wh_mcs_t *mcs, int32_t job) {
    for (size_t i = 0; mcs->lanes && i < WH_MCS_LANES; ++i) {
        if (mcs->lanes->of[i].job == job) {
            return &mcs->lanes->of[i];
        }
    }
    return NULL;
}

void wh_mcs_call(wh_mcs_t *mcs) {
    mcs->stop.is_called = true;
}

bool wh_mcs_job_waits(const wh_mcs_t *mcs, int32_t job) {
    const wh_lane_t *lane = lane_of(mcs, job);
    return lane && lane->waits && !lane->is_patient;
}

void wh_mcs_end_job(wh_mcs_t *mcs, int32_t job, wh_status_t status, const char *why) {
    wh_lane_t *lane = lane_of(mcs, job);
    if (lane) {
        lane->told_why = why;
        wh_mcs_stop_lane(mcs, lane, status);
        mcs->stop.is_called = true;
    }
}

void wh_mcs_hold_job(wh_mcs_t *mcs, int32_t job, bool is_held) {
    wh_lane_t *lane = lane_of(mcs, job);
    if (lane) {
        lane->is_held = is_held;
    }
}

void wh_mcs_end_waits(wh_mcs_t *mcs, wh_status_t status, const char *why) {
    for (size_t i = 0; i < WH_MCS_LANES; ++i) {
        wh_lane_t *lane = &mcs->lanes->of[i];
        if (lane->waits) {
            lane->told = status;
            lane->told_why = why;
        }
    }
}

/* native.next_job(): a job that has come: { number = , line = , may_wait = , robot = from 1, station = };
 * nil: none has. */
static int next_job(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_mcs_job_t job;
    if (!mcs->jobs.take(mcs->jobs.user, &job)) {
        return 0;
    }
    lua_createtable(L, 0, 5);
    wh_lua_set_integer(L, "number", job.number);
    wh_lua_set_text(L, "line", job.line);
    wh_lua_set_boolean(L, "may_wait", job.may_wait);
    if (job.robot != WH_NONE) {
        wh_lua_set_integer(L, "robot", job.robot + 1);
    }
    if (job.station) {
        wh_lua_set_text(L, "station", job.station);
    }
    return 1;
}

/* native.begin_job(job): this task is the job's. */
static int begin_job(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    mcs->lanes->of[mcs->lanes->current].job = (int32_t)luaL_checkinteger(L, 1);
    return 0;
}

/* native.end_line(job, number, answer): a line of the job was executed. Returns the next one; nil: the
 * job is over. */
static int end_line(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    const char *next = mcs->jobs.ended(mcs->jobs.user, (int32_t)luaL_checkinteger(L, 1),
                                       (wh_status_t)luaL_checkinteger(L, 2), wh_lua_whole_text(L, 3));
    lua_pushstring(L, next);
    return 1;
}

/* native.has_jobs(): true while jobs are played; then nothing can be undone. */
static int has_jobs(lua_State *L) {
    lua_pushboolean(L, wh_mcs_of(L)->jobs.take != NULL);
    return 1;
}

/* native.is_told(lane): true if the lane's job, or its waiting command, must end where it is. */
static int is_told_to_end(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_with_layout(L);
    lua_pushboolean(L, mcs->lanes->of[wh_mcs_index(L, 1, WH_MCS_LANES)].told != WH_OK);
    return 1;
}

/* native.heed(): raises the status with which this task must end. */
static int heed_end(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_lane_t *lane = &mcs->lanes->of[mcs->lanes->current];
    const wh_status_t told = lane->told;
    lane->told = WH_OK;
    if (told != WH_OK) {
        wh_mcs_raise(L, mcs, told, lane->told_why);
    }
    return 0;
}

/* native.command_waits(waits, is_patient): this task's command waits, or no longer waits, for something that
 * another one has; if patient, without a limit. */
static int note_wait(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_lane_t *lane = &mcs->lanes->of[mcs->lanes->current];
    lane->waits = lua_toboolean(L, 1) != 0;
    lane->is_patient = lua_toboolean(L, 2) != 0;
    return 0;
}

/* native.refuse_wait(lane): nothing runs that could release what this job waits for. */
static int refuse_wait(lua_State *L) {
    wh_mcs_t *mcs = wh_mcs_with_layout(L);
    wh_lane_t *lane = &mcs->lanes->of[wh_mcs_index(L, 1, WH_MCS_LANES)];
    lane->told = WH_STATUS_BUSY;
    lane->told_why = "the robot stands in the station";
    return 0;
}

/* native.asked_robot(): the robot whose own controller asked the question; nil: it came from another
 * controller. */
static int push_asked_robot(lua_State *L) {
    const wh_mcs_t *mcs = wh_mcs_of(L);
    if (mcs->wanted.asker.robot == 0) {
        return 0;
    }
    lua_pushinteger(L, mcs->wanted.asker.robot);
    return 1;
}

/* native.asked_station(): the station whose own controller asked the question, or nil. */
static int push_asked_station(lua_State *L) {
    lua_pushstring(L, wh_mcs_of(L)->wanted.asker.station);
    return 1;
}

/* native.is_part(): true for a line that UNDO takes back with the one before it. */
static int push_is_part(lua_State *L) {
    lua_pushboolean(L, wh_mcs_of(L)->wanted.asker.is_part);
    return 1;
}

const luaL_Reg wh_mcs_job_functions[] = {
    {"is_part", push_is_part},    {"asked_robot", push_asked_robot}, {"asked_station", push_asked_station},
    {"next_job", next_job},       {"begin_job", begin_job},          {"end_line", end_line},
    {"has_jobs", has_jobs},       {"is_told", is_told_to_end},       {"heed", heed_end},
    {"command_waits", note_wait}, {"refuse_wait", refuse_wait},      {NULL, NULL}};
