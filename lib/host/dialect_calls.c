/* Calls a dialect's functions: decode, run and the encoders. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <lauxlib.h>

#include "../layout/axes.h"
#include "../record/record.h"
#include "../script/wh_module_values.h"
#include "../text/array.h"
#include "../text/utf8.h"
#include "dialect.h"
#include "values.h"

const char *const wh_encoder_names[WH_ENCODERS] = {[WH_ENCODE_ACKNOWLEDGE] = "acknowledge",
                                                   [WH_ENCODE_ANSWER] = "answer",
                                                   [WH_ENCODE_COMPLETE] = "complete",
                                                   [WH_ENCODE_REFUSE] = "refuse",
                                                   [WH_ENCODE_BAD] = "bad",
                                                   [WH_ENCODE_EVENT] = "event",
                                                   [WH_ENCODE_UNACKNOWLEDGED] = "unacknowledged"};

/* ---------------------------------------------------------------------------------------------- refusals */

/* A call of one function, and its result. */
typedef struct {
    wh_dialect_t *dialect;
    const char *frame;
    size_t size;
    wh_request_t *request;
    wh_lines_t *lines;
    wh_encoder_t encoder;
    const wh_told_t *told;
} call_t;

/* A field of the error's table, as a text. */
static void take_error_text(lua_State *L, const char *field, char *text, size_t size) {
    lua_pushstring(L, field);
    lua_rawget(L, -2);
    (void)snprintf(text, size, "%s", lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1) : "");
    lua_pop(L, 1);
}

/* Reads a text that a host has sent. Its control characters become \xNN: they cannot steer a terminal. */
static void take_visible(lua_State *L, const char *field, char *text, size_t size) {
    size_t length = 0;
    lua_pushstring(L, field);
    lua_rawget(L, -2);
    const char *said = lua_type(L, -1) == LUA_TSTRING ? lua_tolstring(L, -1, &length) : "";
    wh_utf8_visible_bytes(text, size, said, length);
    lua_pop(L, 1);
}

bool wh_dialect_refused(const wh_dialect_t *dialect, wh_failure_t *failure) {
    lua_State *L = wh_sandbox_state(dialect->sandbox);
    bool is_refusal = false;
    memset(failure, 0, sizeof *failure);
    wh_sandbox_push_error(L);
    if (lua_istable(L, -1)) {
        lua_pushliteral(L, "refused");
        is_refusal = lua_rawget(L, -2) == LUA_TNUMBER;
        failure->number = (wh_status_t)lua_tointeger(L, -1);
        lua_pop(L, 1);
        take_error_text(L, "code", failure->code, sizeof failure->code);
        take_visible(L, "detail", failure->detail, sizeof failure->detail);
    }
    lua_pop(L, 1);
    if (is_refusal && failure->code[0] == '\0') {
        (void)snprintf(failure->code, sizeof failure->code, "%s", wh_dialect_code(dialect, failure->number));
    }
    return is_refusal;
}

/* Calls with a fresh budget. */
static bool call_dialect(wh_dialect_t *dialect, lua_CFunction function, call_t *argument) {
    wh_sandbox_result_t result;
    wh_sandbox_renew(dialect->sandbox);
    if (wh_sandbox_protect(wh_sandbox_state(dialect->sandbox), function, argument, &result)) {
        return true;
    }
    wh_dialect_note(dialect, result.message);
    return false;
}

static wh_decoded_t outcome_of(wh_dialect_t *dialect, bool done, wh_failure_t *failure) {
    if (done) {
        return WH_DECODED_REQUEST;
    }
    return wh_dialect_refused(dialect, failure) ? WH_DECODED_REFUSED : WH_DECODED_MISTAKE;
}

/* Pushes a field of the dialect's table and of the table in it. */
static void push_of(lua_State *L, const char *field, const char *within) {
    lua_rawgetp(L, LUA_REGISTRYINDEX, &wh_dialect_key);
    lua_getfield(L, -1, field);
    lua_remove(L, -2);
    if (within) {
        lua_getfield(L, -1, within);
        lua_remove(L, -2);
    }
}

/* ----------------------------------------------------------------------------------------------- decoding */

