/* Reads the table that a dialect's file returns, strictly. Its functions stay in Lua. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <lauxlib.h>

#include "../record/record.h"
#include "../text/array.h"
#include "../text/nearest.h"
#include "dialect_internal.h"
#include "mechanism.h"
#include "pace.h"

const char *const wh_host_event_names[WH_HOST_EVENTS + 1] = {
    "wafer", "sensor", "valve", "hold", "position", "error", "door", "mode", "port", "grip", NULL};

static const wh_reader_field_t dialect_fields[] = {
    {"name", "string", "what it is", true},
    {"mechanism", "string", "what it stands for", false},
    {"framing", "table", "from bytes to frames", true},
    {"units", "table", "what one of their units is", false},
    {"signs", "table", "-1 where their axis turns the other way", false},
    {"stations", "table", "their names of stations, and ours", false},
    {"arms", "table", "their names of grippers, and ours", false},
    {"doors", "table", "their names of doors, and ours", false},
    {"first_slot", "number", "how they count the first slot", false},
    {"decode", "function", "from a frame to a request", true},
    {"commands", "table", "theirs, by name", true},
    {"encode", "table", "from a request and what came of it to frames", true},
    {"errors", "table", "our names of errors, and their codes", false},
    {"other_error", "string", "their code of all other errors", true},
    {"states", "table", "our words of a state, and theirs", false},
    {"timing", "table", "of answers", false},
    {"baud", "number", "the pace of the line", false},
    {"second_client", "string", "what becomes of it", false},
    {"ports", "table", "the names of the ports that share it", false},
    {"in_order", "boolean", "the next frame is read once all before it are answered", false},
    {"events", "table", "the kinds of events that it is told", false},
    {"connected", "function", "a client has come", false},
    {"gone", "function", "a client has gone", false},
    {"begins", "string", "CONTROLLER lines for the start", false},
    {"tester", "function", "a tester tells it something", false},
    {"unit_of", "function", "from a frame to the address of its unit", false},
    {"idle", "number", "s after which a silent client is closed", false},
    {"completes_to", "string", "who hears of a command's end", false},
    {"chaos", "table", "what befalls frames on the line", false},
    {0}};

static const wh_reader_field_t command_fields[] = {{"does", "string", "", true},
                                                   {"run", "function", "", false},
                                                   {"answer", "function", "", false},
                                                   {"when", "string", "", false},
                                                   {"queue", "number", "", false},
                                                   {"closes", "boolean", "", false},
                                                   {0}};

/* In the order of wh_encoder_t. */
static const wh_reader_field_t encode_fields[] = {{"acknowledge", "function", "", false},
                                                  {"answer", "function", "", true},
                                                  {"complete", "function", "", true},
                                                  {"refuse", "function", "", true},
                                                  {"bad", "function", "", true},
                                                  {"event", "function", "", false},
                                                  {"unacknowledged", "function", "", false},
                                                  {0}};

static const wh_reader_field_t state_fields[] = {
    {"idle", "string", "", false}, {"running", "string", "", false}, {"held", "string", "", false}, {0}};
static const wh_reader_field_t unit_fields[] = {
    {"length", "number", "", false}, {"angle", "number", "", false}, {0}};
static const wh_reader_field_t sign_fields[] = {{"theta", "number", "", false},
                                                {"r", "number", "", false},
                                                {"z", "number", "", false},
                                                {"yaw", "number", "", false},
                                                {0}};
static const wh_reader_field_t timing_fields[] = {
    {"ack", "number", "", false}, {"busy", "number", "", false}, {"ackn", "number", "", false}, {0}};

static const wh_reader_field_t chaos_fields[] = {{"seed", "number", "", false},
                                                 {"drop", "number", "", false},
                                                 {"double", "number", "", false},
                                                 {"garble", "number", "", false},
                                                 {"delay", "number", "", false},
                                                 {"late_ack", "number", "", false},
                                                 {0}};

/* True if the field is there and a function. */
static bool has_function(wh_reader_t *reader, const wh_reader_field_t *field) {
    const int type = wh_reader_push(reader, field->name);
    if (type != LUA_TFUNCTION && (type != LUA_TNIL || field->required)) {
        wh_reader_fail(reader, field->name, "a function");
    }
    lua_pop(reader->L, 1);
    return type == LUA_TFUNCTION;
}

/* ------------------------------------------------------------------------------------------------- tables */

