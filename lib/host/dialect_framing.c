/* Reads how a dialect's frames are made of bytes. */
#include <stdio.h>
#include <string.h>

#include <lauxlib.h>

#include "dialect_internal.h"
#include "transcript.h"

static const wh_reader_field_t framing_fields[] = {{"start", "string", "", false},
                                                   {"replies", "table", "", false},
                                                   {"ends", "table", "", false},
                                                   {"reply_ends", "table", "", false},
                                                   {"length", "table", "", false},
                                                   {"sum", "string", "", false},
                                                   {"separator", "string", "", false},
                                                   {"escape", "string", "", false},
                                                   {"sums_start", "boolean", "", false},
                                                   {"sums_separator", "boolean", "", false},
                                                   {"sums_length", "boolean", "", false},
                                                   {"sum_as", "string", "", false},
                                                   {"sum_at", "string", "", false},
                                                   {"sums_end", "boolean", "", false},
                                                   {"skips_empty", "boolean", "", false},
                                                   {"shortest", "number", "", false},
                                                   {"longest", "number", "", false},
                                                   {"timeout", "number", "", false},
                                                   {0}};

static const wh_reader_field_t length_fields[] = {{"size", "number", "", true},
                                                  {"as", "string", "", false},
                                                  {"counts", "string", "", false},
                                                  {"low_first", "boolean", "", false},
                                                  {0}};

/* The text on top of the stack, which is popped. */
static wh_framing_mark_t take_mark(wh_reader_t *reader, const char *field) {
    wh_framing_mark_t mark = {.size = 0};
    size_t size = 0;
    const char *bytes = lua_type(reader->L, -1) == LUA_TSTRING ? lua_tolstring(reader->L, -1, &size) : NULL;
    if (!bytes || size < 1 || size > WH_FRAMING_MARK) {
        wh_reader_fail(reader, field, "a text of 1 to %d bytes", WH_FRAMING_MARK);
    }
    memcpy(mark.bytes, bytes, size);
    mark.size = size;
    lua_pop(reader->L, 1);
    return mark;
}

static wh_framing_mark_t read_mark(wh_reader_t *reader, const char *field) {
    if (wh_reader_push(reader, field) == LUA_TNIL) {
        lua_pop(reader->L, 1);
        return (wh_framing_mark_t){.size = 0};
    }
    return take_mark(reader, field);
}

/* A list of marks. Returns how many there are. */
static size_t read_marks(wh_reader_t *reader, const char *field, wh_framing_mark_t marks[]) {
    if (!wh_reader_enter(reader, field)) {
        return 0;
    }
    const size_t count = wh_reader_list(reader);
    if (count < 1 || count > WH_FRAMING_MARKS) {
        wh_reader_fail(reader, NULL, "1 to %d texts", WH_FRAMING_MARKS);
    }
    for (size_t i = 0; i < count; ++i) {
        char name[8];
        (void)snprintf(name, sizeof name, "[%zu]", i + 1);
        lua_rawgeti(reader->L, -1, (lua_Integer)i + 1);
        marks[i] = take_mark(reader, name);
    }
    wh_reader_leave(reader);
    return count;
}

static void read_length(wh_reader_t *reader, wh_framing_length_t *length) {
    static const char *const forms[] = {"bytes", "decimal", "hex", NULL};
    static const char *const counts[] = {"body", "rest", "frame", NULL};
    static const unsigned bases[] = {256, 10, 16};
    if (!wh_reader_open(reader, "length", length_fields)) {
        return;
    }
    length->size = (size_t)wh_reader_whole(reader, "size", 0, 1, WH_FRAMING_LENGTH);
    length->base = bases[wh_reader_choice(reader, "as", 0, forms)];
    length->counts = (wh_length_counts_t)wh_reader_choice(reader, "counts", 0, counts);
    length->low_first = wh_reader_boolean(reader, "low_first", false);
    wh_reader_leave(reader);
}

