/* The JSON report's values. */
#include <string.h>

#include "app/json_internal.h"

void wh_json_put(wh_json_writer_t *writer, json_t *object, const char *key, json_t *value) {
    if (json_object_set_new(object, key, value) != 0) {
        writer->failed = true;
    }
}

void wh_json_append(wh_json_writer_t *writer, json_t *list, json_t *value) {
    if (json_array_append_new(list, value) != 0) {
        writer->failed = true;
    }
}

json_t *wh_json_real(double value) {
    return wh_real_is_finite((wh_real_t)value) ? json_real(value) : json_null();
}

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

json_t *wh_json_list(wh_json_writer_t *writer, wh_json_element_t *element, size_t count) {
    json_t *list = json_array();
    for (size_t i = 0; i < count; ++i) {
        wh_json_append(writer, list, element(writer, i));
    }
    return list;
}

static int dump(const json_t *value, FILE *out) {
    return json_dumpf(value, out, JSON_ENCODE_ANY | JSON_REAL_PRECISION(17));
}

static int dump_list(const json_t *list, FILE *out) {
    size_t i;
    json_t *element;
    int status = 0;
    fputs("[", out);
    json_array_foreach(list, i, element) {
        fputs(i == 0 ? "\n    " : ",\n    ", out);
        status |= dump(element, out);
    }
    fputs(json_array_size(list) > 0 ? "\n  ]" : "]", out);
    return status;
}

int wh_json_print(json_t *root, FILE *out) {
    const char *key, *before = "{\n  ";
    json_t *value;
    int status = 0;
    json_object_foreach(root, key, value) {
        fprintf(out, "%s\"%s\": ", before, key);
        status |= json_is_array(value) ? dump_list(value, out) : dump(value, out);
        before = ",\n  ";
    }
    fputs("\n}\n", out);
    return status != 0 || fflush(out) != 0 || ferror(out) ? -1 : 0;
}
