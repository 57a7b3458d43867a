#include "points.h"

#include <stdlib.h>
#include <string.h>

#include "../text/array.h"

void wh_points_insert(wh_points_t *list, size_t i, int64_t slice, const double numbers[], bool exact) {
    const size_t size = list->width * sizeof *numbers;
    const size_t after = list->count - i;
    list->points = wh_array_grow(list->points, list->count, &list->capacity, sizeof *list->points);
    list->numbers = wh_array_reserve(list->numbers, (list->count + 1) * list->width, &list->number_capacity,
                                     sizeof *list->numbers);
    memmove(&list->points[i + 1], &list->points[i], after * sizeof *list->points);
    memmove(wh_points_numbers(list, i + 1), wh_points_numbers(list, i), after * size);
    list->points[i] = (wh_point_t){slice, exact, false};
    memcpy(wh_points_numbers(list, i), numbers, size);
    ++list->count;
    list->exact_count += exact ? 1 : 0;
}

void wh_points_make_exact(wh_points_t *list, size_t i) {
    list->exact_count += list->points[i].exact ? 0 : 1;
    list->points[i].exact = true;
}

size_t wh_points_find(const wh_points_t *list, int64_t slice) {
    size_t low = 0;
    size_t high = list->count;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (list->points[middle].slice <= slice) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

int64_t wh_points_next(const wh_points_t *list, size_t *at, int64_t slice, int64_t end) {
    while (*at < list->count && list->points[*at].slice <= slice) {
        ++*at;
    }
    return *at < list->count && list->points[*at].slice < end ? list->points[*at].slice : end;
}

void wh_points_keep_to_limit(wh_points_t *list, void (*thin)(void *fit), void *fit) {
    for (int i = 0; i < 3 && list->count - list->exact_count > list->limit; ++i) {
        thin(fit);
    }
    if (list->count - list->exact_count > list->limit) {
        list->limit *= 2;
    }
}

void wh_points_close(wh_points_t *list) {
    free(list->points);
    free(list->numbers);
    memset(list, 0, sizeof *list);
}
