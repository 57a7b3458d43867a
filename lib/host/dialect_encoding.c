/* Calls a dialect's encoders: from results to the bodies of frames. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <lauxlib.h>

#include "../layout/words.h"
#include "../script/wh_module_values.h"
#include "../text/array.h"
#include "dialect_internal.h"
#include "values.h"

const char *const wh_encoder_names[WH_ENCODERS] = {[WH_ENCODE_ACKNOWLEDGE] = "acknowledge",
                                                   [WH_ENCODE_ANSWER] = "answer",
                                                   [WH_ENCODE_COMPLETE] = "complete",
                                                   [WH_ENCODE_REFUSE] = "refuse",
                                                   [WH_ENCODE_BAD] = "bad",
                                                   [WH_ENCODE_EVENT] = "event",
                                                   [WH_ENCODE_UNACKNOWLEDGED] = "unacknowledged"};

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
static void set_reply(lua_State *L, const wh_dialect_call_t *it) {
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
    if (event->load_port) {
        wh_push_values(L, event->load_port);
        lua_setfield(L, -2, "load_port");
    }
    if (event->at) {
        wh_lua_set_text(L, "at", event->at);
    }
    if (event->grip) {
        wh_lua_set_text(L, "grip", wh_layout_phase_words[event->grip->phase]);
        wh_lua_set_number(L, "excess", event->grip->excess);
    }
}

/* Pushes the arguments of the encoder. Returns how many there are. */
static int push_told(lua_State *L, const wh_dialect_call_t *it) {
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
static size_t take_start(lua_State *L, const wh_dialect_call_t *it) {
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
static void join_frames(lua_State *L, const wh_dialect_call_t *it, const char *function) {
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

void wh_dialect_take_text(lua_State *L, const wh_dialect_call_t *it, const char *function) {
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
    wh_dialect_call_t *it = lua_touserdata(L, 1);
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
    wh_dialect_take_text(L, it, function);
    return 0;
}

void wh_dialect_drop_text(wh_dialect_t *dialect) {
    free(dialect->text);
    dialect->text = NULL;
    dialect->text_size = 0;
    dialect->text_start = 0;
}

bool wh_dialect_encode(wh_dialect_t *dialect, wh_encoder_t encoder, const wh_told_t *told) {
    wh_dialect_call_t it = {.dialect = dialect, .encoder = encoder, .told = told};
    wh_dialect_drop_text(dialect);
    return !dialect->encodes[encoder] || wh_dialect_call(dialect, encode_body, &it);
}
