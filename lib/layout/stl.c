#include "stl.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stl_internal.h"

/* What the numbers of a file are rounded to, in parts of the largest: seven digits, or a single float. */
static const wh_real_t file_digits = 1e-6;

typedef struct {
    wh_real_t size, coordinate;
} extent_t;

bool wh_stl_refuse(wh_stl_t *stl, const char *format, ...) {
    const int length = snprintf(stl->message, stl->message_size, "%s", stl->path);
    if (length >= 0 && (size_t)length < stl->message_size) {
        va_list arguments;
        va_start(arguments, format);
        (void)vsnprintf(stl->message + length, stl->message_size - (size_t)length, format, arguments);
        va_end(arguments);
    }
    return false;
}

/* -------------------------------------------------------------------------------------------------- the points */

static wh_real_t larger(wh_real_t a, wh_real_t b) {
    return a > b ? a : b;
}

static int compare_numbers(wh_real_t a, wh_real_t b) {
    return (a > b) - (a < b);
}

static int compare(const void *left, const void *right) {
    const wh_vec3_t *a = left;
    const wh_vec3_t *b = right;
    int order = compare_numbers(a->x, b->x);
    order = order != 0 ? order : compare_numbers(a->y, b->y);
    return order != 0 ? order : compare_numbers(a->z, b->z);
}

/* The different ones of the corners, sorted, in memory of their own; null when there is none. */
static wh_vec3_t *different(const wh_vec3_t *corners, size_t corner_count, size_t *count) {
    wh_vec3_t *points = malloc((corner_count + 1) * sizeof *points);
    if (points == NULL) {
        return NULL;
    }
    if (corner_count > 0) {
        memcpy(points, corners, corner_count * sizeof *points);
        qsort(points, corner_count, sizeof *points, compare);
    }
    *count = 0;
    for (size_t i = 0; i < corner_count; ++i) {
        if (*count == 0 || compare(&points[*count - 1], &points[i]) != 0) {
            points[(*count)++] = points[i];
        }
    }
    return points;
}

/* The longest edge of the box around them, and their largest coordinate. */
static extent_t extent_of(const wh_vec3_t *points, size_t count) {
    const wh_convex_t mesh = {.kind = WH_CONVEX_MESH, .points = points, .point_count = count};
    const wh_pose_t here = wh_pose_identity();
    wh_vec3_t low;
    wh_vec3_t high;
    wh_convex_bounds(&mesh, &here, &low, &high);
    const wh_real_t from[3] = {low.x, low.y, low.z};
    const wh_real_t to[3] = {high.x, high.y, high.z};
    extent_t extent = {0, 0};
    for (size_t i = 0; i < 3; ++i) {
        extent.size = larger(extent.size, to[i] - from[i]);
        extent.coordinate = larger(extent.coordinate, larger(-from[i], to[i]));
    }
    return extent;
}

/* The unit normal of a facet, and how high it stands on its longest edge; 0 for one that has no normal. */
static wh_real_t normal_of(const wh_vec3_t *corners, wh_vec3_t *normal) {
    const wh_vec3_t ab = wh_vec3_subtract(&corners[1], &corners[0]);
    const wh_vec3_t ac = wh_vec3_subtract(&corners[2], &corners[0]);
    const wh_vec3_t bc = wh_vec3_subtract(&corners[2], &corners[1]);
    *normal = wh_vec3_cross(&ab, &ac);
    const wh_real_t area = wh_vec3_norm(normal);
    if (!(area > 0)) {
        return 0;
    }
    *normal = wh_vec3_scale(1 / area, normal);
    return area / larger(wh_vec3_norm(&ab), larger(wh_vec3_norm(&ac), wh_vec3_norm(&bc)));
}

/* No plane of a facet may have corners on both sides. The thinner the facet, the more the rounding of the file's numbers
 * turns its plane; one that is turned too far tells nothing. */
