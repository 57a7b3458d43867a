#include "hull.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <libqhull_r/qhull_ra.h>

#include "../text/array.h"

/* libqhull's own array: x, y, z of one point after another. */
static coordT *coordinates_of(const wh_vec3_t points[], size_t count) {
    coordT *numbers = wh_array_new(3 * count, sizeof *numbers);
    for (size_t i = 0; i < count; ++i) {
        numbers[3 * i] = points[i].x;
        numbers[3 * i + 1] = points[i].y;
        numbers[3 * i + 2] = points[i].z;
    }
    return numbers;
}

/* Marks the points that are corners of the hull. */
static void mark_corners(qhT *qh, bool is_corner[]) {
    for (const vertexT *vertex = qh->vertex_list; vertex && vertex->next; vertex = vertex->next) {
        is_corner[qh_pointid(qh, vertex->point)] = true;
    }
}

/* The first line of libqhull's messages. */
static void tell_qhull(const char *said, char *message, size_t size) {
    const size_t length = strcspn(said, "\n");
    (void)snprintf(message, size, "%.*s", (int)length, said);
}

static size_t keep(wh_vec3_t points[], size_t count, const bool is_corner[]) {
    size_t kept = 0;
    for (size_t i = 0; i < count; ++i) {
        if (is_corner[i]) {
            points[kept++] = points[i];
        }
    }
    return kept;
}

/* False if libqhull refuses; its message goes to `said`. */
static bool find_corners(coordT *numbers, size_t count, bool is_corner[], FILE *said) {
    static char options[] = "qhull Qt"; /* not const for libqhull, which only reads it */
    qhT state;
    qhT *qh = &state;
    int left = 0;
    int blocks = 0;
    qh_zero(qh, said);
    const bool good = qh_new_qhull(qh, 3, (int)count, numbers, False, options, NULL, said) == 0;
    if (good) {
        mark_corners(qh, is_corner);
    }
    qh_freeqhull(qh, !qh_ALL);
    qh_memfreeshort(qh, &left, &blocks);
    return good;
}

bool wh_hull_reduce(wh_vec3_t points[], size_t *count, char *message, size_t size) {
    if (*count < 4) {
        (void)snprintf(message, size, "%zu points have no hull", *count);
        return false;
    }
    char *text = NULL;
    size_t length = 0;
    FILE *said = wh_memory_need(open_memstream(&text, &length));
    coordT *numbers = coordinates_of(points, *count);
    bool *is_corner = wh_array_new(*count, sizeof *is_corner);
    memset(is_corner, 0, *count * sizeof *is_corner);
    const bool good = find_corners(numbers, *count, is_corner, said);
    (void)fclose(said);
    if (good) {
        *count = keep(points, *count, is_corner);
    } else {
        tell_qhull(text, message, size);
    }
    free(text);
    free(numbers);
    free(is_corner);
    return good;
}