/* Refuses a table that has anything but texts by texts. */
static void check_names(wh_reader_t *reader, const char *field) {
    if (!wh_reader_enter(reader, field)) {
        return;
    }
    lua_State *L = reader->L;
    for (lua_pushnil(L); lua_next(L, -2) != 0; lua_pop(L, 1)) {
        if (lua_type(L, -2) != LUA_TSTRING || lua_type(L, -1) != LUA_TSTRING) {
            wh_reader_fail(reader, lua_type(L, -2) == LUA_TSTRING ? lua_tostring(L, -2) : NULL,
                           "our name as a text, by their name as a text: [\"1\"] = \"A\"");
        }
    }
    wh_reader_leave(reader);
}

static wh_status_t find_error(const char *name) {
    for (int number = 1; number < 1000; ++number) {
        if (strcmp(wh_status_name((wh_status_t)number), name) == 0) {
            return (wh_status_t)number;
        }
    }
    return WH_OK;
}

/* A code, a text or a whole number, on top of the stack. */
static void take_code(const wh_reader_t *reader, const char *field, char code[WH_DIALECT_NAME_BYTES]) {
    size_t size = 0;
    const bool is_code = lua_type(reader->L, -1) == LUA_TSTRING || lua_isinteger(reader->L, -1);
    lua_pushvalue(reader->L, -1);
    const char *text = is_code ? lua_tolstring(reader->L, -1, &size) : NULL;
    if (!text || size >= WH_DIALECT_NAME_BYTES || !wh_reader_is_plain(text, size)) {
        lua_pop(reader->L, 1);
        wh_reader_fail(reader, field, "their code, a text of at most %d bytes or a whole number",
                       WH_DIALECT_NAME_BYTES - 1);
    }
    memcpy(code, text, size + 1);
    lua_pop(reader->L, 1);
}

/* Names the error that may have been meant. */
static void refuse_error(const wh_reader_t *reader, const char *name) {
    const char *names[1000];
    char text[WH_NEAREST_TEXT];
    size_t count = 0;
    for (int number = 1; number < 1000; ++number) {
        const char *known = wh_status_name((wh_status_t)number);
        if (strcmp(known, "UNKNOWN") != 0) {
            names[count++] = known;
        }
    }
    const char *nearest = name ? wh_text_nearest(name, names, count) : NULL;
    wh_reader_fail(reader, name, "a name of our errors, as `man waferhand` lists them%s",
                   wh_text_did_you_mean(text, "; ", "", nearest));
}

static void read_errors(wh_reader_t *reader, wh_dialect_t *dialect) {
    (void)wh_reader_push(reader, "other_error");
    take_code(reader, "other_error", dialect->other_code);
    lua_pop(reader->L, 1);
    if (!wh_reader_enter(reader, "errors")) {
        return;
    }
    lua_State *L = reader->L;
    for (lua_pushnil(L); lua_next(L, -2) != 0; lua_pop(L, 1)) {
        const char *name = lua_type(L, -2) == LUA_TSTRING ? lua_tostring(L, -2) : NULL;
        const wh_status_t number = name ? find_error(name) : WH_OK;
        if (number == WH_OK) {
            refuse_error(reader, name);
        }
        dialect->codes = wh_array_grow(dialect->codes, dialect->code_count, &dialect->code_capacity,
                                       sizeof *dialect->codes);
        wh_dialect_code_t *code = &dialect->codes[dialect->code_count++];
        code->number = number;
        take_code(reader, name, code->code);
    }
    wh_reader_leave(reader);
}

/* ----------------------------------------------------------------------------------------------- commands */

/* An action may change the robot's own controller on its way: an INIT switches the power on and goes home. */
static bool goes_with(const wh_dialect_command_t *command, const wh_word_t *word) {
    const wh_word_kind_t other = word->kind == WH_WORD_ACTION ? command->kind : word->kind;
    return (word->kind == WH_WORD_ACTION || command->kind == WH_WORD_ACTION) && other == WH_WORD_CONTROLLER;
}

static void read_does(wh_reader_t *reader, wh_dialect_command_t *command) {
    char does[200];
    wh_reader_text(reader, "does", NULL, does, sizeof does);
    for (const char *at = does + strspn(does, " "); *at; at += strcspn(at, " "), at += strspn(at, " ")) {
        const wh_word_t *word = wh_word_of(at);
        if (!word || command->does_count == WH_DIALECT_DOES) {
            wh_reader_refuse(reader, "does", does,
                             "at most %d words of the prompt, or HOLD, RESUME, ACKN, LOCAL", WH_DIALECT_DOES);
        }
        if (command->does_count > 0 && word->kind != command->kind && !goes_with(command, word)) {
            wh_reader_refuse(reader, "does", does,
                             "words that are all actions, perhaps with CONTROLLER, or all queries");
        }
        if (command->does_count == 0 || word->kind == WH_WORD_ACTION) {
            command->kind = word->kind;
        }
        command->does[command->does_count++] = word;
    }
}

