/* The points that remain of a thinned signal. path.h puts cubics between them, thin.h straight lines. A
 * point has `width` numbers at a slice; points are in the order of their slices.
 *
 * If more than `limit` points are not exact, the tolerance is doubled and they are thinned again. So memory
 * is bounded, except for a signal that jumps without end.
 */
#ifndef WH_RECORD_POINTS_H
#define WH_RECORD_POINTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct {
    int64_t slice;
    bool exact; /* kept for itself, not because of the tolerance */
    bool ends;  /* until the next point there is no signal */
} wh_point_t;

/* Read only. At the beginning zero it, and set width, tolerance and limit. */
typedef struct {
    size_t width;     /* numbers of a point */
    double tolerance; /* of each number, in the number's unit */
    size_t limit;
    wh_point_t *points;
    double *numbers; /* of all points, in their order */
    size_t count, exact_count, capacity, number_capacity;
} wh_points_t;

/* A point's numbers. */
static inline double *wh_points_numbers(const wh_points_t *list, size_t i) {
    return list->numbers + i * list->width;
}

/* Adds a point as number `i`; the points from there on follow it. */
void wh_points_insert(wh_points_t *list, size_t i, int64_t slice, const double numbers[], bool exact);

void wh_points_make_exact(wh_points_t *list, size_t i);

/* The last point at or before the slice, otherwise the first. There must be at least one. Cost: log n. */
size_t wh_points_find(const wh_points_t *list, int64_t slice);

/* The slice of the first point after `slice`, or `end` if that comes before it. `at` counts the points that
 * are passed: 0 at the beginning, for slices that rise from call to call. */
int64_t wh_points_next(const wh_points_t *list, size_t *at, int64_t slice, int64_t end);

/* Calls `thin` while there are too many points, up to three times. It doubles the tolerance of `fit` and
 * leaves fewer points. If that does not help, the limit is doubled; otherwise each further sample would
 * cost a pass over all points. */
void wh_points_keep_to_limit(wh_points_t *list, void (*thin)(void *fit), void *fit);

void wh_points_close(wh_points_t *list);

#endif