/* Raises what host.refuse does. */
__attribute__((noreturn)) static void refuse(lua_State *L, wh_status_t number, const char *detail) {
    lua_createtable(L, 0, 2);
    wh_lua_set_integer(L, "refused", number);
    wh_lua_set_text(L, "detail", detail);
    lua_error(L);
    abort();
}

/* Takes a field of the request that is on top of the stack: a text, or a whole number. A text that is too
 * long for a word or has a byte 0 came from the host, and is refused by this error. */
static bool take_word(lua_State *L, const char *field, wh_status_t refusal, char *word) {
    size_t size = 0;
    lua_getfield(L, -1, field);
    const bool is_word = lua_type(L, -1) == LUA_TSTRING || lua_isinteger(L, -1);
    const char *text = is_word ? lua_tolstring(L, -1, &size) : "";
    if (!is_word && !lua_isnil(L, -1)) {
        luaL_error(L, "decode returned a request's %s that is neither a text nor a whole number", field);
    }
    if (size >= WH_DIALECT_NAME_BYTES || strlen(text) != size) {
        char shown[WH_DIALECT_NAME_BYTES];
        wh_utf8_visible_bytes(shown, sizeof shown, text, size);
        refuse(L, refusal, shown);
    }
    (void)snprintf(word, WH_DIALECT_NAME_BYTES, "%s", text);
    lua_pop(L, 1);
    return is_word;
}

static const wh_dialect_command_t *find_command(const wh_dialect_t *dialect, const char *name) {
    for (size_t i = 0; i < dialect->command_count; ++i) {
        if (strcmp(dialect->commands[i].name, name) == 0) {
            return &dialect->commands[i];
        }
    }
    return NULL;
}

/* Runs protected. */
static int decode_frame(lua_State *L) {
    char name[WH_DIALECT_NAME_BYTES];
    call_t *it = lua_touserdata(L, 1);
    push_of(L, "decode", NULL);
    lua_pushlstring(L, it->frame, it->size);
    lua_call(L, 1, 1);
    if (lua_isnil(L, -1)) {
        return 0;
    }
    if (!lua_istable(L, -1)) {
        return luaL_error(L, "%s: decode returned no request (expected a table, or nil)", it->dialect->path);
    }
    lua_pushvalue(L, -1);
    it->request->reference = luaL_ref(L, LUA_REGISTRYINDEX);
    (void)take_word(L, "sequence", WH_STATUS_BAD_ARGUMENT, it->request->sequence);
    if (!take_word(L, "command", WH_STATUS_NO_SUCH_COMMAND, name)) {
        return luaL_error(L, "%s: decode returned a request without a command", it->dialect->path);
    }
    it->request->command = find_command(it->dialect, name);
    if (!it->request->command) {
        refuse(L, WH_STATUS_NO_SUCH_COMMAND, name);
    }
    return 0;
}

wh_decoded_t wh_dialect_decode(wh_dialect_t *dialect, const char *frame, size_t size, wh_request_t *request,
                               wh_failure_t *failure) {
    call_t it = {.dialect = dialect, .frame = frame, .size = size, .request = request};
    *request = (wh_request_t){.reference = LUA_NOREF};
    memset(failure, 0, sizeof *failure);
    const bool done = call_dialect(dialect, decode_frame, &it);
    const wh_decoded_t outcome = outcome_of(dialect, done, failure);
    const bool is_none = outcome == WH_DECODED_REQUEST && !request->command;
    return is_none ? WH_DECODED_NOTHING : outcome;
}

void wh_dialect_forget(wh_dialect_t *dialect, wh_request_t *request) {
    if (request->reference != LUA_NOREF) {
        luaL_unref(wh_sandbox_state(dialect->sandbox), LUA_REGISTRYINDEX, request->reference);
    }
    *request = (wh_request_t){.reference = LUA_NOREF};
}

/* -------------------------------------------------------------------------------------------------- lines */

