#include "transcript.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "../text/array.h"
#include "../text/output.h"
#include "../text/utf8.h"
#include "transcript_internal.h"

#define FIRST_LINE "waferhand transcript 1"
/* The most bytes of a value that a message shows. */
#define SHOWN 80
/* The most digits of a slice, and of whole seconds. */
#define DIGITS 12
/* The expected values of fields, for messages. */
#define SLICE "digits, not less than in the entry before"
#define TIME "seconds with six decimals, not less than in the entry before"
#define HEAD_TEXT "a text in quotes without control characters"

static const char port_letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-.";
static const char head_letters[] = "abcdefghijklmnopqrstuvwxyz_";

static bool is_word(const char *text, const char *letters) {
    const size_t size = strspn(text, letters);
    return size >= 1 && size <= WH_TRANSCRIPT_NAME && text[size] == '\0';
}

bool wh_transcript_has_bytes(wh_transcript_kind_t kind) {
    return kind == WH_TRANSCRIPT_SAID || kind == WH_TRANSCRIPT_TIMED_OUT || kind == WH_TRANSCRIPT_HEARD;
}

const char *wh_transcript_kind_name(wh_transcript_kind_t kind) {
    static const struct {
        wh_transcript_kind_t kind;
        const char *name;
    } names[] = {{WH_TRANSCRIPT_SAID, "said"},       {WH_TRANSCRIPT_TIMED_OUT, "timed_out"},
                 {WH_TRANSCRIPT_HEARD, "heard"},     {WH_TRANSCRIPT_CAME, "came"},
                 {WH_TRANSCRIPT_WENT, "went"},       {WH_TRANSCRIPT_CLOCK, "clock"},
                 {WH_TRANSCRIPT_STOPPED, "stopped"}, {WH_TRANSCRIPT_HALTED, "halted"},
                 {WH_TRANSCRIPT_ENDED, "ended"},     {WH_TRANSCRIPT_ELAPSED, "elapsed"}};
    const char *name = NULL;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        name = names[i].kind == kind ? names[i].name : name;
    }
    return name;
}

/* ----------------------------------------------------------------------------------------------- escapes */

/* Bytes that have a letter behind a backslash, and their letters. */
static const char escaped_bytes[] = "\r\n\t\\\"";
static const char escape_letters[] = "rnt\\\"";

static size_t escape_byte(char piece[5], uint8_t byte) {
    const char *found = byte != 0 ? strchr(escaped_bytes, byte) : NULL;
    if (found) {
        return (size_t)snprintf(piece, 5, "\\%c", escape_letters[found - escaped_bytes]);
    }
    return (size_t)snprintf(piece, 5, byte >= ' ' && byte <= '~' ? "%c" : "\\x%02X", byte);
}

size_t wh_transcript_escape(char *to, size_t size, const uint8_t *bytes, size_t count) {
    size_t at = 0;
    size_t done = 0;
    char piece[5];
    for (; done < count; ++done) {
        const size_t length = escape_byte(piece, bytes[done]);
        if (at + length + 1 > size) {
            break;
        }
        memcpy(to + at, piece, length);
        at += length;
    }
    to[at] = '\0';
    return done;
}

static void write_quoted(FILE *out, const uint8_t *bytes, size_t count) {
    char piece[5];
    (void)fputc('"', out);
    for (size_t i = 0; i < count; ++i) {
        (void)escape_byte(piece, bytes[i]);
        (void)fputs(piece, out);
    }
    (void)fputc('"', out);
}

/* The value of a hex digit; -1: it is not a hex digit. */
static int digit_value(char letter) {
    static const char digits[] = "0123456789abcdef0123456789ABCDEF";
    const char *found = letter != '\0' ? strchr(digits, letter) : NULL;
    return found ? (int)(found - digits) % 16 : -1;
}

/* Reads two hex digits, and passes them. -1: they are not hex digits. */
static int read_digits(const char **at) {
    if (digit_value((*at)[0]) < 0 || digit_value((*at)[1]) < 0) {
        return -1;
    }
    const int value = 16 * digit_value((*at)[0]) + digit_value((*at)[1]);
    *at += 2;
    return value;
}

