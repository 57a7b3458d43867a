#include "outline.h"

#include <stdlib.h>
#include <string.h>

#include "../math/trig.h"
#include "../text/array.h"

#define CIRCLE_CORNERS 48

wh_spot_t wh_outline_spot(wh_projection_t view, wh_vec3_t r) {
    const wh_spot_t spot = {(double)r.x, -(double)(view == WH_VIEW_TOP ? r.y : r.z)};
    return spot;
}

/* ------------------------------------------------------------------------------------------------- points */

static void add(wh_outline_t *outline, wh_projection_t view, const wh_pose_t *base_from_shape,
                wh_vec3_t point) {
    const wh_vec3_t turned = wh_mat3_transform(&base_from_shape->R, &point);
    outline->spots[outline->count++] = wh_outline_spot(view, wh_vec3_add(&turned, &base_from_shape->r));
}

static void add_box(wh_outline_t *outline, wh_projection_t view, const wh_convex_t *convex,
                    const wh_pose_t *pose) {
    for (unsigned i = 0; i < 8; ++i) {
        const wh_vec3_t corner = {i & 1U ? convex->half.x : -convex->half.x,
                                  i & 2U ? convex->half.y : -convex->half.y,
                                  i & 4U ? convex->half.z : -convex->half.z};
        add(outline, view, pose, corner);
    }
}

static void add_cylinder(wh_outline_t *outline, wh_projection_t view, const wh_convex_t *convex,
                         const wh_pose_t *pose) {
    for (int i = 0; i < CIRCLE_CORNERS; ++i) {
        wh_real_t sine, cosine;
        wh_sin_cos_deg(WH_REAL(360.0) * i / CIRCLE_CORNERS, &sine, &cosine);
        const wh_vec3_t top = {convex->half.x * cosine, convex->half.x * sine, convex->half.z};
        const wh_vec3_t bottom = {top.x, top.y, -top.z};
        add(outline, view, pose, top);
        add(outline, view, pose, bottom);
    }
}

/* The two balls of a capsule: each is the same circle from every side. */
static void add_capsule(wh_outline_t *outline, wh_projection_t view, const wh_convex_t *convex,
                        const wh_pose_t *pose) {
    const wh_vec3_t axis = wh_mat3_column(&pose->R, 2);
    for (int end = -1; end <= 1; end += 2) {
        const wh_vec3_t way = wh_vec3_scale(end * convex->half.z, &axis);
        const wh_spot_t centre = wh_outline_spot(view, wh_vec3_add(&pose->r, &way));
        for (int i = 0; i < CIRCLE_CORNERS; ++i) {
            wh_real_t sine, cosine;
            wh_sin_cos_deg(WH_REAL(360.0) * i / CIRCLE_CORNERS, &sine, &cosine);
            wh_spot_t *spot = &outline->spots[outline->count++];
            spot->x = centre.x + (double)(convex->half.x * cosine);
            spot->y = centre.y + (double)(convex->half.x * sine);
        }
    }
}

static void add_points(wh_outline_t *outline, wh_projection_t view, const wh_convex_t *convex,
                       const wh_pose_t *pose) {
    switch (convex->kind) {
    case WH_CONVEX_BOX:
        add_box(outline, view, convex, pose);
        break;
    case WH_CONVEX_CYLINDER:
        add_cylinder(outline, view, convex, pose);
        break;
    case WH_CONVEX_CAPSULE:
        add_capsule(outline, view, convex, pose);
        break;
    case WH_CONVEX_MESH:
        for (size_t i = 0; i < convex->point_count; ++i) {
            add(outline, view, pose, convex->points[i]);
        }
        break;
    }
}

/* --------------------------------------------------------------------------------------------------- hull */

static int compare(const void *a, const void *b) {
    const wh_spot_t *one = a;
    const wh_spot_t *two = b;
    if (one->x != two->x) {
        return one->x < two->x ? -1 : 1;
    }
    return (one->y > two->y) - (one->y < two->y);
}

/* True if the way from a over b to c turns right or goes straight on. */
static bool turns_not(const wh_spot_t *a, const wh_spot_t *b, const wh_spot_t *c) {
    return (b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x) <= 0;
}

static size_t push(wh_spot_t *hull, size_t count, size_t base, wh_spot_t spot) {
    while (count >= base + 2 && turns_not(&hull[count - 2], &hull[count - 1], &spot)) {
        --count;
    }
    hull[count] = spot;
    return count + 1;
}

/* Andrew's monotone chain: along the sorted spots for the lower side, and back for the upper one. The hull is
 * built behind the spots. */
static void keep_hull(wh_outline_t *outline) {
    const size_t count = outline->count;
    wh_spot_t *spots = outline->spots;
    wh_spot_t *hull = spots + count;
    qsort(spots, count, sizeof *spots, compare);
    size_t size = 0;
    for (size_t i = 0; i < count; ++i) {
        size = push(hull, size, 0, spots[i]);
    }
    const size_t lower = size - 1;
    for (size_t i = count - 1; i > 0; --i) {
        size = push(hull, size, lower, spots[i - 1]);
    }
    outline->count = size > 1 ? size - 1 : size;
    memmove(spots, hull, outline->count * sizeof *spots);
}

void wh_outline_draw(wh_outline_t *outline, wh_projection_t view, const wh_convex_t *convex,
                     const wh_pose_t *base_from_shape) {
    const size_t points = convex->kind == WH_CONVEX_MESH ? convex->point_count : 2 * (size_t)CIRCLE_CORNERS;
    const size_t needed = 3 * points + 2; /* the spots, and a hull that visits each of them twice at most */
    outline->spots = wh_array_reserve(outline->spots, needed, &outline->capacity, sizeof *outline->spots);
    outline->count = 0;
    add_points(outline, view, convex, base_from_shape);
    keep_hull(outline);
}

void wh_outline_free(wh_outline_t *outline) {
    free(outline->spots);
    memset(outline, 0, sizeof *outline);
}