static void take_typed_line(lua_State *L, const call_t *it) {
    const wh_dialect_command_t *command = it->request->command;
    size_t size = 0;
    const char *text = lua_type(L, -1) == LUA_TSTRING ? lua_tolstring(L, -1, &size) : NULL;
    if (!text) {
        luaL_error(L, "%s: commands.%s.run returned no line", it->dialect->path, command->name);
        return;
    }
    if (size >= WH_DIALECT_LINE_BYTES || strlen(text) != size) {
        refuse(L, WH_STATUS_BAD_ARGUMENT, "a line that is too long, or has a byte 0");
    }
    const wh_word_t *word = command->kind == WH_WORD_LOCAL ? NULL : wh_word_of(text);
    bool is_one_of_them = command->kind == WH_WORD_LOCAL;
    for (size_t i = 0; i < command->does_count; ++i) {
        is_one_of_them = is_one_of_them || word == command->does[i];
    }
    if (!is_one_of_them) {
        luaL_error(L, "%s: commands.%s.run: \"%s\" (expected a line of what `does` names)", it->dialect->path,
                   command->name, text);
    }
    if (it->lines->count == WH_DIALECT_LINES) {
        luaL_error(L, "%s: commands.%s.run: \"%s\" (expected at most %d lines)", it->dialect->path,
                   command->name, text, WH_DIALECT_LINES);
    }
    memcpy(it->lines->lines[it->lines->count++], text, size + 1);
    lua_pop(L, 1);
}

/* Runs protected. */
static int run_command(lua_State *L) {
    call_t *it = lua_touserdata(L, 1);
    const wh_dialect_command_t *command = it->request->command;
    push_of(L, "commands", command->name);
    if (lua_getfield(L, -1, "run") == LUA_TNIL) {
        lua_pushstring(L, command->does[0]->name);
    } else {
        lua_rawgeti(L, LUA_REGISTRYINDEX, it->request->reference);
        lua_call(L, 1, 1);
    }
    if (!lua_istable(L, -1)) {
        take_typed_line(L, it);
        return 0;
    }
    for (lua_Integer i = 1; lua_geti(L, -1, i) != LUA_TNIL; ++i) {
        take_typed_line(L, it);
    }
    lua_pop(L, 1);
    if (it->lines->count == 0) {
        return luaL_error(L, "%s: commands.%s.run returned no line", it->dialect->path, command->name);
    }
    return 0;
}

wh_decoded_t wh_dialect_run(wh_dialect_t *dialect, const wh_request_t *request, wh_lines_t *lines,
                            wh_failure_t *failure) {
    wh_request_t asked = *request;
    call_t it = {.dialect = dialect, .request = &asked, .lines = lines};
    lines->count = 0;
    memset(failure, 0, sizeof *failure);
    return outcome_of(dialect, call_dialect(dialect, run_command, &it), failure);
}

/* ----------------------------------------------------------------------------------------------- encoding */

static void push_request(lua_State *L, const wh_request_t *request) {
    if (!request || request->reference == LUA_NOREF) {
        lua_newtable(L);
    } else {
        lua_rawgeti(L, LUA_REGISTRYINDEX, request->reference);
    }
}

/* Sets ok, number, name, code and text of an error, or of none, in the table on top of the stack. */
static void set_error(lua_State *L, const wh_dialect_t *dialect, wh_status_t number, const char *code) {
    wh_lua_set_boolean(L, "ok", number == WH_OK);
    wh_lua_set_integer(L, "number", number);
    if (number != WH_OK) {
        wh_lua_set_text(L, "name", wh_status_name(number));
        wh_lua_set_text(L, "code", code[0] != '\0' ? code : wh_dialect_code(dialect, number));
        wh_lua_set_text(L, "text", wh_record_error_text(number));
    }
}

static void push_failure(lua_State *L, const wh_dialect_t *dialect, const wh_failure_t *failure) {
    lua_newtable(L);
    set_error(L, dialect, failure->number, failure->code);
    wh_lua_set_text(L, "detail", failure->detail);
}

/* Sets `state`, theirs, of the table on top of the stack. */
static void set_state(lua_State *L, const wh_result_t *result) {
    char phase[WH_DIALECT_NAME_BYTES];
    wh_value_copy(result->status, "phase", phase, sizeof phase);
    push_of(L, "states", NULL);
    if (lua_istable(L, -1)) {
        lua_getfield(L, -1, result->is_held ? "held" : phase);
        lua_setfield(L, -3, "state");
    }
    lua_pop(L, 1);
}

/* The port's robot; the first robot if the port has none or stands for the whole cell. */
static size_t find_robot(const wh_result_t *result) {
    const wh_port_mechanism_t *mechanism = result->mechanism;
    const bool is_named = mechanism->kind == WH_MECHANISM_ROBOT && mechanism->name;
    return result->layout->robot_count > 1 && is_named ? (size_t)mechanism->index : 0;
}

