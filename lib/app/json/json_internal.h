/* Within the JSON report: values, and its parts. */
#ifndef WH_APP_JSON_JSON_INTERNAL_H
#define WH_APP_JSON_JSON_INTERNAL_H

#include <jansson.h>
#include <stdio.h>

#include "report/utf8.h"
#include "script/record.h"

/* What is being written, and whether any value could not be made. */
typedef struct {
    const wh_record_t *record;
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

/* How the smallest gaps went over time: clearance_curves among the lists, for the kinds that were ever near. */
void wh_json_put_curves(wh_json_writer_t *writer, json_t *root);

/* The figures: throughput and split in the head; cycles, gantt and reach among the lists; a command's split. */
void wh_json_put_sums(wh_json_writer_t *writer, json_t *root);
void wh_json_put_figures(wh_json_writer_t *writer, json_t *root);
json_t *wh_json_split(wh_json_writer_t *writer, const int64_t shares[WH_SHARES]);

#endif
