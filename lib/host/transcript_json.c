/* A transcript as JSON lines. */
#include <math.h>
#include <string.h>

#include "../text/json.h"
#include "transcript_internal.h"

/* ----------------------------------------------------------------------------------------------- writing */

static void write_text(FILE *out, const uint8_t *bytes, size_t count) {
    static const char escaped[] = "\r\n\t\\\"";
    static const char letters[] = "rnt\\\"";
    (void)fputc('"', out);
    for (size_t i = 0; i < count; ++i) {
        const char *found = bytes[i] != 0 ? strchr(escaped, bytes[i]) : NULL;
        if (found) {
            (void)fprintf(out, "\\%c", letters[found - escaped]);
        } else {
            (void)fprintf(out, bytes[i] >= ' ' && bytes[i] <= '~' ? "%c" : "\\u%04x", bytes[i]);
        }
    }
    (void)fputc('"', out);
}

bool wh_transcript_write_json_heads(FILE *out, const wh_transcript_head_t *heads, size_t count) {
    (void)fputs("{\"transcript\":1}\n", out);
    for (size_t i = 0; i < count; ++i) {
        (void)fprintf(out, "{\"head\":\"%s\",\"text\":", heads[i].name);
        write_text(out, (const uint8_t *)heads[i].text, strlen(heads[i].text));
        (void)fputs("}\n", out);
    }
    return !ferror(out);
}

bool wh_transcript_write_json(FILE *out, const wh_transcript_entry_t *entry) {
    if (!wh_transcript_is_entry(entry)) {
        return false;
    }
    (void)fprintf(out, "{\"slice\":%lld,\"time\":%lld.%06lld,\"kind\":\"%s\",\"port\":\"%s\"",
                  (long long)entry->slice, (long long)entry->time_us / 1000000,
                  (long long)entry->time_us % 1000000, wh_transcript_kind_name(entry->kind), entry->port);
    if (wh_transcript_has_bytes(entry->kind)) {
        (void)fputs(",\"bytes\":", out);
        write_text(out, entry->bytes, entry->size);
    }
    (void)fputs("}\n", out);
    return !ferror(out);
}

/* ----------------------------------------------------------------------------------------------- reading */

/* A JSON text, which is valid UTF-8. */
typedef struct {
    const char *text;
    size_t size;
} text_t;

/* The bytes that the characters stand for, to `to`, with a zero behind them; as many as the return says.
 * SIZE_MAX: a character has a number above 255. */
static size_t take_bytes(const text_t *from, char *to) {
    size_t count = 0;
    for (size_t i = 0; i < from->size; ++i) {
        const unsigned char byte = (unsigned char)from->text[i];
        if (byte > 0xC3) {
            return SIZE_MAX;
        }
        if (byte >= 0xC2) {
            to[count++] = (char)(unsigned char)((byte & 3U) << 6 | ((unsigned char)from->text[++i] & 0x3FU));
        } else {
            to[count++] = (char)byte;
        }
    }
    to[count] = '\0';
    return count;
}

static bool refuse_line(wh_transcript_t *transcript, size_t line, const char *shown) {
    return wh_transcript_refuse(
        transcript, line, "line", shown,
        line == 1 ? "{\"transcript\":1}"
                  : "{\"head\":NAME,\"text\":TEXT} or {\"slice\":WHOLE,\"time\":S,\"kind\":KIND,"
                    "\"port\":NAME,\"bytes\":TEXT}");
}

static bool find_entry_kind(const char *name, wh_transcript_kind_t *kind) {
    for (int sign = ' '; sign <= '~'; ++sign) {
        *kind = (wh_transcript_kind_t)sign;
        const char *own = wh_transcript_kind_name(*kind);
        if (own && strcmp(own, name) == 0) {
            return true;
        }
    }
    return false;
}

