#include "mesh.h"

#include <stdlib.h>
#include <string.h>

#include "../math/trig.h"
#include "../text/array.h"

#define CORNERS 48
#define RINGS 6 /* rings of half a ball */

static uint32_t add_vertex(wh_mesh_t *mesh, const wh_vec3_t *r, const wh_vec3_t *normal) {
    mesh->vertices =
        wh_array_grow(mesh->vertices, mesh->vertex_count, &mesh->vertex_capacity, sizeof *mesh->vertices);
    const float vertex[6] = {(float)r->x,      (float)r->y,      (float)r->z,
                             (float)normal->x, (float)normal->y, (float)normal->z};
    memcpy(mesh->vertices[mesh->vertex_count], vertex, sizeof vertex);
    return (uint32_t)mesh->vertex_count++;
}

static void add_indices(wh_mesh_t *mesh, uint32_t a, uint32_t b, uint32_t c) {
    const uint32_t corners[3] = {a, b, c};
    for (size_t i = 0; i < 3; ++i) {
        mesh->indices =
            wh_array_grow(mesh->indices, mesh->index_count, &mesh->index_capacity, sizeof *mesh->indices);
        mesh->indices[mesh->index_count++] = corners[i];
    }
}

/* A triangle with a normal of its own, its corners counter-clockwise seen from outside. It adds nothing if
 * the triangle has no area. */
static void add_triangle(wh_mesh_t *mesh, const wh_vec3_t *a, const wh_vec3_t *b, const wh_vec3_t *c) {
    const wh_vec3_t ab = wh_vec3_subtract(b, a);
    const wh_vec3_t ac = wh_vec3_subtract(c, a);
    wh_vec3_t normal = wh_vec3_cross(&ab, &ac);
    const double length = wh_vec3_norm(&normal);
    if (!(length > 0)) {
        return;
    }
    normal = wh_vec3_scale(1 / length, &normal);
    /* The calls come one after the other, because the compiler chooses the order in which a call's
     * arguments are evaluated. */
    const uint32_t first = add_vertex(mesh, a, &normal);
    const uint32_t second = add_vertex(mesh, b, &normal);
    const uint32_t third = add_vertex(mesh, c, &normal);
    add_indices(mesh, first, second, third);
}

static uint32_t add_placed(wh_mesh_t *mesh, const wh_pose_t *pose, const wh_vec3_t *r,
                           const wh_vec3_t *normal) {
    const wh_vec3_t at = wh_pose_point(pose, r);
    const wh_vec3_t turned = wh_mat3_transform(&pose->R, normal);
    return add_vertex(mesh, &at, &turned);
}

/* -------------------------------------------------------------------------------------------------- boxes */