/* Reads the byte that the text at `*at` stands for, and passes it. -1: it is not valid. */
static int read_byte(const char **at) {
    const char letter = *(*at)++;
    if (letter != '\\') {
        return letter >= ' ' && letter <= '~' && letter != '"' ? letter : -1;
    }
    const char name = *(*at)++;
    const char *found = name != '\0' ? strchr(escape_letters, name) : NULL;
    if (name == 'x') {
        return read_digits(at);
    }
    return found ? escaped_bytes[found - escape_letters] : -1;
}

/* ----------------------------------------------------------------------------------------------- writing */

bool wh_transcript_write_heads(FILE *out, const wh_transcript_head_t *heads, size_t count) {
    (void)fputs(FIRST_LINE "\n", out);
    for (size_t i = 0; i < count; ++i) {
        if (!is_word(heads[i].name, head_letters)) {
            return false;
        }
        (void)fprintf(out, "%s ", heads[i].name);
        write_quoted(out, (const uint8_t *)heads[i].text, strlen(heads[i].text));
        (void)fputc('\n', out);
    }
    (void)fputc('\n', out);
    return !ferror(out);
}

bool wh_transcript_is_entry(const wh_transcript_entry_t *entry) {
    const int64_t limit = 1000000000000;
    return entry->slice >= 0 && entry->slice < limit && entry->time_us >= 0 &&
           entry->time_us / 1000000 < limit && wh_transcript_kind_name(entry->kind) &&
           is_word(entry->port, port_letters) &&
           entry->size <= (wh_transcript_has_bytes(entry->kind) ? WH_TRANSCRIPT_BYTES : 0);
}

/* Writes an entry without its bytes. */
static void write_place(FILE *out, const wh_transcript_entry_t *entry) {
    (void)fprintf(out, "%lld %lld.%06lld %c %s", (long long)entry->slice, (long long)entry->time_us / 1000000,
                  (long long)entry->time_us % 1000000, entry->kind, entry->port);
}

bool wh_transcript_write(FILE *out, const wh_transcript_entry_t *entry) {
    if (!wh_transcript_is_entry(entry)) {
        return false;
    }
    write_place(out, entry);
    if (wh_transcript_has_bytes(entry->kind)) {
        (void)fputc(' ', out);
        write_quoted(out, entry->bytes, entry->size);
    }
    (void)fputc('\n', out);
    return !ferror(out);
}

/* ----------------------------------------------------------------------------------------------- reading */

bool wh_transcript_refuse(wh_transcript_t *transcript, size_t line, const char *field, const char *value,
                          const char *expected) {
    char shown[SHOWN];
    wh_utf8_visible(shown, sizeof shown, value[0] != '\0' ? value : "nothing");
    (void)snprintf(transcript->message, sizeof transcript->message, "%.300s:%zu: %s: %s (expected %s)",
                   transcript->path, line, field, shown, expected);
    return false;
}

static bool refuse_file(wh_transcript_t *transcript, const char *why) {
    (void)snprintf(transcript->message, sizeof transcript->message, "%.300s: %s", transcript->path, why);
    return false;
}

/* Cuts the field at `*at` off at its blank, and passes both. */
static char *take_field(char **at) {
    char *field = *at;
    char *end = field + strcspn(field, " ");
    *at = *end == ' ' ? end + 1 : end;
    *end = '\0';
    return field;
}

/* Reads a text in quotes up to the line's end, in place. False: it is not one. */
static bool read_quoted(char *text, size_t *size) {
    const size_t length = strlen(text);
    if (length < 2 || text[0] != '"' || text[length - 1] != '"') {
        return false;
    }
    const char *at = text + 1;
    const char *end = text + length - 1;
    *size = 0;
    while (at < end) {
        const int byte = read_byte(&at);
        if (byte < 0) {
            return false;
        }
        text[(*size)++] = (char)byte;
    }
    return at == end;
}

static bool read_whole(const char *text, size_t digits, int64_t *value) {
    const size_t size = strspn(text, "0123456789");
    *value = size == digits ? strtoll(text, NULL, 10) : -1;
    return size == digits;
}

