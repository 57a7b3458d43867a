#include "json.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "array.h"
#include "digits.h"
#include "utf8.h"

/* ------------------------------------------------------------------------------------------------- values */

void wh_json_put(json_t *object, const char *key, json_t *value) {
    if (json_object_set_new(object, key, value) != 0) {
        wh_memory_out();
    }
}

void wh_json_append(json_t *list, json_t *value) {
    if (json_array_append_new(list, value) != 0) {
        wh_memory_out();
    }
}

json_t *wh_json_real(double value) {
    return isfinite(value) ? json_real(value) : json_null();
}

json_t *wh_json_hash(uint64_t value) {
    return json_sprintf("%016llx", (unsigned long long)value);
}

json_t *wh_json_text(const char *text) {
    if (!text) {
        return json_null();
    }
    json_t *value = json_string(text);
    if (!value) {
        char *repaired = wh_utf8_repaired(text);
        value = json_string(repaired);
        free(repaired);
    }
    return value;
}

json_t *wh_json_vector(wh_vec3_t v) {
    return json_pack("[o, o, o]", wh_json_real((double)v.x), wh_json_real((double)v.y),
                     wh_json_real((double)v.z));
}

json_t *wh_json_matrix(const wh_mat3_t *m) {
    return json_pack("[o, o, o]", wh_json_vector(wh_mat3_row(m, 0)), wh_json_vector(wh_mat3_row(m, 1)),
                     wh_json_vector(wh_mat3_row(m, 2)));
}

/* Takes the next value, by its conversion. */
static json_t *take_value(const char *conversion, va_list *values) {
    switch (conversion[strlen(conversion) - 1]) {
    case 'g':
        return wh_json_real(va_arg(*values, double));
    case 's':
        return wh_json_text(va_arg(*values, const char *));
    case 'i':
        return json_boolean(va_arg(*values, int));
    case 'x':
        return json_sprintf("%016llx", va_arg(*values, unsigned long long));
    default: {
        const long long value = conversion[1] == 'l' ? va_arg(*values, long long) : va_arg(*values, int);
        return value == WH_JSON_NONE ? json_null() : json_integer(value);
    }
    }
}

json_t *wh_json_set(json_t *object, const char *members, ...) {
    char key[64], conversion[8];
    int read;
    va_list values;
    va_start(values, members);
    for (; sscanf(members, " %63s %7s%n", key, conversion, &read) == 2; members += read) {
        wh_json_put(object, key, take_value(conversion, &values));
    }
    va_end(values);
    return object;
}

json_t *wh_json_add(json_t *object, const char *keys, ...) {
    va_list values;
    va_start(values, keys);
    while (*keys != '\0') {
        const size_t length = strcspn(keys, " ");
        if (json_object_setn_new(object, keys, length, va_arg(values, json_t *)) != 0) {
            wh_memory_out();
        }
        keys += length + strspn(keys + length, " ");
    }
    va_end(values);
    return object;
}

json_t *wh_json_list(wh_json_element_t *element, const void *subject, size_t count) {
    json_t *list = json_array();
    for (size_t i = 0; i < count; ++i) {
        json_t *made = element(subject, i);
        if (made) {
            wh_json_append(list, made);
        }
    }
    return list;
}

/* ----------------------------------------------------------------------------------------------- printing */

/* jansson escapes characters below a blank; DEL and U+0080 to U+009F control terminals, too. */
static int write_visible(const char *buffer, size_t size, void *out) {
    size_t done = 0;
    for (size_t i = 0; i < size; ++i) {
        const bool is_delete = buffer[i] == 0x7F;
        const bool is_late =
            i + 1 < size && (unsigned char)buffer[i] == 0xC2 && (unsigned char)buffer[i + 1] < 0xA0;
        if (is_delete || is_late) {
            fwrite(buffer + done, 1, i - done, out);
            i += is_late ? 1 : 0;
            fprintf(out, "\\u%04x", (unsigned)(unsigned char)buffer[i]);
            done = i + 1;
        }
    }
    fwrite(buffer + done, 1, size - done, out);
    return 0;
}

static int dump(const json_t *value, FILE *out) {
    return json_dump_callback(value, write_visible, out, JSON_ENCODE_ANY | JSON_REAL_PRECISION(17));
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

/* -------------------------------------------------------------------------------------------- as it comes */

/* Writes the text before an element: a comma, and the key of a member. */
static void lead(wh_json_text_t *text, const char *key) {
    if (text->follows) {
        fputc(',', text->out);
    }
    if (key) {
        fprintf(text->out, "\"%s\":", key);
    }
    text->follows = true;
}

void wh_json_text_begin(wh_json_text_t *text, const char *key, char bracket) {
    lead(text, key);
    fputc(bracket, text->out);
    text->follows = false;
}

void wh_json_text_end(wh_json_text_t *text, char bracket) {
    fputc(bracket, text->out);
    text->follows = true;
}

static void write_exact(FILE *out, double value) {
    char digits[WH_DIGITS];
    wh_digits(value, digits);
    fputs(digits, out);
}

/* Writes a number without zeros at the end. Counting in units of the last decimal is faster than printf and
 * gives equal digits. */
static void write_rounded(FILE *out, double value, int decimals) {
    static const double powers[] = {1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};
    const double exact = floor(fabs(value) * powers[decimals] + 0.5);
    if (!(exact < 1e15)) {
        write_exact(out, value);
        return;
    }
    char digits[32];
    char *first = digits + sizeof digits;
    uint64_t units = (uint64_t)exact;
    const bool is_negative = value < 0 && units > 0;
    for (; decimals > 0 && units % 10 == 0; --decimals) {
        units /= 10;
    }
    for (int place = 0; units > 0 || place <= decimals; ++place, units /= 10) {
        if (place > 0 && place == decimals) {
            *--first = '.';
        }
        *--first = (char)('0' + units % 10);
    }
    if (is_negative) {
        *--first = '-';
    }
    (void)fwrite(first, 1, (size_t)(digits + sizeof digits - first), out);
}

void wh_json_text_number(wh_json_text_t *text, const char *key, double value, int decimals, bool exact) {
    lead(text, key);
    if (!isfinite(value)) {
        fputs("null", text->out);
    } else if (exact) {
        write_exact(text->out, value);
    } else {
        write_rounded(text->out, value, decimals);
    }
}

void wh_json_text_integer(wh_json_text_t *text, const char *key, long long value) {
    lead(text, key);
    fprintf(text->out, "%lld", value);
}

static int write_escaped(const char *buffer, size_t size, void *user) {
    FILE *out = user;
    while (size > 0) {
        const char *found = memchr(buffer, '<', size);
        const size_t plain = found ? (size_t)(found - buffer) : size;
        fwrite(buffer, 1, plain, out);
        if (found) {
            fputs("\\u003c", out);
        }
        buffer += plain + (found ? 1 : 0);
        size -= plain + (found ? 1 : 0);
    }
    return 0;
}

void wh_json_text_value(wh_json_text_t *text, const char *key, json_t *value) {
    lead(text, key);
    if (!value || json_dump_callback(value, write_escaped, text->out,
                                     JSON_COMPACT | JSON_ENCODE_ANY | JSON_REAL_PRECISION(17)) != 0) {
        text->failed = true;
        fputs("null", text->out);
    }
    json_decref(value);
}

void wh_json_text_string(wh_json_text_t *text, const char *key, const char *value) {
    wh_json_text_value(text, key, value ? json_string(value) : json_null());
}