static bool may_wait(wh_word_kind_t kind) {
    return kind == WH_WORD_QUERY || kind == WH_WORD_ALWAYS || kind == WH_WORD_LOCAL;
}

/* When it is answered, and what may wait behind it. */
static void read_when(wh_reader_t *reader, wh_dialect_command_t *command) {
    static const char *const times[] = {"at once", "idle", "end", NULL};
    const bool is_action = command->kind == WH_WORD_ACTION;
    const wh_when_t usual = is_action ? WH_WHEN_END : WH_WHEN_AT_ONCE;
    command->when = (wh_when_t)wh_reader_choice(reader, "when", (int)usual, times);
    if (command->when != usual && command->when != (is_action ? WH_WHEN_AT_ONCE : WH_WHEN_IDLE)) {
        wh_reader_refuse(reader, "when", times[command->when], "%s",
                         is_action ? "\"at once\" or \"end\" of an action"
                                   : "\"at once\" or \"idle\" of what is no action");
    }
    if (command->when == WH_WHEN_IDLE && !may_wait(command->kind)) {
        wh_reader_refuse(reader, "when", "idle",
                         "\"at once\" of STOP, HOLD, RESUME, CONTROLLER, RATE and ACKN");
    }
    command->queue = wh_reader_whole(reader, "queue", 0, 0, WH_DIALECT_QUEUE);
    if (command->queue > 0 && !is_action) {
        wh_reader_refuse(reader, "queue", "", "none: only actions wait behind what runs");
    }
    command->closes = wh_reader_boolean(reader, "closes", false);
}

/* Refuses words that the controller's mechanism cannot do. */
static void check_mechanism(const wh_reader_t *reader, const wh_dialect_t *dialect,
                            const wh_dialect_command_t *command) {
    for (size_t i = 0; i < command->does_count; ++i) {
        const wh_word_t *word = command->does[i];
        if (!wh_mechanism_does(dialect->mechanism, word)) {
            wh_reader_refuse(reader, "does", word->name, "no word of another mechanism than %s",
                             wh_mechanism_names[dialect->mechanism]);
        }
    }
}

static void read_command(wh_reader_t *reader, wh_dialect_t *dialect, const char *name) {
    dialect->commands = wh_array_grow(dialect->commands, dialect->command_count, &dialect->command_capacity,
                                      sizeof *dialect->commands);
    wh_dialect_command_t *command = &dialect->commands[dialect->command_count++];
    memset(command, 0, sizeof *command);
    (void)snprintf(command->name, sizeof command->name, "%s", name);
    wh_reader_refuse_unknown(reader, command_fields);
    read_does(reader, command);
    check_mechanism(reader, dialect, command);
    read_when(reader, command);
    wh_reader_field_t run = command_fields[1];
    run.required = command->kind == WH_WORD_LOCAL;
    (void)has_function(reader, &run);
    (void)has_function(reader, &command_fields[2]);
}

static int by_name(const void *a, const void *b) {
    return strcmp(((const wh_dialect_command_t *)a)->name, ((const wh_dialect_command_t *)b)->name);
}

static void read_commands(wh_reader_t *reader, wh_dialect_t *dialect) {
    lua_State *L = reader->L;
    if (!wh_reader_enter(reader, "commands")) {
        wh_reader_fail(reader, "commands", "a table of their commands");
    }
    for (lua_pushnil(L); lua_next(L, -2) != 0; lua_pop(L, 1)) {
        const char *name = lua_type(L, -2) == LUA_TSTRING ? lua_tostring(L, -2) : NULL;
        if (!name || name[0] == '\0' || strlen(name) >= WH_DIALECT_NAME_BYTES) {
            wh_reader_fail(reader, name, "a command by its name, a text of at most %d bytes",
                           WH_DIALECT_NAME_BYTES - 1);
        }
        lua_pushvalue(L, -3);
        if (wh_reader_enter(reader, name)) {
            read_command(reader, dialect, name);
            wh_reader_leave(reader);
        }
        lua_pop(L, 1);
    }
    qsort(dialect->commands, dialect->command_count, sizeof *dialect->commands, by_name);
    wh_reader_leave(reader);
}

