/* JSON written as it comes: for long lists of numbers, of which each has the digits that it needs and no more.
 *
 * What is written is safe within an HTML page: every '<' is escaped.
 */
#ifndef WH_TEXT_JSON_TEXT_H
#define WH_TEXT_JSON_TEXT_H

#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>

/* Zero but for `out` to begin with. Commas are set by themselves. */
typedef struct {
    FILE *out;
    bool follows; /* something stands before in the same list or object */
    bool failed;
} wh_json_text_t;

/* Begins an object or list, '{' or '[', as an element or, with a key, as a member; and ends it. */
void wh_json_text_begin(wh_json_text_t *text, const char *key, char bracket);
void wh_json_text_end(wh_json_text_t *text, char bracket);

/* A number, rounded to so many decimals (at most 9) unless it is to be read back as the same double; null where JSON has
 * none. `key` may be null. */
void wh_json_text_number(wh_json_text_t *text, const char *key, double value, int decimals, bool exact);

/* A whole number, a text (null: null), or any value of jansson's, which is released. */
void wh_json_text_integer(wh_json_text_t *text, const char *key, long long value);
void wh_json_text_string(wh_json_text_t *text, const char *key, const char *value);
void wh_json_text_value(wh_json_text_t *text, const char *key, json_t *value);

#endif
