/* JSON over jansson: values that are made and printed as a whole, and long lists that are written at once.
 *
 * It ends the program if out of memory.
 */
#ifndef WH_TEXT_JSON_H
#define WH_TEXT_JSON_H

#include <jansson.h>
#include <limits.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "../math/vector.h"

/* ------------------------------------------------------------------------------------------------- values */

/* These set a member of an object, and append an element to a list. Both take the value over. */
void wh_json_put(json_t *object, const char *key, json_t *value);
void wh_json_append(json_t *list, json_t *value);

/* A number; null for infinities and NaN, which JSON does not have. */
json_t *wh_json_real(double value);

/* A hash or an identity: 16 hex digits as a text. */
json_t *wh_json_hash(uint64_t value);

/* A text, with U+FFFD for each byte that is not UTF-8; null for null. */
json_t *wh_json_text(const char *text);

/* A vector as a list of its numbers, a matrix as a list of its rows. */
json_t *wh_json_vector(wh_vec3_t v);
json_t *wh_json_matrix(const wh_mat3_t *m);

/* Adds members by their names and printf's conversions of their values, which the compiler checks: %g is a
 * number as in wh_json_real, %s a text as in wh_json_text, %d and %lld are whole numbers with WH_JSON_NONE
 * as null, %i is true or false, and %llx a text of 16 digits. Returns the object.
 *
 *     return wh_json_set(json_object(), "line %d text %s ok %i", line, text, ok);
 */
#define WH_JSON_NONE LLONG_MIN
__attribute__((format(printf, 2, 3))) json_t *wh_json_set(json_t *object, const char *members, ...);

/* Adds members of any kind: their names, separated by blanks, and as many values, which it takes over. Null
 * ends the values. Returns the object.
 *
 *     return wh_json_add(json_object(), "at rotation", wh_json_vector(at), wh_json_matrix(&turn), NULL);
 */
__attribute__((sentinel)) json_t *wh_json_add(json_t *object, const char *keys, ...);

/* A list of the results of `element` for 0 to count - 1; `subject` is its data. Null results are left
 * out. */
typedef json_t *wh_json_element_t(const void *subject, size_t i);
json_t *wh_json_list(wh_json_element_t *element, const void *subject, size_t count);

/* Prints an object for grep, diff and people: each of its members on a line, and each element of its lists.
 * Numbers get up to 17 digits. Returns 0, or -1 if `out` does not take it. */
int wh_json_print(json_t *root, FILE *out);

/* -------------------------------------------------------------------------------------------- as it comes */

/* At the beginning all is zero except `out`. Commas are written automatically. */
typedef struct {
    FILE *out;
    bool follows; /* an element comes before in the same list or object */
    bool failed;
} wh_json_text_t;

/* Begins an object or list, '{' or '[', as an element or, with a key, as a member; and ends it. */
void wh_json_text_begin(wh_json_text_t *text, const char *key, char bracket);
void wh_json_text_end(wh_json_text_t *text, char bracket);

/* Writes a number; null for infinities and NaN. If exact, it has the fewest digits that read back as an
 * equal double; otherwise it is rounded to `decimals`, at most 9. `key` may be null. */
void wh_json_text_number(wh_json_text_t *text, const char *key, double value, int decimals, bool exact);

/* A whole number, a text (null: null), or any value of jansson's, which is released. */
void wh_json_text_integer(wh_json_text_t *text, const char *key, long long value);
void wh_json_text_string(wh_json_text_t *text, const char *key, const char *value);
void wh_json_text_value(wh_json_text_t *text, const char *key, json_t *value);

#endif
