#include "survey.h"

#include <stdio.h>
#include <string.h>

#include "../mcs/native.h"
#include "../mcs/other_cell.h"
#include "../sim/event_text.h"

/* Registry keys of the functions that check a station, play there, and turn over there. */
static char look_key, play_key, flip_key;

/* -------------------------------------------------------------------------------------------- one station */

/* Neighbouring slots at which the same command is refused: one finding, with the first one's reason. */
typedef struct {
    wh_survey_t *survey;
    const wh_layout_t *layout;
    wh_feasibility_t *check;
    size_t station;
    size_t from;          /* the station whose wafers are put there: its own, or another one */
    bool is_home;         /* the robots turn over at home */
    int32_t blade;        /* WH_NONE: the station's effector; else another gripper on the robot */
    int32_t first, last;  /* slots; 0: none yet */
    size_t round, rounds; /* of all tryouts to be played */
    char word[8];
    char reason[WH_SANDBOX_MESSAGE_BYTES];
} job_t;

static void add_finding(job_t *job) {
    char slots[40];
    if (job->first == 0) {
        return;
    }
    if (job->first == job->last) {
        snprintf(slots, sizeof slots, "slot %d", (int)job->first);
    } else {
        snprintf(slots, sizeof slots, "slots %d to %d", (int)job->first, (int)job->last);
    }
    wh_finding_t *finding =
        wh_feasibility_add(job->check, WH_FINDING_REACH, (int32_t)job->station, "%s %s: %s: %s",
                           job->layout->stations[job->station].name, slots, job->word, job->reason);
    finding->slot = job->first;
    job->first = 0;
}

/* found(slot, word, reason), of lua/mcs/reach.lua. */
static int take_refusal(lua_State *L) {
    job_t *job = lua_touserdata(L, lua_upvalueindex(1));
    const int32_t slot = (int32_t)luaL_checkinteger(L, 1);
    const char *word = luaL_checkstring(L, 2);
    const char *reason = luaL_checkstring(L, 3);
    if (job->first != 0 && slot == job->last + 1 && strcmp(job->word, word) == 0) {
        job->last = slot;
        return 0;
    }
    add_finding(job);
    job->first = job->last = slot;
    snprintf(job->word, sizeof job->word, "%s", word);
    snprintf(job->reason, sizeof job->reason, "%s", reason);
    return 0;
}

/* missed(slot, word, reason, gripper), of lua/mcs/reach.lua. */
static int take_warning(lua_State *L) {
    job_t *job = lua_touserdata(L, lua_upvalueindex(1));
    const int32_t slot = (int32_t)luaL_checkinteger(L, 1);
    add_finding(job);
    wh_feasibility_add(job->check, WH_FINDING_REACH, (int32_t)job->station, "%s slot %d: %s with %s: %s",
                       job->layout->stations[job->station].name, (int)slot, luaL_checkstring(L, 2),
                       luaL_checkstring(L, 4), luaL_checkstring(L, 3))
        ->slot = slot;
    wh_feasibility_warn(job->check);
    return 0;
}

static void push_function(lua_State *L, job_t *job, lua_CFunction function) {
    lua_pushlightuserdata(L, job);
    lua_pushcclosure(L, function, 1);
}

/* ------------------------------------------------------------------------------------------------ playing */

/* " with UP", unless the station's effector is played. */
static const char *with_blade(const job_t *job, char text[WH_NAME_SIZE + 8]) {
    text[0] = '\0';
    if (job->blade != WH_NONE) {
        snprintf(text, WH_NAME_SIZE + 8, " with %s", job->layout->grippers[job->blade].name);
    }
    return text;
}

/* failed(slot, word, reason), of lua/mcs/reach.lua: a GET or PUT that failed when played. A wafer that
 * lies on the blade as another station has it may touch this one's ledges: in a cell without a collision
 * check that is a warning. A failure that only a command naming the blade meets is a warning, too. */