static bool read_slice(const char *text, int64_t *slice) {
    const size_t size = strlen(text);
    return size >= 1 && size <= DIGITS && read_whole(text, size, slice);
}

static bool read_time(char *text, int64_t *time_us) {
    int64_t seconds = 0;
    int64_t rest = 0;
    const size_t size = strspn(text, "0123456789");
    if (size < 1 || size > DIGITS || text[size] != '.' || strlen(text + size + 1) != 6 ||
        !read_whole(text, size, &seconds) || !read_whole(text + size + 1, 6, &rest)) {
        return false;
    }
    *time_us = 1000000 * seconds + rest;
    return true;
}

bool wh_transcript_add_head(wh_transcript_t *transcript, const wh_transcript_head_t *head, size_t size) {
    if (!is_word(head->name, head_letters)) {
        return wh_transcript_refuse(transcript, head->line, "head", head->name,
                                    "a word of small letters, or an entry");
    }
    if (transcript->count > 0) {
        return wh_transcript_refuse(transcript, head->line, "head", head->name, "no head behind an entry");
    }
    for (size_t i = 0; i < size; ++i) {
        if ((unsigned char)head->text[i] < ' ' || head->text[i] == 0x7F) {
            return wh_transcript_refuse(transcript, head->line, head->name, head->text, HEAD_TEXT);
        }
    }
    transcript->heads = wh_array_grow(transcript->heads, transcript->head_count, &transcript->head_capacity,
                                      sizeof *transcript->heads);
    transcript->heads[transcript->head_count++] = *head;
    return true;
}

static bool take_head(wh_transcript_t *transcript, size_t line, char *at) {
    wh_transcript_head_t head = {.line = line};
    size_t size = 0;
    head.name = take_field(&at);
    head.text = at;
    if (is_word(head.name, head_letters) && transcript->count == 0) {
        if (!read_quoted(at, &size)) {
            return wh_transcript_refuse(transcript, line, head.name, at, HEAD_TEXT);
        }
        at[size] = '\0';
    }
    return wh_transcript_add_head(transcript, &head, size);
}

bool wh_transcript_add_entry(wh_transcript_t *transcript, const wh_transcript_entry_t *entry) {
    char value[32];
    const wh_transcript_entry_t *last =
        transcript->count > 0 ? &transcript->entries[transcript->count - 1] : NULL;
    if (last && entry->kind != WH_TRANSCRIPT_CLOCK && entry->slice < last->slice) {
        (void)snprintf(value, sizeof value, "%lld", (long long)entry->slice);
        return wh_transcript_refuse(transcript, entry->line, "slice", value, SLICE);
    }
    if (last && entry->kind != WH_TRANSCRIPT_CLOCK && entry->time_us < last->time_us) {
        (void)snprintf(value, sizeof value, "%lld.%06lld", (long long)entry->time_us / 1000000,
                       (long long)entry->time_us % 1000000);
        return wh_transcript_refuse(transcript, entry->line, "time", value, TIME);
    }
    if (!is_word(entry->port, port_letters)) {
        return wh_transcript_refuse(transcript, entry->line, "port", entry->port,
                                    "1 to 63 letters, digits and _ - .");
    }
    transcript->entries = wh_array_grow(transcript->entries, transcript->count, &transcript->capacity,
                                        sizeof *transcript->entries);
    transcript->entries[transcript->count++] = *entry;
    return true;
}

static bool take_moment(wh_transcript_t *transcript, wh_transcript_entry_t *entry, char **at) {
    char *slice = take_field(at);
    if (!read_slice(slice, &entry->slice)) {
        return wh_transcript_refuse(transcript, entry->line, "slice", slice, SLICE);
    }
    char *time = take_field(at);
    return read_time(time, &entry->time_us) ||
           wh_transcript_refuse(transcript, entry->line, "time", time, TIME);
}

