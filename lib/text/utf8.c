#include "utf8.h"

#include <stdlib.h>
#include <string.h>

#include "array.h"

/* The bytes of the character that a byte begins: 0 for those that begin none. */
static size_t length_by(unsigned char lead) {
    if (lead < 0x80) {
        return lead != '\0';
    }
    return lead < 0xC2 ? 0 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : lead < 0xF5 ? 4 : 0;
}

size_t wh_utf8_bytes(const char *text) {
    /* What a character of so many bytes is at least; below, it would be longer than needed. */
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