static int take_failure(lua_State *L) {
    job_t *job = lua_touserdata(L, lua_upvalueindex(1));
    char with[WH_NAME_SIZE + 8];
    const int32_t slot = (int32_t)luaL_checkinteger(L, 1);
    const bool touches = wh_tryout_touched(&job->survey->tryout);
    wh_feasibility_add(job->check, WH_FINDING_PLAY, (int32_t)job->station, "%s slot %d: %s%s: %s",
                       job->layout->stations[job->station].name, (int)slot, luaL_checkstring(L, 2),
                       with_blade(job, with), luaL_checkstring(L, 3))
        ->slot = slot;
    if (job->blade != WH_NONE || (job->from != job->station && touches && !job->layout->collision)) {
        wh_feasibility_warn(job->check);
    }
    return 0;
}

static const wh_real_t *read_cell_axes(lua_State *L, const wh_layout_t *layout, wh_real_t axes[WH_AXES]) {
    luaL_checktype(L, 1, LUA_TTABLE);
    for (size_t axis = 0; axis < layout->machine.axis_count; ++axis) {
        lua_rawgeti(L, 1, (lua_Integer)axis + 1);
        axes[axis] = luaL_checknumber(L, -1);
        lua_pop(L, 1);
    }
    return axes;
}

/* `what`: a FLIP and its place; null: GET, followed by a PUT. */
static void say_too_long(const job_t *job, const char *what, int64_t slices) {
    const int32_t station = job->is_home ? WH_NONE : (int32_t)job->station;
    char with[WH_NAME_SIZE + 8];
    if (what) {
        wh_feasibility_add(job->check, WH_FINDING_PLAY, station, "%s takes %lld slices: it was not played",
                           what, (long long)slices);
    } else {
        wh_feasibility_add(job->check, WH_FINDING_PLAY, station,
                           "%s: GET%s takes %lld slices: GET and PUT were not played here",
                           job->layout->stations[job->station].name, with_blade(job, with),
                           (long long)slices);
    }
    wh_feasibility_warn(job->check);
}

/* cell.stage(axes, empty, what): makes a full cell in which the robot stands there; with `empty` a wafer
 * will be put into that slot. False: the last plan takes too long to be played, and a warning says so. */
static int stage_cell(lua_State *L) {
    const job_t *job = lua_touserdata(L, lua_upvalueindex(1));
    wh_survey_t *survey = job->survey;
    wh_real_t axes[WH_AXES] = {0};
    const int64_t slices = wh_other_cell_planned(&survey->mcs);
    const int32_t empty = (int32_t)luaL_optinteger(L, 2, 0);
    (void)read_cell_axes(L, job->layout, axes);
    const bool fits = 2 * slices <= WH_TRYOUT_SLICES;
    if (!fits) {
        say_too_long(job, luaL_optstring(L, 3, NULL), slices);
    } else {
        const wh_status_t status = wh_tryout_begin(&survey->tryout, job->from, axes, job->station, empty);
        if (status != WH_OK) {
            return luaL_error(L, "%s: %s", job->layout->path, wh_record_error_text(status));
        }
    }
    lua_pushboolean(L, fits);
    return 1;
}

/* cell.move(axes): the robot stands there, with its held wafers. */
static int move_robot(lua_State *L) {
    const job_t *job = lua_touserdata(L, lua_upvalueindex(1));
    wh_real_t axes[WH_AXES] = {0};
    wh_tryout_move(&job->survey->tryout, read_cell_axes(L, job->layout, axes));
    return 0;
}

/* cell.begin(): earlier complaints do not count. */
static int begin_anew(lua_State *L) {
    const job_t *job = lua_touserdata(L, lua_upvalueindex(1));
    wh_tryout_move(&job->survey->tryout, NULL);
    return 0;
}

/* cell.complaint(): the cell's first complaint since then, or nil. */
static int find_cell_complaint(lua_State *L) {
    const job_t *job = lua_touserdata(L, lua_upvalueindex(1));
    char text[WH_EVENT_TEXT_SIZE];
    if (wh_tryout_complained(&job->survey->tryout, text, sizeof text)) {
        lua_pushstring(L, text);
        return 1;
    }
    if (job->from == job->station && job->blade == WH_NONE) {
        wh_tryout_note_lift(&job->survey->tryout, job->station);
    }
    return 0;
}

