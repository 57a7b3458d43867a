/* The convex hull of points, grown point by point, for showing a mesh. Our own code, so that the triangles
 * are the same on every machine: a library's choice among faces in one plane depends on how it was
 * compiled. */
#include <stdlib.h>

#include "../math/trig.h"
#include "../text/array.h"
#include "mesh.h"

#define MOST_POINTS 512
#define AROUND                                                                                               \
    32 /* directions about z, and from pole to pole, in which points are sought when there are more */
#define UP 16

/* A point must be outside a face by this share of the hull's size to count as outside. */
#define FLAT 1e-7

typedef struct {
    size_t corners[3];
    wh_vec3_t normal; /* of length 1, outward */
    double offset;    /* normal . corner */
    bool is_seen;     /* from the point that is being added */
} face_t;

typedef struct {
    wh_vec3_t points[MOST_POINTS];
    size_t count;
    face_t *faces;
    size_t face_count, face_capacity;
    wh_vec3_t inside;
    double flat;
} hull_t;

/* ------------------------------------------------------------------------------------------------- points */

static void take(hull_t *hull, const wh_vec3_t *point) {
    bool is_new = hull->count < MOST_POINTS;
    for (size_t i = 0; is_new && i < hull->count; ++i) {
        const wh_vec3_t way = wh_vec3_subtract(&hull->points[i], point);
        is_new = wh_vec3_dot(&way, &way) > 0;
    }
    if (is_new) {
        hull->points[hull->count++] = *point;
    }
}

static void take_outermost(hull_t *hull, const wh_convex_t *convex) {
    const wh_pose_t here = wh_pose_identity();
    for (int up = 0; up <= UP; ++up) {
        for (int around = 0; around < AROUND; ++around) {
            double sine, cosine, high, wide;
            wh_sin_cos_deg(360.0 * around / AROUND, &sine, &cosine);
            wh_sin_cos_deg(180.0 * up / UP - 90, &high, &wide);
            const wh_vec3_t point =
                wh_convex_support(convex, &here, wh_vec3(wide * cosine, wide * sine, high));
            take(hull, &point);
        }
    }
}

static void take_points(hull_t *hull, const wh_convex_t *convex) {
    if (convex->point_count > MOST_POINTS) {
        take_outermost(hull, convex);
        return;
    }
    for (size_t i = 0; i < convex->point_count; ++i) {
        take(hull, &convex->points[i]);
    }
}

/* -------------------------------------------------------------------------------------------------- faces */

static void add_face(hull_t *hull, size_t a, size_t b, size_t c) {
    const wh_vec3_t ab = wh_vec3_subtract(&hull->points[b], &hull->points[a]);
    const wh_vec3_t ac = wh_vec3_subtract(&hull->points[c], &hull->points[a]);
    face_t face = {.corners = {a, b, c}, .normal = wh_vec3_cross(&ab, &ac)};
    const double length = wh_vec3_norm(&face.normal);
    face.normal = wh_vec3_scale(length > 0 ? 1 / length : 0, &face.normal);
    face.offset = wh_vec3_dot(&face.normal, &hull->points[a]);
    if (wh_vec3_dot(&face.normal, &hull->inside) > face.offset) {
        face.corners[1] = c;
        face.corners[2] = b;
        face.normal = wh_vec3_scale(-1, &face.normal);
        face.offset = -face.offset;
    }
    hull->faces = wh_array_grow(hull->faces, hull->face_count, &hull->face_capacity, sizeof *hull->faces);
    hull->faces[hull->face_count++] = face;
}

static bool has_edge(const face_t *face, size_t from, size_t to) {
    for (size_t i = 0; i < 3; ++i) {
        if (face->corners[i] == from && face->corners[(i + 1) % 3] == to) {
            return true;
        }
    }
    return false;
}

/* True if the face on the other side of the edge is not seen. */
static bool is_horizon(const hull_t *hull, size_t faces, size_t from, size_t to) {
    for (size_t i = 0; i < faces; ++i) {
        if (hull->faces[i].is_seen && has_edge(&hull->faces[i], to, from)) {
            return false;
        }
    }
    return true;
}