static void read_sum(wh_reader_t *reader, wh_framing_t *framing) {
    static const char *const sums[] = {"none", "add", "xor", "complement", "crc16", NULL};
    static const char *const forms[] = {"digits", "bytes", NULL};
    static const char *const places[] = {"before", "behind", NULL};
    framing->sum = (wh_sum_kind_t)wh_reader_choice(reader, "sum", WH_SUM_NONE, sums);
    framing->separator = read_mark(reader, "separator");
    framing->sums_as_bytes = wh_reader_choice(reader, "sum_as", 0, forms) == 1;
    framing->sum_is_behind = wh_reader_choice(reader, "sum_at", 0, places) == 1;
    framing->sums_end = wh_reader_boolean(reader, "sums_end", false);
    framing->sums_start = wh_reader_boolean(reader, "sums_start", false);
    framing->sums_separator = wh_reader_boolean(reader, "sums_separator", false);
    framing->sums_length = wh_reader_boolean(reader, "sums_length", false);
}

static void validate_framing(const wh_reader_t *reader, const wh_framing_t *framing) {
    char problem[WH_FRAMING_PROBLEM_BYTES];
    if (!wh_framing_validate(framing, problem)) {
        luaL_error(reader->L, "%s: framing.%s", reader->file, problem);
    }
}

void wh_dialect_read_framing(wh_reader_t *reader, wh_dialect_t *dialect) {
    wh_framing_t *framing = &dialect->framing;
    if (!wh_reader_open(reader, "framing", framing_fields)) {
        wh_reader_fail(reader, "framing", "a table");
    }
    *framing = wh_framing_default();
    framing->starts[0] = read_mark(reader, "start");
    framing->start_count = framing->starts[0].size > 0 ? 1 : 0;
    framing->end_count = read_marks(reader, "ends", framing->ends);
    read_length(reader, &framing->length);
    if (framing->end_count == 0 && framing->length.size == 0) {
        wh_reader_fail(reader, "ends", "a table, for there is no length");
    }
    read_sum(reader, framing);
    const wh_framing_mark_t escape = read_mark(reader, "escape");
    if (escape.size > 1) {
        wh_reader_fail(reader, "escape", "one byte");
    }
    framing->has_escape = escape.size == 1;
    framing->escape = escape.bytes[0];
    framing->skips_empty = wh_reader_boolean(reader, "skips_empty", true);
    framing->shortest = (size_t)wh_reader_whole(reader, "shortest", 0, 0, WH_FRAMING_LINE);
    framing->longest = (size_t)wh_reader_whole(reader, "longest", WH_FRAMING_LINE, 16, WH_FRAMING_LINE);
    framing->timeout_us = (int64_t)(wh_reader_number(reader, "timeout", 0, 0, 3600) * 1e6);
    dialect->replies = *framing;
    const size_t replies = read_marks(reader, "replies", dialect->replies.starts);
    dialect->replies.start_count = replies > 0 ? replies : framing->start_count;
    const size_t ends = read_marks(reader, "reply_ends", dialect->replies.ends);
    dialect->replies.end_count = ends > 0 ? ends : framing->end_count;
    dialect->replies.shortest = 0;
    validate_framing(reader, framing);
    validate_framing(reader, &dialect->replies);
    wh_reader_leave(reader);
}

const char *wh_dialect_list_starts(const wh_framing_t *framing, char text[WH_DIALECT_STARTS_BYTES]) {
    size_t length =
        (size_t)snprintf(text, WH_DIALECT_STARTS_BYTES, "%s", framing->start_count > 0 ? "" : "none");
    for (size_t i = 0; i < framing->start_count; ++i) {
        const wh_framing_mark_t *mark = &framing->starts[i];
        char shown[4 * WH_FRAMING_MARK + 1];
        (void)wh_transcript_escape(shown, sizeof shown, mark->bytes, mark->size);
        length += (size_t)snprintf(text + length, WH_DIALECT_STARTS_BYTES - length, "%s\"%s\"",
                                   i > 0 ? ", " : "", shown);
    }
    return text;
}