/* A station that already has a finding is not played: the finding would come again. */
static bool is_to_be_played(const job_t *job) {
    bool good = job->layout->stations[job->station].taught;
    for (size_t i = 0; good && i < job->check->count; ++i) {
        const wh_finding_t *finding = &job->check->findings[i];
        const bool here =
            finding->station == (int32_t)job->station || finding->other == (int32_t)job->station;
        good = finding->is_warning || !here;
    }
    return good;
}

static void push_cell(lua_State *L, job_t *job) {
    static const luaL_Reg cell[] = {{"stage", stage_cell},
                                    {"move", move_robot},
                                    {"begin", begin_anew},
                                    {"complaint", find_cell_complaint},
                                    {NULL, NULL}};
    lua_newtable(L);
    lua_pushlightuserdata(L, job);
    luaL_setfuncs(L, cell, 1);
}

/* Runs protected. */
static int play_at_station(lua_State *L) {
    job_t *job = lua_touserdata(L, 1);
    lua_rawgetp(L, LUA_REGISTRYINDEX, &play_key);
    if (job->from != job->station) {
        lua_pushstring(L, job->layout->stations[job->from].name);
    } else {
        lua_pushnil(L);
    }
    lua_pushstring(L, job->layout->stations[job->station].name);
    push_cell(L, job);
    push_function(L, job, take_failure);
    if (job->blade != WH_NONE) {
        lua_pushinteger(L, (lua_Integer)job->blade + 1);
    } else {
        lua_pushnil(L);
    }
    lua_call(L, 5, 0);
    return 0;
}

/* failed(slot, what, reason), of lua/mcs/flip_room.lua: a FLIP without room. A script may turn over
 * elsewhere, so it is a warning. */
static int take_no_room(lua_State *L) {
    job_t *job = lua_touserdata(L, lua_upvalueindex(1));
    const int32_t slot = (int32_t)luaL_checkinteger(L, 1);
    wh_feasibility_add(job->check, WH_FINDING_PLAY, slot > 0 ? (int32_t)job->station : WH_NONE, "%s: %s",
                       luaL_checkstring(L, 2), luaL_checkstring(L, 3))
        ->slot = slot;
    wh_feasibility_warn(job->check);
    return 0;
}

/* Runs protected. */
static int turn_over(lua_State *L) {
    job_t *job = lua_touserdata(L, 1);
    lua_rawgetp(L, LUA_REGISTRYINDEX, &flip_key);
    if (job->is_home) {
        lua_pushnil(L);
    } else {
        lua_pushstring(L, job->layout->stations[job->station].name);
    }
    push_cell(L, job);
    push_function(L, job, take_no_room);
    lua_call(L, 3, 0);
    return 0;
}

/* ---------------------------------------------------------------------------------------------- all of it */

/* Runs protected. */
static int begin_survey(lua_State *L) {
    const job_t *job = lua_touserdata(L, 1);
    wh_mcs_push_survey(L);
    wh_mcs_set_up(L, &job->survey->mcs, job->layout);
    lua_call(L, 1, 3);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &flip_key);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &play_key);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &look_key);
    return 0;
}

/* Runs protected. */
static int look_at_station(lua_State *L) {
    job_t *job = lua_touserdata(L, 1);
    lua_rawgetp(L, LUA_REGISTRYINDEX, &look_key);
    lua_pushstring(L, job->layout->stations[job->station].name);
    push_function(L, job, take_refusal);
    push_function(L, job, take_warning);
    lua_call(L, 3, 0);
    return 0;
}

