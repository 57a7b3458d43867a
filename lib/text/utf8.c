#include "utf8.h"

#include <stdlib.h>
#include <string.h>

size_t wh_utf8_bytes(const char *text) {
    const size_t left = strlen(text);
    for (size_t bytes = 1; bytes <= 4 && bytes <= left; ++bytes) {
        json_t *character = json_stringn(text, bytes);
        if (character) {
            json_decref(character);
            return bytes;
        }
    }
    return 0;
}

static json_t *repaired_text(const char *text) {
    static const char replacement[] = "\xef\xbf\xbd";
    char *repaired = malloc(3 * strlen(text) + 1);
    if (!repaired) {
        return NULL;
    }
    char *to = repaired;
    while (*text != '\0') {
        const size_t bytes = wh_utf8_bytes(text);
        memcpy(to, bytes > 0 ? text : replacement, bytes > 0 ? bytes : 3);
        to += bytes > 0 ? bytes : 3;
        text += bytes > 0 ? bytes : 1;
    }
    json_t *value = json_stringn(repaired, (size_t)(to - repaired));
    free(repaired);
    return value;
}

json_t *wh_json_text(const char *text) {
    if (!text) {
        return json_null();
    }
    json_t *value = json_string(text);
    return value ? value : repaired_text(text);
}
