#include "lines_print.h"

#include <math.h>
#include <string.h>

#include "../log/slice_fields.h"
#include "../text/json.h"
#include "print_internal.h"
#include "record_print.h"

int wh_event_print_line(const wh_record_t *record, size_t i, FILE *out) {
    json_t *event = wh_event_to_json(record, i);
    const int status = json_dumpf(event, out, JSON_REAL_PRECISION(17));
    json_decref(event);
    return status == 0 && fputc('\n', out) != EOF ? 0 : -1;
}

void wh_print_csv_text(const char *text, FILE *out) {
    if (text[strcspn(text, ",\"\r\n")] == '\0') {
        fputs(text, out);
        return;
    }
    fputc('"', out);
    for (; *text != '\0'; ++text) {
        fputs(*text == '"' ? "\"" : "", out);
        fputc((unsigned char)*text, out);
    }
    fputc('"', out);
}

void wh_print_csv_number(double value, FILE *out) {
    char digits[WH_JSON_DIGITS];
    if (isfinite(value)) {
        wh_json_digits(value, digits);
        fputs(digits, out);
    }
}

void wh_slices_csv_head(const wh_layout_t *layout, FILE *out) {
    char name[WH_SLICE_FIELD_NAME];
    fputs("slice,time s", out);
    for (size_t i = 0; i < wh_slice_field_count(layout); ++i) {
        (void)wh_slice_field_name(layout, i, name);
        fputc(',', out);
        wh_print_csv_text(name, out);
    }
    fputc('\n', out);
}

void wh_slices_csv_row(const wh_layout_t *layout, int64_t slice, const double values[], FILE *out) {
    char name[WH_SLICE_FIELD_NAME];
    fprintf(out, "%lld,", (long long)slice);
    wh_print_csv_number((double)(slice * layout->slice_us) / 1e6, out);
    for (size_t i = 0; i < wh_slice_field_count(layout); ++i) {
        const wh_slice_field_t kind = wh_slice_field_name(layout, i, name);
        const char *word = wh_slice_field_word(layout, kind, values[i]);
        fputc(',', out);
        if (word) {
            wh_print_csv_text(word, out);
        } else {
            wh_print_csv_number(values[i], out);
        }
    }
    fputc('\n', out);
}