/* Adds what nobody looks at, so that silence is no verdict. */
static void warn_of_untaught(job_t *job) {
    const wh_layout_station_t *station = &job->layout->stations[job->station];
    if (!station->taught) {
        wh_feasibility_add(job->check, WH_FINDING_REACH, (int32_t)job->station,
                           "%s: %s: GET and PUT there are not looked at", station->name,
                           wh_layout_is_served(job->layout, job->station) ? "taught = false"
                                                                          : "no robot with axes serves it");
        wh_feasibility_warn(job->check);
    }
}

static void tell_survey(const job_t *job) {
    const wh_survey_t *survey = job->survey;
    if (survey->tell) {
        survey->tell(survey->user, "visits to stations played", job->round, job->rounds);
    }
}

static bool play_by(job_t *job, lua_CFunction function, wh_sandbox_t *sandbox, wh_sandbox_result_t *result) {
    tell_survey(job);
    wh_sandbox_renew(sandbox);
    const bool good = wh_sandbox_protect(wh_sandbox_state(sandbox), function, job, result);
    wh_tryout_end(&job->survey->tryout);
    return good;
}

static bool play_survey(job_t *job, wh_sandbox_t *sandbox, wh_sandbox_result_t *result) {
    return play_by(job, play_at_station, sandbox, result);
}

/* The rest of a large cell is not played, and a warning says so. */
static bool is_spent_by(const job_t *job, const char *words) {
    const bool spent = job->survey->tryout.slices > WH_TRYOUT_ALL_SLICES;
    char with[WH_NAME_SIZE + 8];
    if (spent) {
        wh_feasibility_add(job->check, WH_FINDING_PLAY, (int32_t)job->station,
                           "%s: %s%s%s were not played here, nor what follows: after %d slices no more is",
                           job->layout->stations[job->station].name, words,
                           job->from == job->station ? "" : " of other stations' wafers",
                           with_blade(job, with), WH_TRYOUT_ALL_SLICES);
        wh_feasibility_warn(job->check);
    }
    return spent;
}

static bool is_spent(const job_t *job) {
    return is_spent_by(job, "GET and PUT");
}

/* Plays a station with wafers of others, up to the first finding. */
static bool play_carried(job_t *job, wh_sandbox_t *sandbox, wh_sandbox_result_t *result, bool *spent) {
    const size_t found = job->check->count;
    bool good = true;
    for (job->from = 0; good && !*spent && job->from < job->layout->station_count; ++job->from) {
        if (is_to_be_played(job) && wh_tryout_is_new(&job->survey->tryout, job->from, job->station)) {
            *spent = is_spent(job);
            good = *spent || play_survey(job, sandbox, result);
        }
        if (job->check->count > found) {
            break;
        }
    }
    return good;
}

/* Wafers of other stations are not played in a cell that is too large, and a warning says so. */
static bool is_too_large(const job_t *job) {
    const size_t slots = wh_tryout_slots(&job->survey->tryout);
    const bool large = slots > WH_TRYOUT_WAFERS;
    if (large && job->layout->station_count > 1) {
        wh_feasibility_add(job->check, WH_FINDING_PLAY, WH_NONE,
                           "PUT of other stations' wafers was not played: of a cell with more than %d slots, "
                           "here %zu, it is not",
                           WH_TRYOUT_WAFERS, slots);
        wh_feasibility_warn(job->check);
    }
    return large;
}

/* Plays a station with the robot's other blades. */
static bool play_blades(job_t *job, wh_sandbox_t *sandbox, wh_sandbox_result_t *result, bool *spent) {
    const wh_layout_t *layout = job->layout;
    const int32_t count = (int32_t)layout->machine.gripper_count;
    bool good = true;
    job->from = job->station;
    for (int32_t g = 0; good && !*spent && g < count; ++g) {
        const wh_layout_station_t *station = &layout->stations[job->station];
        const bool serves = !station->by || station->by[layout->machine.mounts[g].robot].serves;
        if (serves && g != station->effector && layout->grippers[g].station == WH_NONE &&
            is_to_be_played(job)) {
            job->blade = g;
            *spent = is_spent(job);
            good = *spent || play_survey(job, sandbox, result);
        }
    }
    job->blade = WH_NONE;
    return good;
}