static bool check_facet(wh_stl_t *stl, size_t facet, const wh_vec3_t *points, size_t count, extent_t extent) {
    const wh_vec3_t *corners = &stl->corners[3 * facet];
    wh_vec3_t normal;
    const wh_real_t height = normal_of(corners, &normal);
    if (!(height > 10 * file_digits * extent.coordinate)) {
        return true;
    }
    const wh_real_t flat = (WH_STL_FLAT + file_digits * extent.coordinate / height) * extent.size;
    wh_real_t before = 0;
    wh_real_t behind = 0;
    for (size_t i = 0; i < count; ++i) {
        const wh_vec3_t from = wh_vec3_subtract(&points[i], &corners[0]);
        before = larger(before, wh_vec3_dot(&from, &normal));
        behind = larger(behind, -wh_vec3_dot(&from, &normal));
    }
    if (before > flat && behind > flat) {
        return wh_stl_refuse(
            stl,
            ": facet %zu has corners %g and %g mm off its plane, on either side (expected a convex body)",
            facet + 1, before, behind);
    }
    return true;
}

static bool check(wh_stl_t *stl, const wh_vec3_t *points, size_t count) {
    if (count > WH_STL_POINTS) {
        return wh_stl_refuse(stl, ": %zu different corners (expected at most %d)", count, WH_STL_POINTS);
    }
    const wh_convex_t mesh = {.kind = WH_CONVEX_MESH,
                              .points = points,
                              .point_count = count,
                              .body_from_shape = wh_pose_identity()};
    if (wh_convex_validate(&mesh) != WH_OK) {
        return wh_stl_refuse(
            stl, ": %zu facets with %zu different corners (expected a body, at least %g mm thick)",
            stl->facets, count, WH_CONVEX_THINNEST);
    }
    const extent_t extent = extent_of(points, count);
    for (size_t facet = 0; facet < stl->facets; ++facet) {
        if (!check_facet(stl, facet, points, count, extent)) {
            return false;
        }
    }
    return true;
}

/* ------------------------------------------------------------------------------------------------------ the file */

static bool parse(wh_stl_t *stl, wh_vec3_t **points, size_t *count) {
    if (!wh_stl_read_facets(stl)) {
        return false;
    }
    size_t found = 0;
    wh_vec3_t *mine = different(stl->corners, 3 * stl->facets, &found);
    if (mine == NULL) {
        return wh_stl_refuse(stl, ": out of memory");
    }
    if (!check(stl, mine, found)) {
        free(mine);
        return false;
    }
    *points = mine;
    *count = found;
    return true;
}

bool wh_stl_parse(const char *path, const char *bytes, size_t length, wh_real_t mm_per_unit,
                  wh_vec3_t **points, size_t *count, char *message, size_t size) {
    wh_stl_t stl = {.path = path,
                    .at = bytes,
                    .end = bytes + length,
                    .begin = bytes,
                    .line = 1,
                    .mm_per_unit = mm_per_unit,
                    .message = message,
                    .message_size = size};
    if (!(mm_per_unit > 0 && wh_real_is_finite(mm_per_unit))) {
        return wh_stl_refuse(&stl, ": %g mm a unit (expected a positive number)", mm_per_unit);
    }
    if (length > WH_STL_BYTES) {
        return wh_stl_refuse(&stl, ": more than %zu bytes", WH_STL_BYTES);
    }
    stl.corners = malloc(3 * (size_t)WH_STL_FACETS * sizeof *stl.corners);
    if (stl.corners == NULL) {
        return wh_stl_refuse(&stl, ": out of memory");
    }
    const bool good = parse(&stl, points, count);
    free(stl.corners);
    return good;
}

bool wh_stl_read(const char *path, wh_real_t mm_per_unit, wh_vec3_t **points, size_t *count, char *message,
                 size_t size) {
    wh_stl_t stl = {.path = path, .message = message, .message_size = size};
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return wh_stl_refuse(&stl, ": %s", strerror(errno));
    }
    char *bytes = malloc(WH_STL_BYTES + 1);
    const size_t length = bytes == NULL ? 0 : fread(bytes, 1, WH_STL_BYTES + 1, file);
    bool good = false;
    if (bytes == NULL || ferror(file) != 0) {
        (void)wh_stl_refuse(&stl, ": %s", strerror(errno));
    } else {
        good = wh_stl_parse(path, bytes, length, mm_per_unit, points, count, message, size);
    }
    free(bytes);
    (void)fclose(file);
    return good;
}
