/* Reads a Lua table as a description: typed fields with defaults and ranges, and errors that name file, field
 * path, value and what was expected.
 *
 * The table being read is on top of the Lua stack. Every function raises a Lua error on the first thing that
 * is wrong, so a reader holds nothing that would have to be freed. Fields are read raw: no metamethod runs.
 */
#ifndef WH_SCRIPT_READER_H
#define WH_SCRIPT_READER_H

#include <lua.h>

#include "../math/vector.h"

#define WH_READER_DEPTH 8

typedef struct {
    lua_State *L;
    const char *file;
    char path[256]; /* of the table being read, such as stations.A; cut when longer */
    size_t lengths[WH_READER_DEPTH];
    size_t depth;
} wh_reader_t;

/* Starts at the table on top of L's stack. `file` must outlive the reader. */
void wh_reader_start(wh_reader_t *reader, lua_State *L, const char *file);

/* "file: path.field: value (expected ...)", the value being on top of the stack. `field` may be null: the
 * table itself. */
void wh_reader_fail(const wh_reader_t *reader, const char *field, const char *expected, ...)
    __attribute__((noreturn, format(printf, 3, 4)));

/* Refuses every field whose name is not in the space-separated list. Of several the first by name is
 * reported. */
void wh_reader_refuse_unknown(wh_reader_t *reader, const char *known);

/* The length of the list being read; refuses one that has names or gaps, which would be read past. */
size_t wh_reader_list(const wh_reader_t *reader);

/* Whether a text is not empty and without control characters. */
bool wh_reader_is_plain(const char *text, size_t length);

/* Enters the table in a field or list entry, which becomes the table being read; leave with wh_reader_leave.
 * False, and nothing entered, when there is none. */
bool wh_reader_enter(wh_reader_t *reader, const char *field);
bool wh_reader_enter_item(wh_reader_t *reader, lua_Integer index);

/* Enters the table on top of the stack under a name of its own. */
void wh_reader_enter_top(wh_reader_t *reader, const char *name);
void wh_reader_leave(wh_reader_t *reader);

/* A finite number from min to max, ends included; `fallback` when the field is absent, or an error when that
 * is NaN. */
wh_real_t wh_reader_number(wh_reader_t *reader, const char *field, wh_real_t fallback, wh_real_t min,
                           wh_real_t max);

/* The same, a whole number; a fallback below min means that the field is required. */
int32_t wh_reader_whole(wh_reader_t *reader, const char *field, int32_t fallback, int32_t min, int32_t max);

bool wh_reader_boolean(wh_reader_t *reader, const char *field, bool fallback);

/* Three finite numbers of at most 1e6; required when fallback is null. */
wh_vec3_t wh_reader_vector(wh_reader_t *reader, const char *field, const wh_vec3_t *fallback);

/* Text of 1 to size - 1 bytes without control characters; required when fallback is null. */
void wh_reader_text(wh_reader_t *reader, const char *field, const char *fallback, char *text, size_t size);

/* The place (from 0) of the field's text in a null-terminated list of choices; `fallback` when it is absent.
 */
int wh_reader_choice(wh_reader_t *reader, const char *field, int fallback, const char *const choices[]);

#endif