/* Plays a station with its own wafers. */
static bool play_own(job_t *job, wh_sandbox_t *sandbox, wh_sandbox_result_t *result, bool *spent) {
    job->from = job->station;
    *spent = is_spent(job);
    return *spent || !is_to_be_played(job) || play_survey(job, sandbox, result);
}

/* True if the layout can turn wafers over. */
static bool has_flips(const wh_layout_t *layout) {
    bool has = false;
    for (const wh_carrier_t *robot = layout->machine.carrier; robot; robot = robot->next) {
        has = has || robot->chain.has_flip;
    }
    for (size_t s = 0; s < layout->station_count; ++s) {
        has = has || layout->stations[s].flipper;
    }
    return has;
}

/* Plays FLIP at home, while slices are left. */
static bool play_home(job_t *job, wh_sandbox_t *sandbox, wh_sandbox_result_t *result) {
    job->is_home = true;
    const bool good = !has_flips(job->layout) || play_by(job, turn_over, sandbox, result);
    job->is_home = false;
    return good;
}

/* Plays FLIP in front of a station and in its clamp. */
static bool play_flips(job_t *job, wh_sandbox_t *sandbox, wh_sandbox_result_t *result, bool *spent) {
    if (!has_flips(job->layout)) {
        return true;
    }
    job->from = job->station;
    *spent = is_spent_by(job, "FLIPs");
    return *spent || !is_to_be_played(job) || play_by(job, turn_over, sandbox, result);
}

typedef bool (*step_t)(job_t *job, wh_sandbox_t *sandbox, wh_sandbox_result_t *result, bool *spent);

/* Plays each station with its own wafers, then with wafers that lie on the blade as other stations have
 * them, then with the other blades; then the FLIPs. */
static bool play_all(job_t *job, wh_sandbox_t *sandbox, wh_sandbox_result_t *result) {
    static const step_t steps[] = {play_own, play_carried, play_blades, play_flips};
    bool good = true, spent = false;
    job->rounds = sizeof steps / sizeof *steps * job->layout->station_count;
    for (size_t i = 0; i < sizeof steps / sizeof *steps; ++i) {
        if (steps[i] == play_carried && good && !spent && is_too_large(job)) {
            continue;
        }
        for (job->station = 0; good && !spent && job->station < job->layout->station_count; ++job->station) {
            job->round = i * job->layout->station_count + job->station;
            good = steps[i](job, sandbox, result, &spent);
        }
    }
    return good;
}

bool wh_survey_open(wh_survey_t *survey, wh_sandbox_t *sandbox, const wh_layout_t *layout,
                    wh_feasibility_t *check, wh_sandbox_result_t *result) {
    lua_State *L = wh_sandbox_state(sandbox);
    job_t job = {.survey = survey, .layout = layout, .check = check, .blade = WH_NONE};
    wh_survey_tell_t *const told = survey->tell;
    void *const user = survey->user;
    memset(survey, 0, sizeof *survey);
    survey->tell = told;
    survey->user = user;
    wh_sandbox_renew(sandbox);
    bool good = wh_mcs_open(&survey->mcs, sandbox, layout->path, &survey->record, result) &&
                wh_sandbox_protect(L, begin_survey, &job, result);
    wh_tryout_open(&survey->tryout, &survey->mcs, layout);
    for (; good && job.station < layout->station_count; ++job.station) {
        wh_sandbox_renew(sandbox);
        good =
            !wh_layout_is_served(layout, job.station) || wh_sandbox_protect(L, look_at_station, &job, result);
        add_finding(&job);
        warn_of_untaught(&job);
    }
    job.station = job.from = 0;
    return good && play_home(&job, sandbox, result) && play_all(&job, sandbox, result);
}

void wh_survey_close(wh_survey_t *survey) {
    wh_tryout_close(&survey->tryout);
    wh_mcs_close(&survey->mcs);
    wh_record_free(&survey->record);
}