/* The name of an axis in STATUS: with several robots its robot's name comes first. */
static void name_axis(const wh_result_t *result, const char *axis, char name[WH_DIALECT_LINE_BYTES]) {
    const wh_layout_t *layout = result->layout;
    char robot[WH_DIALECT_NAME_BYTES * (size_t)3] = "";
    const bool has_several = layout->robot_count > 1;
    if (has_several) {
        (void)wh_value_spell(layout->robots[find_robot(result)].name, robot, sizeof robot);
    }
    (void)snprintf(name, WH_DIALECT_LINE_BYTES, "%s%s%s", robot, has_several ? "." : "", axis);
}

/* The sign of an axis in their direction. */
static double sign_of(const wh_dialect_t *dialect, const char *axis) {
    static const char *const signed_axes[] = {"theta", "r", "z", "yaw"};
    for (size_t i = 0; i < sizeof signed_axes / sizeof signed_axes[0]; ++i) {
        if (strcmp(axis, signed_axes[i]) == 0) {
            return dialect->units.signs[i];
        }
    }
    return 1;
}

static void set_axis(lua_State *L, const wh_dialect_t *dialect, const wh_result_t *result, size_t axis) {
    const wh_machine_t *machine = &result->layout->machine;
    const char *own = wh_axis_name(machine, axis);
    const double unit = wh_axis_turns(machine, axis) ? dialect->units.angle : dialect->units.length;
    char name[WH_DIALECT_LINE_BYTES];
    name_axis(result, own, name);
    const double at = strtod(wh_value_begin(result->status, name), NULL);
    wh_lua_set_number(L, own, sign_of(dialect, own) * at / unit + 0.0); /* no -0 */
}

/* Sets only the axes that the robot has. */
static void set_position(lua_State *L, const wh_dialect_t *dialect, const wh_result_t *result) {
    const wh_machine_t *machine = result->layout ? &result->layout->machine : NULL;
    lua_createtable(L, 0, WH_CHAIN_AXES);
    for (size_t axis = 0; machine && axis < wh_machine_robot_axes(machine); ++axis) {
        size_t own;
        if (wh_machine_robot_of(machine, axis, &own) == (int32_t)find_robot(result) &&
            wh_axis_exists(machine, axis)) {
            set_axis(L, dialect, result, axis);
        }
    }
    lua_setfield(L, -2, "position");
}

/* Sets fields by our name of a gripper, as it is typed. */
static void set_sensors(lua_State *L, const wh_result_t *result) {
    const wh_layout_t *layout = result->layout;
    char spelt[WH_DIALECT_LINE_BYTES];
    lua_newtable(L);
    for (size_t g = 0; layout && g < layout->machine.gripper_count; ++g) {
        const bool is_its_own = (result->mechanism->grippers >> g & 1U) != 0;
        if (is_its_own && wh_value_spell(layout->grippers[g].name, spelt, sizeof spelt)) {
            wh_lua_set_boolean(L, spelt, (result->sensors >> g & 1U) != 0);
        }
    }
    lua_setfield(L, -2, "sensors");
}

static void push_result(lua_State *L, const call_t *it) {
    const wh_result_t *result = it->told->result;
    lua_newtable(L);
    set_error(L, it->dialect, result->number, "");
    wh_lua_set_text(L, "answer", result->answer);
    wh_lua_set_number(L, "seconds", result->seconds);
    wh_lua_set_boolean(L, "is_held", result->is_held);
    wh_push_values(L, result->answer);
    lua_setfield(L, -2, "values");
    wh_push_values(L, result->status);
    lua_setfield(L, -2, "status");
    set_state(L, result);
    set_position(L, it->dialect, result);
    set_sensors(L, result);
}

