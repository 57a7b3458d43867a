/* JSON values over jansson: a writer that remembers failures, and how an object is printed. */
#ifndef WH_TEXT_JSON_VALUES_H
#define WH_TEXT_JSON_VALUES_H

#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>

#include "utf8.h"

/* What is being written, and whether any value could not be made. */
typedef struct {
    const void *subject; /* the functions that write know its type */
    bool failed;
} wh_json_writer_t;

/* Set a member, append an element: take the value over, and remember a null one as a failure. */
void wh_json_put(wh_json_writer_t *writer, json_t *object, const char *key, json_t *value);
void wh_json_append(wh_json_writer_t *writer, json_t *list, json_t *value);

/* A number, or null for what JSON has not. */
json_t *wh_json_real(double value);

/* A list of what `element` makes of 0 to count - 1. */
typedef json_t *wh_json_element_t(wh_json_writer_t *writer, size_t i);
json_t *wh_json_list(wh_json_writer_t *writer, wh_json_element_t *element, size_t count);

/* Prints an object: its members a line each and its lists' elements a line each, for grep, diff and the eye. 0, or -1 when
 * `out` does not take it. */
int wh_json_print(json_t *root, FILE *out);

#endif
