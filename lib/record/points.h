/* The points that remain of a thinned signal. path.h lays cubics between them, thin.h straight lines. A point
 * has `width` numbers at a slice; points are in the order of their slices.
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
    bool exact; /* on purpose, not for the tolerance's sake */
    bool ends;  /* until the next point there is no signal */
} wh_point_t;

/* Read only. Zero it, and set width, tolerance and limit, to begin with. */
typedef struct {
    size_t width;     /* numbers of a point */
    double tolerance; /* of each number, in its unit */
    size_t limit;
    wh_point_t *points;
    double *numbers; /* of all points, in their order */
    size_t count, exact_count, capacity, number_capacity;
} wh_points_t;

/* A point's numbers. */
static inline double *wh_points_numbers(const wh_points_t *list, size_t i) {
    return list->numbers + i * list->width;
}

/* A new point, which becomes number `i`; those from there on follow it. */
void wh_points_insert(wh_points_t *list, size_t i, int64_t slice, const double numbers[], bool exact);

void wh_points_make_exact(wh_points_t *list, size_t i);

/* The last point at or before the slice, else the first. There is one at least. Cost: log n. */
size_t wh_points_find(const wh_points_t *list, int64_t slice);

/* The slice of the first point after `slice`, or `end` if that comes before it. `at` counts the points that
 * were passed: 0 to begin with, for slices that rise from call to call. */
int64_t wh_points_next(const wh_points_t *list, size_t *at, int64_t slice, int64_t end);

/* Calls `thin`, which doubles the tolerance of `fit` and leaves fewer points, up to three times while there
 * are too many. If that does not help the limit is doubled, or each further sample would cost a pass over all
 * points. */
void wh_points_keep_to_limit(wh_points_t *list, void (*thin)(void *fit), void *fit);

void wh_points_close(wh_points_t *list);

#endif
