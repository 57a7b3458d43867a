/* Compares two JSON documents, member by member: finds the places where they differ, and their times in
 * documents that have times. */
#ifndef WH_TEXT_JSON_COMPARE_H
#define WH_TEXT_JSON_COMPARE_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

/* A place where they differ; it is valid until the call returns. */
typedef struct {
    const char *path;    /* such as wafers[0].dx */
    const json_t *a, *b; /* null: it does not exist */
    double time_s;       /* see wh_json_compare; NaN: none */
} wh_json_difference_t;

typedef void wh_json_difference_listener_t(void *user, const wh_json_difference_t *difference);

/* Reports each place where they differ: members in a's order, then those that only b has. Members with a
 * name in `aside` (null ends it) are ignored everywhere. Numbers are equal if their bits as doubles are,
 * also 1 and 1.0. In lists the elements of one place are compared. A place's time comes from the innermost
 * list element around it that has one of the members utime (us), t, begin_s or from_s (s) as a number. It
 * may also come from its place in the list `t` or `times_s` beside its list, if both have one length. The
 * earlier of two times counts. Cost: linear, times the members of an object. */
void wh_json_compare(const json_t *a, const json_t *b, const char *const aside[],
                     wh_json_difference_listener_t *listener, void *user);

#endif
