/* Calls a dialect's functions: decode, run and the encoders. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <lauxlib.h>

#include "../record/record.h"
#include "../script/wh_module_values.h"
#include "../text/array.h"
#include "../text/utf8.h"
#include "dialect_internal.h"
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
    const wh_client_t *client;
    const char *frame;
    size_t size;
    bool *stops;
    wh_now_t *ask;
    void *user;
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

/* Pushes { port = , number = }. */
static void push_client(lua_State *L, const wh_client_t *client) {
    lua_createtable(L, 0, 2);
    wh_lua_set_text(L, "port", client->port);
    wh_lua_set_integer(L, "number", (lua_Integer)client->number);
}

/* Runs protected. */
static int decode_frame(lua_State *L) {
    char name[WH_DIALECT_NAME_BYTES];
    call_t *it = lua_touserdata(L, 1);
    wh_dialect_push(L, "decode", NULL);
    lua_pushlstring(L, it->frame, it->size);
    push_client(L, it->client);
    lua_call(L, 2, 1);
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

wh_decoded_t wh_dialect_decode(wh_dialect_t *dialect, const wh_client_t *client, const char *frame,
                               size_t size, wh_request_t *request, wh_failure_t *failure) {
    call_t it = {.dialect = dialect, .client = client, .frame = frame, .size = size, .request = request};
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

/* True if the function on top of the stack has a second parameter. */
static bool takes_second(lua_State *L) {
    lua_Debug debug;
    lua_pushvalue(L, -1);
    return lua_getinfo(L, ">u", &debug) != 0 && (debug.nparams >= 2 || debug.isvararg != 0);
}

static void push_now(lua_State *L, const call_t *it) {
    wh_result_t now = {.answer = "", .status = ""};
    if (it->ask) {
        it->ask(it->user, &now);
    }
    wh_dialect_push_now(L, it->dialect, &now);
}

/* Runs protected. */
static int run_command(lua_State *L) {
    call_t *it = lua_touserdata(L, 1);
    const wh_dialect_command_t *command = it->request->command;
    wh_dialect_push(L, "commands", command->name);
    if (lua_getfield(L, -1, "run") == LUA_TNIL) {
        lua_pushstring(L, command->does[0]->name);
    } else {
        const bool takes_now = takes_second(L);
        lua_rawgeti(L, LUA_REGISTRYINDEX, it->request->reference);
        if (takes_now) {
            push_now(L, it);
        }
        lua_call(L, takes_now ? 2 : 1, 1);
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

wh_decoded_t wh_dialect_run(wh_dialect_t *dialect, const wh_request_t *request, wh_now_t *ask, void *user,
                            wh_lines_t *lines, wh_failure_t *failure) {
    wh_request_t asked = *request;
    call_t it = {.dialect = dialect, .request = &asked, .ask = ask, .user = user, .lines = lines};
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

static void push_failure(lua_State *L, const wh_dialect_t *dialect, const wh_failure_t *failure) {
    lua_newtable(L);
    wh_dialect_set_error(L, dialect, failure->number, failure->code);
    wh_lua_set_text(L, "detail", failure->detail);
}

/* A command's own `answer` makes result.reply of the result on top of the stack. */
static void set_reply(lua_State *L, const call_t *it) {
    const wh_dialect_command_t *command = it->told->request->command;
    wh_dialect_push(L, "commands", command->name);
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
    wh_lua_set_text(L, "port", event->client.port);
    wh_lua_set_integer(L, "client", (lua_Integer)event->client.number);
    if (event->value >= 0) {
        wh_lua_set_integer(L, "value", event->value);
    }
    if (event->door) {
        wh_lua_set_text(L, "door", event->door);
    }
    if (event->state) {
        wh_push_values(L, event->state);
        lua_setfield(L, -2, "controller");
    }
    if (event->at) {
        wh_lua_set_text(L, "at", event->at);
    }
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
        wh_dialect_push_result(L, it->dialect, told->result);
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
        char known[WH_DIALECT_STARTS_BYTES];
        luaL_error(L, "%s: an encoder's second value: %s (expected one of framing.replies: %s)",
                   it->dialect->path, start, wh_dialect_list_starts(framing, known));
    }
    return 0;
}

/* Replaces the list at index 2 by its texts with a byte 0 between them. */
static void join_frames(lua_State *L, const call_t *it, const char *function) {
    luaL_Buffer buffer;
    luaL_buffinit(L, &buffer);
    const lua_Integer count = (lua_Integer)lua_rawlen(L, 2);
    for (lua_Integer i = 1; i <= count; ++i) {
        if (lua_rawgeti(L, 2, i) != LUA_TSTRING) {
            luaL_error(L, "%s: %s: entry %d is no text", it->dialect->path, function, (int)i);
        }
        luaL_addvalue(&buffer);
        luaL_addlstring(&buffer, "", i < count ? 1 : 0);
    }
    luaL_pushresult(&buffer);
    lua_replace(L, 2);
}

/* Makes the dialect's text of the value at index 2; nil: none. `function` names it in messages. */
static void take_text(lua_State *L, const call_t *it, const char *function) {
    wh_dialect_t *dialect = it->dialect;
    size_t size = 0;
    if (lua_istable(L, 2)) {
        join_frames(L, it, function);
    }
    const char *text = lua_type(L, 2) == LUA_TSTRING ? lua_tolstring(L, 2, &size) : NULL;
    if (!text || size > WH_FRAMING_LINE) {
        luaL_error(L,
                   "%s: %s returned no frame (expected a text of at most %d bytes, a list of texts, or nil)",
                   dialect->path, function, WH_FRAMING_LINE);
        return;
    }
    dialect->text = wh_array_new(size + 1, 1);
    memcpy(dialect->text, text, size);
    dialect->text_size = size;
}

/* Runs protected. */
static int encode_body(lua_State *L) {
    call_t *it = lua_touserdata(L, 1);
    wh_dialect_t *dialect = it->dialect;
    char function[40];
    wh_dialect_push(L, "encode", wh_encoder_names[it->encoder]);
    lua_call(L, push_told(L, it), 2);
    if (lua_isnil(L, -2)) {
        return 0;
    }
    dialect->text_start = take_start(L, it);
    lua_settop(L, 3);
    (void)snprintf(function, sizeof function, "encode.%s", wh_encoder_names[it->encoder]);
    take_text(L, it, function);
    return 0;
}

static void drop_text(wh_dialect_t *dialect) {
    free(dialect->text);
    dialect->text = NULL;
    dialect->text_size = 0;
    dialect->text_start = 0;
}

bool wh_dialect_encode(wh_dialect_t *dialect, wh_encoder_t encoder, const wh_told_t *told) {
    call_t it = {.dialect = dialect, .encoder = encoder, .told = told};
    drop_text(dialect);
    return !dialect->encodes[encoder] || call_dialect(dialect, encode_body, &it);
}

/* ------------------------------------------------------------------------------------------------ clients */

/* Runs protected. */
static int call_connected(lua_State *L) {
    const call_t *it = lua_touserdata(L, 1);
    wh_dialect_push(L, "connected", NULL);
    push_client(L, it->client);
    lua_call(L, 1, 1);
    if (!lua_isnil(L, 2)) {
        take_text(L, it, "connected");
    }
    return 0;
}

static void take_condition(lua_State *L, const wh_dialect_t *dialect, const char *function,
                           wh_lines_t *lines) {
    size_t size = 0;
    const char *text = lua_type(L, -1) == LUA_TSTRING ? lua_tolstring(L, -1, &size) : NULL;
    const wh_word_t *word = text ? wh_word_of(text) : NULL;
    if (!word || word->kind != WH_WORD_CONTROLLER || size >= WH_DIALECT_LINE_BYTES || strlen(text) != size ||
        lines->count == WH_DIALECT_LINES) {
        luaL_error(L, "%s: %s: \"%s\" (expected at most %d lines that begin with CONTROLLER)", dialect->path,
                   function, text ? text : luaL_typename(L, -1), WH_DIALECT_LINES);
        return;
    }
    memcpy(lines->lines[lines->count++], text, size + 1);
}

void wh_dialect_take_conditions(lua_State *L, const wh_dialect_t *dialect, const char *function,
                                wh_lines_t *lines) {
    lines->count = 0;
    if (lua_isnil(L, -1)) {
        return;
    }
    if (!lua_istable(L, -1)) {
        take_condition(L, dialect, function, lines);
        return;
    }
    for (lua_Integer i = 1; lua_geti(L, -1, i) != LUA_TNIL; ++i) {
        take_condition(L, dialect, function, lines);
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
}

/* Runs protected. */
static int call_gone(lua_State *L) {
    const call_t *it = lua_touserdata(L, 1);
    wh_dialect_push(L, "gone", NULL);
    push_client(L, it->client);
    lua_call(L, 1, 1);
    wh_dialect_take_conditions(L, it->dialect, "gone", it->lines);
    return 0;
}

bool wh_dialect_welcome(wh_dialect_t *dialect, const wh_client_t *client) {
    call_t it = {.dialect = dialect, .client = client};
    drop_text(dialect);
    return !dialect->clients.greets || call_dialect(dialect, call_connected, &it);
}

bool wh_dialect_part(wh_dialect_t *dialect, const wh_client_t *client, wh_lines_t *lines) {
    call_t it = {.dialect = dialect, .client = client, .lines = lines};
    lines->count = 0;
    drop_text(dialect);
    return !dialect->clients.heeds_going || call_dialect(dialect, call_gone, &it);
}

/* Runs protected. */
static int call_tester(lua_State *L) {
    const call_t *it = lua_touserdata(L, 1);
    wh_dialect_push(L, "tester", NULL);
    lua_pushstring(L, it->frame);
    lua_call(L, 1, 1);
    it->lines->count = 0;
    *it->stops = lua_isboolean(L, -1) && lua_toboolean(L, -1) != 0;
    if (!lua_isboolean(L, -1)) {
        wh_dialect_take_conditions(L, it->dialect, "tester", it->lines);
    }
    return 0;
}

wh_decoded_t wh_dialect_tell(wh_dialect_t *dialect, const char *text, bool *stops, wh_lines_t *lines,
                             wh_failure_t *failure) {
    call_t it = {.dialect = dialect, .frame = text, .stops = stops, .lines = lines};
    *stops = false;
    lines->count = 0;
    memset(failure, 0, sizeof *failure);
    if (!dialect->clients.hears_testers) {
        return WH_DECODED_NOTHING;
    }
    return outcome_of(dialect, call_dialect(dialect, call_tester, &it), failure);
}