/* A command's own `answer` makes result.reply of the result on top of the stack. */
static void set_reply(lua_State *L, const call_t *it) {
    const wh_dialect_command_t *command = it->told->request->command;
    push_of(L, "commands", command->name);
    if (lua_getfield(L, -1, "answer") == LUA_TFUNCTION) {
        push_request(L, it->told->request);
        lua_pushvalue(L, -4);
        lua_call(L, 2, 1);
        lua_setfield(L, -3, "reply");
    } else {
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
}

static void push_event(lua_State *L, const wh_host_event_t *event) {
    lua_newtable(L);
    wh_lua_set_text(L, "kind", event->kind);
    wh_lua_set_boolean(L, "is_complaint", event->is_complaint);
    wh_lua_set_number(L, "seconds", event->seconds);
    wh_lua_set_text(L, "wafer", event->wafer);
    wh_lua_set_text(L, "gripper", event->gripper);
}

/* Pushes the arguments of the encoder. Returns how many there are. */
static int push_told(lua_State *L, const call_t *it) {
    const wh_told_t *told = it->told;
    int count = 0;
    if (told->request) {
        push_request(L, told->request);
        ++count;
    }
    if (told->result) {
        push_result(L, it);
        if (told->request && told->result->number == WH_OK) {
            set_reply(L, it);
        }
        ++count;
    }
    if (told->failure) {
        push_failure(L, it->dialect, told->failure);
        ++count;
    }
    if (told->event) {
        push_event(L, told->event);
        ++count;
    }
    if (told->reason) {
        lua_pushstring(L, told->reason);
        ++count;
    }
    return count;
}

/* The start that an encoder returned behind its text, on top of the stack; nil: the first. */
static size_t take_start(lua_State *L, const call_t *it) {
    const wh_framing_t *framing = &it->dialect->replies;
    size_t size = 0;
    const char *start = lua_isnil(L, -1) ? NULL : luaL_tolstring(L, -1, &size);
    for (size_t i = 0; start && i < framing->start_count; ++i) {
        const wh_framing_mark_t *mark = &framing->starts[i];
        if (mark->size == size && memcmp(mark->bytes, start, size) == 0) {
            return i;
        }
    }
    if (start) {
        luaL_error(L, "%s: an encoder's second value: %s (expected one of framing.replies)",
                   it->dialect->path, start);
    }
    return 0;
}

/* Replaces the list at index 2 by its texts with a byte 0 between them. */
static void join_frames(lua_State *L, const call_t *it) {
    luaL_Buffer buffer;
    luaL_buffinit(L, &buffer);
    const lua_Integer count = (lua_Integer)lua_rawlen(L, 2);
    for (lua_Integer i = 1; i <= count; ++i) {
        if (lua_rawgeti(L, 2, i) != LUA_TSTRING) {
            luaL_error(L, "%s: encode.%s: entry %d is no text", it->dialect->path,
                       wh_encoder_names[it->encoder], (int)i);
        }
        luaL_addvalue(&buffer);
        luaL_addlstring(&buffer, "", i < count ? 1 : 0);
    }
    luaL_pushresult(&buffer);
    lua_replace(L, 2);
}

/* Runs protected. */
static int encode_body(lua_State *L) {
    call_t *it = lua_touserdata(L, 1);
    wh_dialect_t *dialect = it->dialect;
    size_t size = 0;
    push_of(L, "encode", wh_encoder_names[it->encoder]);
    lua_call(L, push_told(L, it), 2);
    if (lua_isnil(L, -2)) {
        return 0;
    }
    dialect->text_start = take_start(L, it);
    lua_settop(L, 3);
    if (lua_istable(L, 2)) {
        join_frames(L, it);
    }
    const char *text = lua_type(L, 2) == LUA_TSTRING ? lua_tolstring(L, 2, &size) : NULL;
    if (!text || size > WH_FRAMING_LINE) {
        return luaL_error(L,
                          "%s: encode.%s returned no frame (expected a text of at most %d bytes, a list of "
                          "texts, or nil)",
                          dialect->path, wh_encoder_names[it->encoder], WH_FRAMING_LINE);
    }
    dialect->text = wh_array_new(size + 1, 1);
    memcpy(dialect->text, text, size);
    dialect->text_size = size;
    return 0;
}

bool wh_dialect_encode(wh_dialect_t *dialect, wh_encoder_t encoder, const wh_told_t *told) {
    call_t it = {.dialect = dialect, .encoder = encoder, .told = told};
    free(dialect->text);
    dialect->text = NULL;
    dialect->text_size = 0;
    return !dialect->encodes[encoder] || call_dialect(dialect, encode_body, &it);
}