/* The face across axis `axis`, on the side `sign`. */
static void add_face(wh_mesh_t *mesh, const wh_pose_t *pose, const double half[3], int axis, double sign) {
    static const double corners[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    const int second = (axis + 1) % 3;
    const int third = (axis + 2) % 3;
    uint32_t added[4];
    for (size_t i = 0; i < 4; ++i) {
        double r[3];
        double n[3] = {0};
        r[axis] = sign * half[axis];
        r[second] = corners[i][0] * half[second];
        r[third] = corners[i][1] * half[third];
        n[axis] = sign;
        const wh_vec3_t at = {r[0], r[1], r[2]};
        const wh_vec3_t normal = {n[0], n[1], n[2]};
        added[i] = add_placed(mesh, pose, &at, &normal);
    }
    const bool outward = sign > 0;
    add_indices(mesh, added[0], added[outward ? 1 : 2], added[outward ? 2 : 1]);
    add_indices(mesh, added[0], added[outward ? 2 : 3], added[outward ? 3 : 2]);
}

static void add_box(wh_mesh_t *mesh, const wh_convex_t *convex, const wh_pose_t *pose) {
    const double half[3] = {convex->half.x, convex->half.y, convex->half.z};
    for (int axis = 0; axis < 3; ++axis) {
        add_face(mesh, pose, half, axis, 1);
        add_face(mesh, pose, half, axis, -1);
    }
}

/* -------------------------------------------------------------------------------------------------- round */

/* A closed ring of vertices about z. */
static uint32_t add_ring(wh_mesh_t *mesh, const wh_pose_t *pose, double radius, double z, double out,
                         double up) {
    const uint32_t first = (uint32_t)mesh->vertex_count;
    for (int i = 0; i < CORNERS; ++i) {
        double sine, cosine;
        wh_sin_cos_deg(360.0 * i / CORNERS, &sine, &cosine);
        const wh_vec3_t at = {radius * cosine, radius * sine, z};
        const wh_vec3_t normal = {out * cosine, out * sine, up};
        (void)add_placed(mesh, pose, &at, &normal);
    }
    return first;
}

/* The band between a ring and the one above it. */
static void join(wh_mesh_t *mesh, uint32_t lower, uint32_t upper) {
    for (uint32_t i = 0; i < CORNERS; ++i) {
        const uint32_t next = (i + 1) % CORNERS;
        add_indices(mesh, lower + i, lower + next, upper + next);
        add_indices(mesh, lower + i, upper + next, upper + i);
    }
}

static void add_cap(wh_mesh_t *mesh, const wh_pose_t *pose, double radius, double z, double up) {
    const uint32_t ring = add_ring(mesh, pose, radius, z, 0, up);
    for (uint32_t i = 1; i + 1 < CORNERS; ++i) {
        add_indices(mesh, ring, ring + (up > 0 ? i : i + 1), ring + (up > 0 ? i + 1 : i));
    }
}

static void add_cylinder(wh_mesh_t *mesh, const wh_convex_t *convex, const wh_pose_t *pose) {
    const double radius = convex->half.x;
    const double z = convex->half.z;
    const uint32_t lower = add_ring(mesh, pose, radius, -z, 1, 0);
    join(mesh, lower, add_ring(mesh, pose, radius, z, 1, 0));
    add_cap(mesh, pose, radius, -z, -1);
    add_cap(mesh, pose, radius, z, 1);
}

/* Rings from pole to pole. The equator is there twice, with the straight part between. */
static void add_capsule(wh_mesh_t *mesh, const wh_convex_t *convex, const wh_pose_t *pose) {
    uint32_t before = 0;
    for (int i = -RINGS; i <= RINGS + 1; ++i) {
        const int step = i > 0 ? i - 1 : i;
        double sine, cosine;
        wh_sin_cos_deg(90.0 * step / RINGS, &sine, &cosine);
        const double z = convex->half.x * sine + (i > 0 ? convex->half.z : -convex->half.z);
        const uint32_t ring = add_ring(mesh, pose, convex->half.x * cosine, z, cosine, sine);
        if (i > -RINGS) {
            join(mesh, before, ring);
        }
        before = ring;
    }
}

/* -------------------------------------------------------------------------------------------------- hulls */

/* The convex hull of points, grown point by point, for showing a mesh. It is our own code, so that the
 * triangles are equal on every machine: a library's choice among faces in one plane depends on its
 * compilation. */
#define MOST_POINTS 512
/* Directions about z, and from pole to pole, in which points are searched when there are more. */
#define AROUND 32
#define UP 16

/* A point must be outside a face by this share of the hull's size to count as outside. */
#define FLAT 1e-7

typedef struct {
    size_t corners[3];
    wh_vec3_t normal; /* of length 1, outward */
    double offset;    /* normal . corner */
    bool is_seen;     /* from the point being added */
} face_t;

typedef struct {
    wh_vec3_t points[MOST_POINTS];
    size_t count;
    face_t *faces;
    size_t face_count, face_capacity;
    wh_vec3_t inside;
    double flat;
} hull_t;

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

static void add_hull_face(hull_t *hull, size_t a, size_t b, size_t c) {
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

/* True if the face on the other side of the edge is not visible from the point. */
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
                add_hull_face(hull, from, to, point);
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

/* Begins with four points that are far from each other. Returns false if all points lie in a plane. */
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
    add_hull_face(hull, corners[0], corners[1], corners[2]);
    add_hull_face(hull, corners[0], corners[1], corners[3]);
    add_hull_face(hull, corners[0], corners[2], corners[3]);
    add_hull_face(hull, corners[1], corners[2], corners[3]);
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
        add_triangle(mesh, &at[0], &at[1], &at[2]);
    }
    free(hull->faces);
    free(hull);
}

