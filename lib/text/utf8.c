#include "utf8.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "array.h"

/* The length of the character that a byte begins: 0 for bytes that begin none. */
static size_t length_by(unsigned char lead) {
    if (lead < 0x80) {
        return lead != '\0';
    }
    return lead < 0xC2 ? 0 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : lead < 0xF5 ? 4 : 0;
}

size_t wh_utf8_bytes(const char *text) {
    /* The least character of each length; a smaller one would need fewer bytes. */
    static const unsigned long least[] = {0, 0, 0x80, 0x800, 0x10000};
    const size_t length = length_by((unsigned char)text[0]);
    unsigned long character = length < 2 ? 0 : (unsigned char)text[0] & (0x7FU >> length);
    for (size_t i = 1; i < length; ++i) {
        if (!wh_utf8_goes_on(text[i])) {
            return 0;
        }
        character = character << 6 | ((unsigned char)text[i] & 0x3FU);
    }
    const bool is_surrogate = character >= 0xD800 && character < 0xE000;
    return character < least[length] || is_surrogate || character > 0x10FFFF ? 0 : length;
}

size_t wh_utf8_count(const char *text) {
    size_t count = 0;
    for (; *text != '\0'; ++text) {
        count += wh_utf8_goes_on(*text) ? 0 : 1;
    }
    return count;
}

size_t wh_utf8_cut(const char *text, size_t length) {
    while (length > 0 && wh_utf8_goes_on(text[length])) {
        --length;
    }
    return length;
}

void wh_utf8_clip(char *to, size_t size, const char *from) {
    const size_t length = strlen(from);
    if (length < size) {
        memcpy(to, from, length + 1);
        return;
    }
    const size_t kept = wh_utf8_cut(from, size - sizeof "...");
    memcpy(to, from, kept);
    memcpy(to + kept, "...", sizeof "...");
}

size_t wh_utf8_control_bytes(const char *text) {
    const unsigned char first = (unsigned char)text[0];
    if (first < 0x20 || first == 0x7F) {
        return 1;
    }
    if (first == 0xC2 && (unsigned char)text[1] >= 0x80 && (unsigned char)text[1] < 0xA0) {
        return 2;
    }
    return first >= 0x80 && first < 0xA0 ? 1 : 0;
}

void wh_utf8_visible(char *to, size_t size, const char *from) {
    wh_utf8_visible_bytes(to, size, from, strlen(from));
}

void wh_utf8_visible_bytes(char *to, size_t size, const char *from, size_t from_length) {
    const char *const end = from + from_length;
    size_t length = 0;
    size_t cut = 0; /* the last place where an ellipsis would fit */
    while (from < end) {
        const size_t control = wh_utf8_control_bytes(from);
        const size_t valid = wh_utf8_bytes(from);
        const size_t bytes = control > 0 ? control : valid > 0 ? valid : 1;
        const size_t needed = control > 0 ? 4 * control : bytes;
        cut = length + sizeof "..." <= size ? length : cut;
        if (length + needed >= size) {
            memcpy(to + cut, "...", sizeof "...");
            return;
        }
        for (size_t i = 0; i < bytes; ++i, ++from) {
            length += control > 0
                          ? (size_t)snprintf(to + length, size - length, "\\x%02X", (unsigned char)*from)
                          : (size_t)snprintf(to + length, size - length, "%c", *from);
        }
    }
    to[length] = '\0';
}

/* The character, or the bytes of a control character, with which a text begins. */
static size_t first_bytes(const char *text, size_t size, bool *is_control) {
    char begin[5] = "";
    memcpy(begin, text, size < 4 ? size : 4);
    const size_t control = begin[0] == '\n' || begin[0] == '\t' ? 0 : wh_utf8_control_bytes(begin);
    const size_t character = wh_utf8_bytes(begin);
    *is_control = control > 0;
    return control > 0 ? control : character > 0 ? character : 1;
}

size_t wh_utf8_piece(const char *text, size_t size, char piece[WH_UTF8_PIECE], size_t *length) {
    size_t taken = 0;
    *length = 0;
    while (taken < size && *length < WH_UTF8_PIECE - 12) {
        bool is_control = false;
        const size_t bytes = first_bytes(text + taken, size - taken, &is_control);
        for (const size_t end = taken + bytes; taken < end; ++taken) {
            if (is_control) {
                *length += (size_t)sprintf(piece + *length, "\\x%02X", (unsigned char)text[taken]);
            } else {
                piece[(*length)++] = text[taken];
            }
        }
    }
    return taken;
}

char *wh_utf8_repaired(const char *text) {
    char *repaired = wh_memory_need(malloc(3 * strlen(text) + 1));
    char *to = repaired;
    while (*text != '\0') {
        const size_t bytes = wh_utf8_bytes(text);
        to = bytes > 0 ? mempcpy(to, text, bytes) : stpcpy(to, WH_UTF8_REPLACEMENT);
        text += bytes > 0 ? bytes : 1;
    }
    *to = '\0';
    return repaired;
}