static bool take_entry(wh_transcript_t *transcript, size_t line, char *at) {
    wh_transcript_entry_t entry = {.line = line};
    if (!take_moment(transcript, &entry, &at)) {
        return false;
    }
    const char *kind = take_field(&at);
    if (strlen(kind) != 1 || !wh_transcript_kind_name((wh_transcript_kind_t)kind[0])) {
        return wh_transcript_refuse(transcript, line, "kind", kind,
                                    "one of > < ~ before a frame, or of + - = ! * . ?");
    }
    entry.kind = (wh_transcript_kind_t)kind[0];
    const bool has_bytes = wh_transcript_has_bytes(entry.kind);
    entry.port = take_field(&at);
    entry.bytes = (const uint8_t *)at;
    if (!has_bytes && at[0] != '\0') {
        return wh_transcript_refuse(transcript, line, "bytes", at, "nothing, for no frame came");
    }
    if (has_bytes && (!read_quoted(at, &entry.size) || entry.size > WH_TRANSCRIPT_BYTES)) {
        return wh_transcript_refuse(transcript, line, "bytes", at,
                                    "up to 8192 bytes in quotes, with \\r, \\n, \\t, \\\\, "
                                    "\\\" and \\xHH");
    }
    return wh_transcript_add_entry(transcript, &entry);
}

static bool take_line(wh_transcript_t *transcript, size_t line, char *text) {
    if (line == 1) {
        transcript->is_json = text[0] == '{';
        return transcript->is_json
                   ? wh_transcript_take_json(transcript, line, text)
                   : strcmp(text, FIRST_LINE) == 0 ||
                         wh_transcript_refuse(transcript, line, "first line", text, FIRST_LINE);
    }
    if (text[0] == '\0') {
        return true;
    }
    if (transcript->is_json) {
        return wh_transcript_take_json(transcript, line, text);
    }
    if (text[0] == '#') {
        return true;
    }
    return text[0] >= '0' && text[0] <= '9' ? take_entry(transcript, line, text)
                                            : take_head(transcript, line, text);
}

/* Takes the text apart, line by line, in place. It ends in a zero. */
static bool take_text(wh_transcript_t *transcript, size_t size) {
    char *end = transcript->text + size;
    size_t line = 1;
    char *at = transcript->text;
    do {
        char *line_end = memchr(at, '\n', (size_t)(end - at));
        line_end = line_end ? line_end : end;
        if (memchr(at, '\0', (size_t)(line_end - at))) {
            return wh_transcript_refuse(transcript, line, "line", "a byte 0", "text");
        }
        *line_end = '\0';
        if (line_end > at && line_end[-1] == '\r') {
            line_end[-1] = '\0';
        }
        if (!take_line(transcript, line++, at)) {
            return false;
        }
        at = line_end + 1;
    } while (at < end);
    wh_transcript_rewind(transcript);
    return true;
}

bool wh_transcript_parse(wh_transcript_t *transcript, const char *name, const void *bytes, size_t size) {
    *transcript = (wh_transcript_t){.path = name};
    transcript->text = wh_memory_need(malloc(size + 1));
    memcpy(transcript->text, bytes, size);
    transcript->text[size] = '\0';
    return take_text(transcript, size);
}

bool wh_transcript_open(wh_transcript_t *transcript, const char *path) {
    struct stat status;
    *transcript = (wh_transcript_t){.path = path};
    if (stat(path, &status) != 0) {
        return refuse_file(transcript, strerror(errno));
    }
    if (!S_ISREG(status.st_mode)) {
        return refuse_file(transcript, "it is no regular file");
    }
    if (status.st_size > WH_TRANSCRIPT_FILE) {
        return refuse_file(transcript, "it has more than 268435456 bytes");
    }
    FILE *file = fopen(path, "rb");
    if (!file) {
        return refuse_file(transcript, strerror(errno));
    }
    const size_t room = (size_t)status.st_size;
    transcript->text = wh_memory_need(malloc(room + 1));
    const size_t size = fread(transcript->text, 1, room, file);
    const bool failed = ferror(file) != 0;
    (void)fclose(file);
    if (failed) {
        return refuse_file(transcript, "it cannot be read");
    }
    transcript->text[size] = '\0';
    wh_output_keep(path);
    return take_text(transcript, size);
}

void wh_transcript_close(wh_transcript_t *transcript) {
    free(transcript->text);
    free(transcript->heads);
    free(transcript->entries);
    transcript->text = NULL;
    transcript->heads = NULL;
    transcript->entries = NULL;
    transcript->count = transcript->head_count = 0;
}
