/* The JSON report's values. */
#include "json_values.h"

#include "../math/vector.h"

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
