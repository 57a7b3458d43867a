/* What motion control does, in one line: for STATUS and VERSION. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "../math/trig.h"
#include "../text/utf8.h"
#include "native.h"

typedef struct {
    char *text; /* of WH_MCS_DESCRIPTION_BYTES */
    size_t length;
} description_t;

__attribute__((format(printf, 2, 3))) static void put(description_t *to, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const size_t room = WH_MCS_DESCRIPTION_BYTES - to->length;
    const int length = vsnprintf(to->text + to->length, room, format, arguments);
    va_end(arguments);
    to->length += length > 0 && (size_t)length < room ? (size_t)length : 0;
    to->text[to->length] = '\0';
}

/* True if a name needs no quotes. */
static bool is_plain(const char *name) {
    const char *plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./-";
    return name[0] != '\0' && name[strspn(name, plain)] == '\0' && strcasecmp(name, "none") != 0;
}

/* A name as it can be typed, as tokens.spell of lua/mcs writes it; null: none. */
static void put_name(description_t *to, const char *name) {
    if (!name || is_plain(name)) {
        put(to, "%s", name ? name : "none");
        return;
    }
    put(to, "\"");
    for (const char *c = name; *c; ++c) {
        put(to, *c == '"' || *c == '\\' ? "\\%c" : "%c", *c);
    }
    put(to, "\"");
}

/* A script's command may be longer than is worth telling. */
static void put_command(description_t *to, const char *text) {
    char begin[1001];
    wh_utf8_clip(begin, sizeof begin, text);
    put_name(to, begin);
}

/* The shortest decimals that read back as the same double. */
static void put_number(description_t *to, const char *name, double value) {
    char text[40];
    for (int digits = 15; digits <= 17; ++digits) {
        snprintf(text, sizeof text, "%.*g", digits, value);
        if (strtod(text, NULL) == value) {
            break;
        }
    }
    put(to, " %s=%s", name, text);
}

/* What the state and these axes, of one slice, tell. */
static void see(wh_mcs_seen_t *seen, const wh_state_t *state, const wh_real_t axes[WH_ROBOT_AXES]) {
    seen->seq = state->seq;
    seen->utime = state->utime;
    memcpy(seen->axes, axes, sizeof seen->axes);
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        seen->held[g] = g < state->gripper_count ? state->grippers[g].wafer : WH_NONE;
    }
}

/* In a free run the state is of an earlier slice than the command. */
static void hear_slice(void *user, const wh_command_t *command, const wh_state_t *state) {
    wh_mcs_t *mcs = user;
    wh_mcs_sent_t *sent = &mcs->sent[command->seq % WH_MCS_SENT];
    sent->seq = command->seq;
    memcpy(sent->axes, command->axes, sizeof sent->axes);
    const wh_mcs_sent_t *answered = &mcs->sent[state->seq % WH_MCS_SENT];
    if (state->seq > mcs->seen.seq && answered->seq == state->seq) {
        see(&mcs->seen, state, answered->axes);
    }
}

void wh_mcs_watch_slices(wh_mcs_t *mcs) {
    see(&mcs->seen, &mcs->state, mcs->track.axes);
    wh_mcs_listen(mcs, hear_slice, mcs);
}

static void put_robot(description_t *to, const wh_real_t axes[WH_ROBOT_AXES]) {
    static const char *const names[WH_ROBOT_AXES] = {"theta", "r", "z", "yaw"};
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        const bool turns = axis == WH_AXIS_THETA || axis == WH_AXIS_YAW;
        const double at = axes[axis];
        put_number(to, names[axis], turns ? wh_deg_from_rad(at) : at);
    }
}

static void put_grippers(description_t *to, const wh_layout_t *layout, const int32_t held[]) {
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        put(to, " ");
        put_name(to, layout->grippers[g].name);
        put(to, ".holds=");
        put_name(to, held[g] == WH_NONE ? NULL : layout->wafers[held[g]].name);
    }
}

static void put_error(description_t *to, const wh_record_t *record) {
    size_t i = record->command_count;
    while (i > 0 && record->commands[i - 1].error == WH_OK) {
        --i;
    }
    put(to, " error=%d", i > 0 ? (int)record->commands[i - 1].error : 0);
    if (i > 0) {
        put(to, " error_name=%s error_command=", wh_status_name(record->commands[i - 1].error));
        put_command(to, record->commands[i - 1].text);
    }
}

/* What runs, or else what is held. */
static void put_phase(description_t *to, const wh_mcs_t *mcs) {
    const int32_t running = mcs->recorder.running;
    if (running != WH_NONE) {
        put(to, "phase=running command=");
        put_command(to, mcs->recorder.record->commands[running].text);
    } else if (mcs->held.command[0] != '\0') {
        put(to, "phase=held command=");
        put_command(to, mcs->held.command);
        put(to, " stop=%s", mcs->held.phase);
    } else {
        put(to, "phase=idle");
    }
}

void wh_mcs_describe(const wh_mcs_t *mcs, char text[WH_MCS_DESCRIPTION_BYTES]) {
    description_t to = {text, 0};
    wh_mcs_seen_t seen = mcs->seen;
    if (!mcs->partners.connect) {
        see(&seen, &mcs->state, mcs->track.axes);
    }
    put_phase(&to, mcs);
    put(&to, " seq=%lld", (long long)seen.seq);
    put_number(&to, "time", (double)seen.utime / 1e6);
    if (mcs->layout) {
        put_robot(&to, seen.axes);
        put_grippers(&to, mcs->layout, seen.held);
    }
    put_error(&to, mcs->recorder.record);
}

/* native.status(): that text. */
static int describe(lua_State *L) {
    char text[WH_MCS_DESCRIPTION_BYTES];
    wh_mcs_describe(wh_mcs_of(L), text);
    lua_pushstring(L, text);
    return 1;
}

/* native.version(): the program's. */
static int tell_version(lua_State *L) {
    lua_pushliteral(L, WH_VERSION);
    return 1;
}

const luaL_Reg wh_mcs_describe_functions[] = {{"status", describe}, {"version", tell_version}, {NULL, NULL}};
