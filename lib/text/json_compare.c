#include "json_compare.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define PATH_BYTES 400

typedef struct {
    const char *const *aside;
    wh_json_difference_listener_t *listener;
    void *user;
    char path[PATH_BYTES];
} comparison_t;

static void compare(comparison_t *all, const json_t *a, const json_t *b, double time_s);

/* ------------------------------------------------------------------------------------------------- times */

static double earlier(double a, double b) {
    return isnan(a) || b < a ? b : a;
}

/* The time in an object itself; otherwise the one around it. */
static double own_time(const json_t *object, double around) {
    static const struct {
        const char *name;
        double factor;
    } members[] = {{"utime", 1e-6}, {"t", 1}, {"begin_s", 1}, {"from_s", 1}};
    for (size_t i = 0; i < sizeof members / sizeof members[0]; ++i) {
        const json_t *value = json_object_get(object, members[i].name);
        if (json_is_number(value)) {
            return members[i].factor * json_number_value(value);
        }
    }
    return around;
}

/* The times of a list's elements, if its object has them: a list of equal length beside it. */
static const json_t *times_beside(const json_t *object, const json_t *list) {
    const json_t *t = json_object_get(object, "t");
    const json_t *times = json_is_array(t) ? t : json_object_get(object, "times_s");
    return json_is_array(times) && json_array_size(times) == json_array_size(list) ? times : NULL;
}

/* ------------------------------------------------------------------------------------------------- values */

static void tell_difference(comparison_t *all, const json_t *a, const json_t *b, double time_s) {
    const wh_json_difference_t difference = {all->path, a, b, time_s};
    all->listener(all->user, &difference);
}

/* Zeros of both signs are different numbers; JSON has no NaN. */
static bool is_same_number(const json_t *a, const json_t *b) {
    const double first = json_number_value(a);
    const double second = json_number_value(b);
    if (json_is_integer(a) && json_is_integer(b)) {
        return json_integer_value(a) == json_integer_value(b);
    }
    return !(first < second) && !(first > second) && !signbit(first) == !signbit(second);
}

static bool is_aside(const comparison_t *all, const char *name) {
    bool found = false;
    for (const char *const *aside = all->aside; *aside; ++aside) {
        found = found || strcmp(*aside, name) == 0;
    }
    return found;
}

/* Goes one step down the path; returns its length before. */
static size_t go(comparison_t *all, const char *name, size_t index) {
    const size_t length = strlen(all->path);
    if (name) {
        (void)snprintf(all->path + length, sizeof all->path - length, "%s%s", length > 0 ? "." : "", name);
    } else {
        (void)snprintf(all->path + length, sizeof all->path - length, "[%zu]", index);
    }
    return length;
}

/* Compares a list with its times; null times: it has none. */
static void compare_lists(comparison_t *all, const json_t *a, const json_t *b, const json_t *times[2],
                          double around) {
    const size_t counts[2] = {json_array_size(a), json_array_size(b)};
    for (size_t i = 0; i < counts[0] || i < counts[1]; ++i) {
        const size_t length = go(all, NULL, i);
        double time_s = (double)NAN;
        for (size_t side = 0; side < 2; ++side) {
            const json_t *time = times[side] ? json_array_get(times[side], i) : NULL;
            time_s = json_is_number(time) ? earlier(time_s, json_number_value(time)) : time_s;
        }
        compare(all, json_array_get(a, i), json_array_get(b, i), isnan(time_s) ? around : time_s);
        all->path[length] = '\0';
    }
}

static void compare_members(comparison_t *all, const json_t *from[2], const char *name, double time_s) {
    const json_t *a = json_object_get(from[0], name);
    const json_t *b = json_object_get(from[1], name);
    const size_t length = go(all, name, 0);
    if (json_is_array(a) && json_is_array(b)) {
        const json_t *times[2] = {times_beside(from[0], a), times_beside(from[1], b)};
        compare_lists(all, a, b, times, time_s);
    } else {
        compare(all, a, b, time_s);
    }
    all->path[length] = '\0';
}

/* jansson's iterators require a pointer without const to data that they do not change. */
static json_t *plain(const json_t *value) {
    union {
        const json_t *constant;
        json_t *plain;
    } cast = {value};
    return cast.plain;
}

/* A document's own begin is not the time of its members: only an element of a list has a time. */
static bool is_element(const comparison_t *all) {
    const size_t length = strlen(all->path);
    return length > 0 && all->path[length - 1] == ']';
}

static void compare_objects(comparison_t *all, const json_t *a, const json_t *b, double around) {
    const json_t *from[2] = {a, b};
    const double time_s = is_element(all) ? earlier(own_time(a, around), own_time(b, around)) : around;
    for (size_t side = 0; side < 2; ++side) {
        json_t *object = plain(from[side]);
        for (void *at = json_object_iter(object); at; at = json_object_iter_next(object, at)) {
            const char *name = json_object_iter_key(at);
            const bool is_told = side == 1 && json_object_get(a, name);
            if (!is_told && !is_aside(all, name)) {
                compare_members(all, from, name, time_s);
            }
        }
    }
}

/* Two values that have no members. */
static bool is_same(const json_t *a, const json_t *b) {
    if (!a || !b) {
        return false;
    }
    return json_is_number(a) && json_is_number(b) ? is_same_number(a, b) : json_equal(a, b) != 0;
}

static void compare(comparison_t *all, const json_t *a, const json_t *b, double time_s) {
    const json_t *none[2] = {NULL, NULL};
    const json_t *there = a ? a : b;
    if (json_is_object(a) && json_is_object(b)) {
        compare_objects(all, a, b, time_s);
    } else if (json_is_array(a) && json_is_array(b)) {
        compare_lists(all, a, b, none, time_s);
    } else if (!is_same(a, b)) {
        tell_difference(all, a, b,
                        json_is_object(there) && is_element(all) ? own_time(there, time_s) : time_s);
    }
}

void wh_json_compare(const json_t *a, const json_t *b, const char *const aside[],
                     wh_json_difference_listener_t *listener, void *user) {
    comparison_t all = {.aside = aside, .listener = listener, .user = user};
    compare(&all, a, b, (double)NAN);
}