static bool take_head_fields(wh_transcript_t *transcript, size_t line, text_t name, text_t value,
                             char *text) {
    wh_transcript_head_t head = {text, NULL, line};
    const size_t size = take_bytes(&name, text);
    char *behind = text + (size == SIZE_MAX ? 0 : size + 1);
    const size_t value_size = size == SIZE_MAX ? SIZE_MAX : take_bytes(&value, behind);
    head.text = behind;
    return value_size == SIZE_MAX || strlen(text) != size
               ? wh_transcript_refuse(transcript, line, "head", name.text, "characters up to U+00FF")
               : wh_transcript_add_head(transcript, &head, value_size);
}

/* The fields of an entry's object. */
typedef struct {
    json_int_t slice;
    double time;
    text_t kind, port, bytes;
} fields_t;

/* Port and bytes go to `text`, which has room for both. */
static bool take_texts(const fields_t *fields, char *text, wh_transcript_entry_t *entry) {
    const size_t port_size = take_bytes(&fields->port, text);
    const bool has_bytes = fields->bytes.text != NULL;
    if (port_size == SIZE_MAX || strlen(text) != port_size) {
        return false;
    }
    entry->bytes = (const uint8_t *)text + port_size + 1;
    entry->size = has_bytes ? take_bytes(&fields->bytes, text + port_size + 1) : 0;
    return has_bytes == wh_transcript_has_bytes(entry->kind) && entry->size <= WH_TRANSCRIPT_BYTES;
}

static bool take_entry_fields(wh_transcript_t *transcript, size_t line, const fields_t *fields, char *text) {
    wh_transcript_entry_t entry = {.line = line, .slice = fields->slice, .port = text};
    if (!find_entry_kind(fields->kind.text, &entry.kind)) {
        return wh_transcript_refuse(
            transcript, line, "kind", fields->kind.text,
            "said, timed_out, heard, came, went, clock, stopped, halted, ended or elapsed");
    }
    if (!(fields->time >= 0 && fields->time < 9e9)) {
        return wh_transcript_refuse(transcript, line, "time", "another", "seconds from 0 to 9e9");
    }
    entry.time_us = llround(fields->time * 1e6);
    if (!take_texts(fields, text, &entry)) {
        return wh_transcript_refuse(transcript, line, "bytes", fields->bytes.text ? fields->bytes.text : "",
                                    "up to 8192 characters up to U+00FF, of frames alone");
    }
    return wh_transcript_is_entry(&entry)
               ? wh_transcript_add_entry(transcript, &entry)
               : wh_transcript_refuse(transcript, line, "slice, time or port", fields->port.text,
                                      "below 1e12, and 1 to 63 letters, digits and _ - .");
}

static bool take_object(wh_transcript_t *transcript, size_t line, json_t *object, char *text) {
    fields_t fields = {0};
    text_t name;
    text_t value;
    int version = 0;
    if (line == 1) {
        const bool good = json_unpack_ex(object, NULL, JSON_STRICT, "{s:i}", "transcript", &version) == 0;
        return (good && version == 1) || refuse_line(transcript, line, text);
    }
    if (json_unpack_ex(object, NULL, JSON_STRICT, "{s:s%,s:s%}", "head", &name.text, &name.size, "text",
                       &value.text, &value.size) == 0) {
        return take_head_fields(transcript, line, name, value, text);
    }
    if (json_unpack_ex(object, NULL, JSON_STRICT, "{s:I,s:F,s:s%,s:s%,s?:s%}", "slice", &fields.slice, "time",
                       &fields.time, "kind", &fields.kind.text, &fields.kind.size, "port", &fields.port.text,
                       &fields.port.size, "bytes", &fields.bytes.text, &fields.bytes.size) != 0) {
        return refuse_line(transcript, line, text);
    }
    return take_entry_fields(transcript, line, &fields, text);
}

/* The texts that are read take no more room than their line, which also holds names and quotes. */
bool wh_transcript_take_json(wh_transcript_t *transcript, size_t line, char *text) {
    json_t *object = json_loads(text, JSON_ALLOW_NUL | JSON_REJECT_DUPLICATES, NULL);
    if (!object) {
        return refuse_line(transcript, line, text);
    }
    const bool taken = take_object(transcript, line, object, text);
    json_decref(object);
    return taken;
}