static void read_encoders(wh_reader_t *reader, wh_dialect_t *dialect) {
    if (!wh_reader_open(reader, "encode", encode_fields)) {
        wh_reader_fail(reader, "encode", "a table of functions");
    }
    for (size_t i = 0; i < WH_ENCODERS; ++i) {
        dialect->encodes[i] = has_function(reader, &encode_fields[i]);
    }
    wh_reader_leave(reader);
}

/* ---------------------------------------------------------------------------------------------- the whole */

static void read_units(wh_reader_t *reader, wh_dialect_t *dialect) {
    wh_reader_open_section(reader, "units", unit_fields);
    dialect->units.length = wh_reader_number(reader, "length", 1, 1e-6, 1e6);
    dialect->units.angle = wh_reader_number(reader, "angle", 1, 1e-6, 1e6);
    wh_reader_leave(reader);
    wh_reader_open_section(reader, "signs", sign_fields);
    for (size_t axis = 0; axis < 4; ++axis) {
        const char *name = sign_fields[axis].name;
        dialect->units.signs[axis] = wh_reader_number(reader, name, 1, -1, 1);
        if (fabs(dialect->units.signs[axis]) != 1) {
            (void)wh_reader_push(reader, name);
            wh_reader_fail(reader, name, "1 or -1");
        }
    }
    wh_reader_leave(reader);
}

static void read_states(wh_reader_t *reader, wh_dialect_t *dialect) {
    wh_reader_open_section(reader, "states", state_fields);
    for (size_t i = 0; i < 3; ++i) {
        char word[WH_DIALECT_NAME_BYTES];
        wh_reader_text(reader, state_fields[i].name, "", word, sizeof word);
        dialect->states[i] = word[0] != '\0';
    }
    wh_reader_leave(reader);
}

/* The name of this port, of the list on top of the stack. */
static void read_port(wh_reader_t *reader, wh_dialect_clients_t *clients, size_t i) {
    char name[32];
    (void)snprintf(name, sizeof name, "[%zu]", i + 1);
    lua_rawgeti(reader->L, -1, (lua_Integer)i + 1);
    const char *text = lua_type(reader->L, -1) == LUA_TSTRING ? lua_tostring(reader->L, -1) : "";
    const size_t size = strlen(text);
    if (size < 1 || size > 15 || strspn(text, "abcdefghijklmnopqrstuvwxyz0123456789_") != size) {
        wh_reader_fail(reader, name, "a name of 1 to 15 small letters, digits and _");
    }
    memcpy(clients->ports[i], text, size + 1);
    for (size_t other = 0; other < i; ++other) {
        if (strcmp(clients->ports[other], text) == 0) {
            wh_reader_fail(reader, name, "another name than that of port %zu", other + 1);
        }
    }
    lua_pop(reader->L, 1);
}

/* The names of its ports, as far as it has several. */
static void read_ports(wh_reader_t *reader, wh_dialect_clients_t *clients) {
    clients->port_count = 1;
    if (!wh_reader_enter(reader, "ports")) {
        return;
    }
    clients->port_count = wh_reader_list(reader);
    if (clients->port_count < 1 || clients->port_count > WH_DIALECT_PORTS) {
        wh_reader_fail(reader, NULL, "1 to %d names", WH_DIALECT_PORTS);
    }
    for (size_t i = 0; i < clients->port_count; ++i) {
        read_port(reader, clients, i);
    }
    wh_reader_leave(reader);
}

static void read_events(wh_reader_t *reader, wh_dialect_clients_t *clients) {
    clients->events = 1U << WH_HOST_WAFER;
    if (!wh_reader_enter(reader, "events")) {
        return;
    }
    clients->events = 0;
    const size_t count = wh_reader_list(reader);
    for (size_t i = 0; i < count; ++i) {
        size_t kind = 0;
        lua_rawgeti(reader->L, -1, (lua_Integer)i + 1);
        const char *text = lua_type(reader->L, -1) == LUA_TSTRING ? lua_tostring(reader->L, -1) : "";
        while (kind < WH_HOST_EVENTS && strcmp(wh_host_event_names[kind], text) != 0) {
            ++kind;
        }
        if (kind == WH_HOST_EVENTS) {
            wh_reader_fail(reader, NULL,
                           "a list of wafer, sensor, valve, hold, position, error, door, mode and port");
        }
        clients->events |= 1U << kind;
        lua_pop(reader->L, 1);
    }
    wh_reader_leave(reader);
}

