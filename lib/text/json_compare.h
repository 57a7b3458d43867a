/* Two JSON documents, member by member: where they differ, and when, in documents that tell times. */
#ifndef WH_TEXT_JSON_COMPARE_H
#define WH_TEXT_JSON_COMPARE_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

/* A place where they differ; true until the call returns. */
typedef struct {
    const char *path;    /* such as wafers[0].dx */
    const json_t *a, *b; /* null: it is not there */
    double time_s;       /* see wh_json_compare; NaN: none */
} wh_json_difference_t;

typedef void wh_json_difference_listener_t(void *user, const wh_json_difference_t *difference);

/* Tells each place where they differ, members in a's order, then those that b alone has. Members whose name
 * is one of `aside` (null ends it) are not looked at, wherever they stand. Numbers are the same if their bits
 * as doubles are, 1 and 1.0 too. Of lists the elements of one place are compared. A place's time is that of
 * the innermost element of a list around it that has one of the members utime (us), t, begin_s or from_s (s)
 * as a number; or that of its own place in the list `t` or `times_s` beside its list, if both are of one
 * length. Of two times the earlier counts. Cost: linear, times the members of an object. */
void wh_json_compare(const json_t *a, const json_t *b, const char *const aside[],
                     wh_json_difference_listener_t *listener, void *user);

#endif
