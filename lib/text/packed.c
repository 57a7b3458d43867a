#include "packed.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "array.h"

/* The level, up to 9. From here on a page gets smaller by less than three percent, in up to three times the
 * time. */
#define LEVEL 5

char *wh_packed_bytes(const char *head, const uint8_t *bytes, size_t size) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char *text = wh_memory_need(malloc(strlen(head) + (size + 2) / 3 * 4 + 1));
    char *to = stpcpy(text, head);
    for (size_t i = 0; i < size; i += 3) {
        const size_t left = size - i;
        const uint32_t bits = (uint32_t)bytes[i] << 16 | (left > 1 ? (uint32_t)bytes[i + 1] << 8 : 0) |
                              (left > 2 ? bytes[i + 2] : 0);
        *to++ = digits[bits >> 18];
        *to++ = digits[bits >> 12 & 63];
        *to++ = left > 1 ? digits[bits >> 6 & 63] : '=';
        *to++ = left > 2 ? digits[bits & 63] : '=';
    }
    *to = '\0';
    return text;
}

char *wh_packed_text(const char *text, size_t size) {
    uLongf packed_size = compressBound((uLong)size);
    Bytef *packed = wh_memory_need(malloc(packed_size));
    if (compress2(packed, &packed_size, (const Bytef *)text, (uLong)size, LEVEL) != Z_OK) {
        wh_memory_out();
    }
    char *made = wh_packed_bytes("", packed, packed_size);
    free(packed);
    return made;
}