void wh_mesh_add_convex(wh_mesh_t *mesh, const wh_convex_t *convex, const wh_pose_t *body_from_shape) {
    switch (convex->kind) {
    case WH_CONVEX_BOX:
        add_box(mesh, convex, body_from_shape);
        break;
    case WH_CONVEX_CYLINDER:
        add_cylinder(mesh, convex, body_from_shape);
        break;
    case WH_CONVEX_CAPSULE:
        add_capsule(mesh, convex, body_from_shape);
        break;
    case WH_CONVEX_MESH:
        wh_mesh_add_hull(mesh, convex, body_from_shape);
        break;
    }
}

/* ------------------------------------------------------------------------------------------------- wafers */

#define RIM_CORNERS 96

typedef struct {
    double x, y;
} rim_t;

/* The corners of the rim, counter-clockwise: from one side of the notch around the wafer to the other, then
 * the notch's tip. */
static size_t draw_rim(double radius, double notch, double depth, rim_t rim[RIM_CORNERS + 1]) {
    const int notches = depth > 0 ? 1 : 0;
    /* A notch of 90 degrees is as wide as deep on each side. */
    const double half = notches * depth / radius;
    const double whole = 2 * WH_PI - 2 * half;
    for (int i = 0; i < RIM_CORNERS + notches; ++i) {
        const bool is_tip = i == RIM_CORNERS;
        const double out = is_tip ? radius - depth : radius;
        double sine, cosine;
        wh_sin_cos(is_tip ? notch : notch + half + whole * i / (RIM_CORNERS - notches), &sine, &cosine);
        rim[i] = (rim_t){out * cosine, out * sine};
    }
    return (size_t)(RIM_CORNERS + notches);
}

/* A fan about the middle. */
static void add_disc(wh_mesh_t *mesh, const rim_t rim[], size_t count, double z, double up) {
    const wh_vec3_t normal = {0, 0, up};
    const wh_vec3_t middle = {0, 0, z};
    const uint32_t centre = add_vertex(mesh, &middle, &normal);
    for (size_t i = 0; i < count; ++i) {
        const wh_vec3_t at = {rim[i].x, rim[i].y, z};
        (void)add_vertex(mesh, &at, &normal);
    }
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t a = centre + 1 + i;
        const uint32_t b = centre + 1 + (uint32_t)((i + 1) % count);
        add_indices(mesh, centre, up > 0 ? a : b, up > 0 ? b : a);
    }
}

void wh_mesh_add_wafer(wh_mesh_t *mesh, double radius, double thickness, double notch, double depth) {
    rim_t rim[RIM_CORNERS + 1];
    const size_t count = draw_rim(radius, notch, depth, rim);
    add_disc(mesh, rim, count, 0, -1);
    add_disc(mesh, rim, count, thickness, 1);
    for (size_t i = 0; i < count; ++i) {
        const rim_t *a = &rim[i];
        const rim_t *b = &rim[(i + 1) % count];
        const wh_vec3_t corners[4] = {
            {a->x, a->y, 0}, {b->x, b->y, 0}, {b->x, b->y, thickness}, {a->x, a->y, thickness}};
        add_triangle(mesh, &corners[0], &corners[1], &corners[2]);
        add_triangle(mesh, &corners[0], &corners[2], &corners[3]);
    }
}

void wh_mesh_free(wh_mesh_t *mesh) {
    free(mesh->vertices);
    free(mesh->indices);
    memset(mesh, 0, sizeof *mesh);
}