/* Removes the faces that the point sees. New faces join the point to the edges around them. */
static void add_point(hull_t *hull, size_t point) {
    const size_t faces = hull->face_count;
    for (size_t i = 0; i < faces; ++i) {
        face_t *face = &hull->faces[i];
        face->is_seen = wh_vec3_dot(&face->normal, &hull->points[point]) > face->offset + hull->flat;
    }
    for (size_t i = 0; i < faces; ++i) {
        for (size_t edge = 0; hull->faces[i].is_seen && edge < 3; ++edge) {
            const size_t from = hull->faces[i].corners[edge];
            const size_t to = hull->faces[i].corners[(edge + 1) % 3];
            if (is_horizon(hull, faces, from, to)) {
                add_face(hull, from, to, point);
            }
        }
    }
    size_t kept = 0;
    for (size_t i = 0; i < hull->face_count; ++i) {
        if (!hull->faces[i].is_seen) {
            hull->faces[kept++] = hull->faces[i];
        }
    }
    hull->face_count = kept;
}

/* -------------------------------------------------------------------------------------------------- start */

/* The distance of point `i` from the point, the line or the plane through the first `known` of `start`. */
static double distance(const hull_t *hull, const size_t start[4], size_t known, size_t i) {
    const wh_vec3_t *first = &hull->points[start[0]];
    const wh_vec3_t to = wh_vec3_subtract(&hull->points[i], first);
    if (known == 1) {
        return wh_vec3_norm(&to);
    }
    const wh_vec3_t along = wh_vec3_subtract(&hull->points[start[1]], first);
    if (known == 2) {
        const wh_vec3_t aside = wh_vec3_cross(&along, &to);
        return wh_vec3_norm(&aside) / wh_vec3_norm(&along);
    }
    const wh_vec3_t across = wh_vec3_subtract(&hull->points[start[2]], first);
    const wh_vec3_t normal = wh_vec3_cross(&along, &across);
    return wh_real_abs(wh_vec3_dot(&normal, &to)) / wh_vec3_norm(&normal);
}

/* Begins with four points that are far from each other. False if all points lie in a plane. */
static bool start(hull_t *hull) {
    size_t corners[4] = {0};
    hull->inside = hull->count > 0 ? hull->points[0] : wh_vec3(0, 0, 0);
    for (size_t known = 1; known < 4; ++known) {
        double farthest = known > 1 ? hull->flat : 0;
        for (size_t i = 0; i < hull->count; ++i) {
            const double far = distance(hull, corners, known, i);
            corners[known] = far > farthest ? i : corners[known];
            farthest = far > farthest ? far : farthest;
        }
        if (corners[known] == 0) {
            return false;
        }
        hull->flat = known == 1 ? FLAT * farthest : hull->flat;
        hull->inside = wh_vec3_add(&hull->inside, &hull->points[corners[known]]);
    }
    hull->inside = wh_vec3_scale(0.25, &hull->inside);
    add_face(hull, corners[0], corners[1], corners[2]);
    add_face(hull, corners[0], corners[1], corners[3]);
    add_face(hull, corners[0], corners[2], corners[3]);
    add_face(hull, corners[1], corners[2], corners[3]);
    return true;
}

void wh_mesh_add_hull(wh_mesh_t *mesh, const wh_convex_t *convex, const wh_pose_t *body_from_shape) {
    hull_t *hull = wh_array_new(1, sizeof *hull);
    take_points(hull, convex);
    const size_t points = start(hull) ? hull->count : 0;
    for (size_t i = 0; i < points; ++i) {
        add_point(hull, i);
    }
    for (size_t i = 0; i < hull->face_count; ++i) {
        wh_vec3_t at[3];
        for (size_t corner = 0; corner < 3; ++corner) {
            at[corner] = wh_pose_point(body_from_shape, &hull->points[hull->faces[i].corners[corner]]);
        }
        wh_mesh_add_triangle(mesh, &at[0], &at[1], &at[2]);
    }
    free(hull->faces);
    free(hull);
}
