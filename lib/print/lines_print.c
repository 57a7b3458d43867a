#include "lines_print.h"

#include <math.h>
#include <string.h>

#include "../text/digits.h"
#include "../text/json.h"
#include "print_internal.h"
#include "record_print.h"

int wh_event_print_line(const wh_record_t *record, size_t i, FILE *out) {
    json_t *event = wh_event_to_json(record, i);
    const int status = json_dumpf(event, out, JSON_REAL_PRECISION(17));
    json_decref(event);
    return status == 0 && fputc('\n', out) != EOF ? 0 : -1;
}

/* A spreadsheet takes a text that begins with these for a formula. */
static bool is_formula(const char *text) {
    return text[0] != '\0' && strchr("=+-@\t\r", text[0]) != NULL;
}

void wh_print_csv_text(const char *text, FILE *out) {
    if (!is_formula(text) && text[strcspn(text, ",\"\r\n")] == '\0') {
        fputs(text, out);
        return;
    }
    fputs(is_formula(text) ? "\"'" : "\"", out);
    for (; *text != '\0'; ++text) {
        fputs(*text == '"' ? "\"" : "", out);
        fputc((unsigned char)*text, out);
    }
    fputc('"', out);
}

void wh_print_csv_number(double value, FILE *out) {
    char digits[WH_DIGITS];
    if (isfinite(value)) {
        wh_digits(value, digits);
        fputs(digits, out);
    }
}
