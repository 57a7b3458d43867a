/* Reads a Lua table as a description: typed fields with defaults and ranges, and errors that name file,
 * field, value and the expected values.
 *
 * The table being read is on top of the Lua stack. Every function raises a Lua error on the first fault, so
 * a reader owns nothing that must be freed. Fields are read raw: no metamethod runs.
 */
#ifndef WH_SCRIPT_READER_H
#define WH_SCRIPT_READER_H

#include <lua.h>

#include "../math/vector.h"
#include "field.h"

#define WH_READER_DEPTH 8

typedef struct {
    lua_State *L;
    const char *file;
    char path[256]; /* of the table being read, such as stations.A; cut if longer */
    size_t lengths[WH_READER_DEPTH];
    /* By depth, the fields' rows; null: they have none. */
    const wh_reader_field_t *known[WH_READER_DEPTH + 1];
    size_t depth;
} wh_reader_t;

/* Starts at the table on top of L's stack. `file` must outlive the reader. */
void wh_reader_start(wh_reader_t *reader, lua_State *L, const char *file);

/* Raises "file: path.field: value (expected ...)" for the value on top of the stack. If `field` is null,
 * the value is the table itself. */
void wh_reader_fail(const wh_reader_t *reader, const char *field, const char *expected, ...)
    __attribute__((noreturn, format(printf, 3, 4)));

/* wh_reader_fail for a text value, which need not be on the stack; null: for what the table being read has
 * in the field. */
void wh_reader_refuse(const wh_reader_t *reader, const char *field, const char *text, const char *expected,
                      ...) __attribute__((noreturn, format(printf, 4, 5)));

/* Refuses every field whose name is not among the `known`. If there are several, the first by name is
 * reported. */
void wh_reader_refuse_unknown(wh_reader_t *reader, const wh_reader_field_t *known);

/* The length of the list being read. A list with names or gaps is refused, because a loop from 1 would miss
 * entries. */
size_t wh_reader_list(const wh_reader_t *reader);

/* True if a text is not empty and has no control characters: see wh_utf8_control_bytes. */
bool wh_reader_is_plain(const char *text, size_t length);

/* Enters the table in a field or a list entry; this table is then read until wh_reader_leave. Returns false
 * if there is none; no table is entered then. */
bool wh_reader_enter(wh_reader_t *reader, const char *field);
bool wh_reader_enter_item(wh_reader_t *reader, lua_Integer index);

/* wh_reader_enter and then, if there is such a table, wh_reader_refuse_unknown. */
bool wh_reader_open(wh_reader_t *reader, const char *field, const wh_reader_field_t *known);

/* wh_reader_open for a table whose fields all have defaults. If there is no such table, an empty one is
 * entered, so that all fields are read as absent. */
void wh_reader_open_section(wh_reader_t *reader, const char *field, const wh_reader_field_t *known);

void wh_reader_leave(wh_reader_t *reader);

/* Pushes a field of the table being read, and returns its Lua type. */
int wh_reader_push(const wh_reader_t *reader, const char *field);

/* True if the table being read has the field. */
bool wh_reader_has(const wh_reader_t *reader, const char *field);

/* A finite number from min to max, ends included. An absent field gives `fallback`, or an error if that is
 * NaN. Where the row's unit is mm or degrees, and the number would fit as metres or radians, the error
 * asks. */
wh_real_t wh_reader_number(wh_reader_t *reader, const char *field, wh_real_t fallback, wh_real_t min,
                           wh_real_t max);

/* wh_reader_number for a whole number. A fallback below min means that the field is required. */
int32_t wh_reader_whole(wh_reader_t *reader, const char *field, int32_t fallback, int32_t min, int32_t max);

bool wh_reader_boolean(wh_reader_t *reader, const char *field, bool fallback);

/* Three finite numbers from -1e6 to 1e6; required if fallback is null. */
wh_vec3_t wh_reader_vector(wh_reader_t *reader, const char *field, const wh_vec3_t *fallback);

/* Text of 1 to size - 1 bytes without control characters; required if fallback is null. */
void wh_reader_text(wh_reader_t *reader, const char *field, const char *fallback, char *text, size_t size);

/* The index (from 0) of the field's text in a null-terminated list of choices; `fallback` if the field is
 * absent. */
int wh_reader_choice(wh_reader_t *reader, const char *field, int fallback, const char *const choices[]);

/* A scalar by its row among the known fields of the table being read, into the struct that the row is
 * about: within the row's range, and without the field the given default. The second takes another range. */
void wh_reader_scalar_from(wh_reader_t *reader, const char *field, void *into, double fallback);
void wh_reader_scalar_within(wh_reader_t *reader, const char *field, void *into, double fallback,
                             double least, double most);

/* The row of a known field of the table being read. */
const wh_reader_field_t *wh_reader_row(const wh_reader_t *reader, const char *field);

/* A scalar whose row has range and default alone: its value, 0 or 1 of a switch, a word's index. Required if
 * the default is NaN. */
double wh_reader_apart(wh_reader_t *reader, const char *field);
double wh_reader_apart_from(wh_reader_t *reader, const char *field, double fallback);

/* All members of the table whose defaults do not follow from other fields. */
void wh_reader_scalars(wh_reader_t *reader, void *into);

#endif
