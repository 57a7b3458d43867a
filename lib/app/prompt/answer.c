/* WHERE's answer is a list of name=value, one wafer after the other with "; " between them, as tokens.lua
 * writes it. */
#include "answer.h"

#include <stdlib.h>
#include <string.h>

#include "../../text/array.h"
#include "../../text/grid.h"

enum { WAFER, HOLDER, PLACE, FIRST_NUMBER };

enum { FIELD_NAME = 16 };

/* One name=value: where the value stands in a buffer of its own, without quotes. */
typedef struct {
    char name[FIELD_NAME];
    char *value;
} field_t;

/* True if the text is the beginning of a row: a wafer. */
static bool is_wafer(const char *text) {
    static const char wafer[] = "wafer=";
    return strncmp(text, wafer, sizeof wafer - 1) == 0;
}

static bool ends_value(char letter, bool quoted) {
    return letter == '\0' || (quoted ? letter == '"' : letter == ' ' || letter == ';');
}

/* Copies a value without its quotes; returns what comes after it. */
static const char *read_value(const char *at, char *value) {
    const bool quoted = *at == '"';
    at += quoted ? 1 : 0;
    while (!ends_value(*at, quoted)) {
        at += quoted && *at == '\\' && at[1] != '\0' ? 1 : 0;
        *value++ = *at++;
    }
    *value = '\0';
    return quoted && *at == '"' ? at + 1 : at;
}

/* The next field of a row, into `field`; null where the row ends. */
static const char *read_field(const char *at, field_t *field) {
    at += strspn(at, " ");
    const size_t length = strcspn(at, "= ;");
    if (at[length] != '=' || length >= FIELD_NAME) {
        return NULL;
    }
    memcpy(field->name, at, length);
    field->name[length] = '\0';
    return read_value(at + length + 1, field->value);
}

/* Puts a field into its cell. Slot stands behind its station. */
static void put_field(wh_grid_t *grid, const field_t *field, const char *raw, char *station) {
    static const char *const numbers[] = {"dx", "dy", "dz", "tilt_deg"};
    const bool none = strcmp(raw, "none") == 0;
    if (strcmp(field->name, "wafer") == 0) {
        wh_grid_text(grid, WAFER, WH_INK_PLAIN, "%s", field->value);
    } else if (strcmp(field->name, "holder") == 0 && !none) {
        wh_grid_text(grid, HOLDER, WH_INK_PLAIN, "%s", field->value);
    } else if (strcmp(field->name, "station") == 0) {
        const char *name = none ? "" : field->value;
        memcpy(station, name, strlen(name) + 1);
    } else if (strcmp(field->name, "slot") == 0) {
        wh_grid_text(grid, PLACE, WH_INK_PLAIN, "%s %s", station, field->value);
    }
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; ++i) {
        if (strcmp(field->name, numbers[i]) == 0) {
            wh_grid_number(grid, FIRST_NUMBER + i, WH_INK_PLAIN, strtod(field->value, NULL));
        }
    }
}

/* One row of the grid; returns where the row's text ends. */
static const char *put_row(wh_grid_t *grid, const char *at, char *value, char *station) {
    field_t field = {.value = value};
    const char *next = at;
    station[0] = '\0';
    wh_grid_row(grid);
    while ((next = read_field(at, &field)) != NULL) {
        const bool quoted = next > at && next[-1] == '"';
        put_field(grid, &field, quoted ? "" : field.value, station);
        at = next;
    }
    return at;
}

/* True if the first row goes on with the wafer's holder: no other answer does. `value` has room for the
 * answer. */
static bool is_where(const char *at, char *value) {
    static const char holder[] = " holder=";
    return is_wafer(at) && strncmp(read_value(strchr(at, '=') + 1, value), holder, sizeof holder - 1) == 0;
}

bool wh_answer_print_wafers(const char *answer, const wh_style_t *style, FILE *out) {
    const char *at = strncmp(answer, "OK ", 3) == 0 ? answer + 3 : "";
    const size_t room = strlen(answer) + 1;
    char *value = wh_array_new(room, 1);
    if (!is_where(at, value)) {
        free(value);
        return false;
    }
    char *station = wh_array_new(room, 1);
    wh_grid_t *grid =
        wh_grid_new(style, 1, "wafer;held by;lies in;dX mm{4};+dY mm{4};+dz mm{4};+tilt deg{3}");
    while (is_wafer(at)) {
        at = put_row(grid, at, value, station);
        at += strspn(at, "; ");
    }
    wh_grid_print(grid, out);
    if (*at != '\0') {
        fprintf(out, "%s\n", at);
    }
    free(station);
    free(value);
    return true;
}