static void read_clients(wh_reader_t *reader, wh_dialect_t *dialect) {
    static const char *const seconds[] = {"refuse", "take_over", "share", NULL};
    wh_dialect_clients_t *clients = &dialect->clients;
    read_ports(reader, clients);
    read_events(reader, clients);
    clients->second = (wh_port_second_t)wh_reader_choice(reader, "second_client", 0, seconds);
    clients->in_order = wh_reader_boolean(reader, "in_order", false);
    clients->greets = has_function(reader, &(wh_reader_field_t){"connected", "function", "", false});
    clients->hears_testers = has_function(reader, &(wh_reader_field_t){"tester", "function", "", false});
    clients->heeds_going = has_function(reader, &(wh_reader_field_t){"gone", "function", "", false});
    clients->knows_units = has_function(reader, &(wh_reader_field_t){"unit_of", "function", "", false});
}

static void read_begins(wh_reader_t *reader, wh_dialect_t *dialect) {
    (void)wh_reader_push(reader, "begins");
    wh_dialect_take_conditions(reader->L, dialect, "begins", &dialect->begins);
    lua_pop(reader->L, 1);
}

static void read_timing(wh_reader_t *reader, wh_dialect_t *dialect) {
    static const char *const hearers[] = {"asker", "next", NULL};
    wh_reader_open_section(reader, "timing", timing_fields);
    dialect->timing.ack_s = wh_reader_number(reader, "ack", 0, 0, 3600);
    dialect->timing.busy_s = wh_reader_number(reader, "busy", 0, 0, 3600);
    dialect->timing.ackn_s = wh_reader_number(reader, "ackn", 0, 0, 3600);
    wh_reader_leave(reader);
    dialect->timing.idle_s = wh_reader_number(reader, "idle", 0, 0, 86400);
    dialect->clients.completes_to_next = wh_reader_choice(reader, "completes_to", 0, hearers) == 1;
    dialect->timing.baud = wh_reader_whole(reader, "baud", 0, 0, WH_PACE_MOST);
    if (!wh_pace_validate(dialect->timing.baud)) {
        (void)wh_reader_push(reader, "baud");
        wh_reader_fail(reader, "baud", "0 or %d to %d", WH_PACE_LEAST, WH_PACE_MOST);
    }
}

static void read_chaos(wh_reader_t *reader, wh_dialect_t *dialect) {
    const double most_s = WH_CHAOS_DELAY_US / 1e6;
    wh_reader_open_section(reader, "chaos", chaos_fields);
    dialect->chaos.seed = (uint64_t)wh_reader_whole(reader, "seed", 0, 0, INT32_MAX);
    dialect->chaos.drop = wh_reader_number(reader, "drop", 0, 0, 1);
    dialect->chaos.twice = wh_reader_number(reader, "double", 0, 0, 1);
    dialect->chaos.garble = wh_reader_number(reader, "garble", 0, 0, 1);
    dialect->chaos.delay_us = (int64_t)(wh_reader_number(reader, "delay", 0, 0, most_s) * 1e6);
    dialect->chaos.late_ack_us = (int64_t)(wh_reader_number(reader, "late_ack", 0, 0, most_s) * 1e6);
    wh_reader_leave(reader);
}

int wh_dialect_read(lua_State *L) {
    wh_dialect_t *dialect = lua_touserdata(L, 1);
    wh_reader_t reader;
    lua_rawgetp(L, LUA_REGISTRYINDEX, &wh_dialect_key);
    wh_reader_start(&reader, L, dialect->path);
    if (!lua_istable(L, -1)) {
        wh_reader_fail(&reader, NULL, "a dialect's table, which the file returns");
    }
    wh_reader_refuse_unknown(&reader, dialect_fields);
    wh_reader_text(&reader, "name", NULL, dialect->name, sizeof dialect->name);
    dialect->mechanism = (wh_mechanism_t)wh_reader_choice(&reader, "mechanism", 0, wh_mechanism_names);
    wh_dialect_read_framing(&reader, dialect);
    read_units(&reader, dialect);
    check_names(&reader, "stations");
    check_names(&reader, "arms");
    check_names(&reader, "doors");
    dialect->units.first_slot = wh_reader_whole(&reader, "first_slot", 1, 0, 1);
    (void)has_function(&reader, &dialect_fields[9]);
    read_commands(&reader, dialect);
    read_encoders(&reader, dialect);
    read_errors(&reader, dialect);
    read_states(&reader, dialect);
    read_clients(&reader, dialect);
    read_begins(&reader, dialect);
    read_timing(&reader, dialect);
    read_chaos(&reader, dialect);
    return 0;
}
