/* The parts that the links of a robot's `urdf` are made of. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../bodies/hull.h"
#include "../bodies/shapes.h"
#include "../bodies/stl.h"
#include "layout_urdf_internal.h"

/* A mesh's path: from the URDF's folder, absolute, or from that of one of the packages. */
static void find_mesh(const wh_reading_urdf_t *urdf, const char *mesh, char *path, size_t size) {
    static const char package[] = "package://";
    static const char file[] = "file://";
    wh_reader_t *reader = urdf->reader;
    const char *rest = mesh + sizeof package - 1;
    const size_t length = strncmp(mesh, package, sizeof package - 1) == 0 ? strcspn(rest, "/") : 0;
    if (length > 0 && length < WH_URDF_NAME && rest[length] == '/') {
        char name[WH_URDF_NAME];
        char folder[512];
        char place[1024];
        (void)snprintf(name, sizeof name, "%.*s", (int)length, rest);
        if (!wh_reader_enter(reader, "packages") || !wh_reader_has(reader, name)) {
            wh_reader_refuse(reader, "urdf", mesh, "packages = { [\"%s\"] = \"FOLDER\" } beside urdf", name);
        }
        wh_reader_text(reader, name, NULL, folder, sizeof folder);
        wh_reader_leave(reader);
        wh_layout_path(place, sizeof place, urdf->layout->path, folder);
        (void)snprintf(path, size, "%s%s", place, rest + length);
    } else if (strncmp(mesh, file, sizeof file - 1) == 0 && mesh[sizeof file - 1] == '/') {
        (void)snprintf(path, size, "%s", mesh + sizeof file - 1);
    } else if (strstr(mesh, "://")) {
        wh_reader_refuse(reader, "urdf", mesh, "a mesh beside %s, file:///PATH or package://NAME/FILE",
                         urdf->path);
    } else {
        wh_layout_path(path, size, urdf->path, mesh);
    }
}

/* A URDF's meshes are in m, times their scale. */
static void read_hull(const wh_reading_urdf_t *urdf, const wh_urdf_shape_t *shape, wh_convex_t *convex) {
    const char *link = urdf->file->links[shape->link].name;
    const wh_vec3_t *s = &shape->scale;
    const wh_real_t largest =
        wh_real_max(wh_real_abs(s->x), wh_real_max(wh_real_abs(s->y), wh_real_abs(s->z)));
    char path[2048];
    char message[512];
    wh_vec3_t *points = NULL;
    size_t count = 0;
    find_mesh(urdf, shape->mesh, path, sizeof path);
    bool good = wh_stl_read_body(path, 1000 * largest, &points, &count, message, sizeof message);
    for (size_t i = 0; good && i < count; ++i) {
        points[i] = wh_vec3(points[i].x * (s->x / largest), points[i].y * (s->y / largest),
                            points[i].z * (s->z / largest));
    }
    good = good && wh_hull_reduce(points, &count, message, sizeof message);
    if (good && count <= WH_STL_POINTS) {
        wh_vec3_t *kept = wh_layout_memory(urdf->reader->L, count, sizeof *kept);
        memcpy(kept, points, count * sizeof *kept);
        convex->points = kept;
        convex->point_count = count;
        free(points);
        return;
    }
    free(points);
    if (good) {
        wh_reader_refuse(urdf->reader, "urdf", shape->mesh,
                         "a hull of at most %d corners for link \"%s\"; it has %zu", WH_STL_POINTS, link,
                         count);
    }
    wh_reader_refuse(urdf->reader, "urdf", shape->mesh, "an STL mesh for link \"%s\": %s", link, message);
}

/* True if a link is called so: "forearm 2". */
static bool is_link(const wh_urdf_file_t *file, const char *link, int number) {
    char name[WH_URDF_NAME + 16];
    bool found = false;
    (void)snprintf(name, sizeof name, "%s %d", link, number);
    for (size_t i = 0; i < file->link_count; ++i) {
        found = found || strcmp(name, file->links[i].name) == 0;
    }
    return found;
}

/* "forearm", and of its other shapes "forearm 2", or "forearm shape 2" where a link is called "forearm 2";
 * "forearm hull" where it is the hull of a mesh; with several robots the robot's name comes first. */
static void add_part(const wh_reading_urdf_t *urdf, wh_part_list_t *list, size_t index,
                     const wh_part_t *part) {
    const wh_urdf_shape_t *shapes = urdf->file->shapes;
    const wh_layout_t *layout = urdf->layout;
    const bool is_one = layout->robot_count < 2;
    const char *link = urdf->file->links[shapes[index].link].name;
    const char *what = part->convex.kind == WH_CONVEX_MESH ? " hull" : "";
    const char *robot = is_one ? "" : layout->robots[urdf->map.robot].name;
    int number = 1;
    for (size_t i = 0; i < index; ++i) {
        number += shapes[i].link == shapes[index].link;
    }
    if (number > 1) {
        wh_shapes_add(list, part, "%s%s%s%s %d%s", robot, is_one ? "" : " ", link,
                      is_link(urdf->file, link, number) ? " shape" : "", number, what);
    } else {
        wh_shapes_add(list, part, "%s%s%s%s", robot, is_one ? "" : " ", link, what);
    }
}

static bool folds(const wh_reading_urdf_t *urdf) {
    return urdf->map.folds[0] || urdf->map.folds[1];
}

/* The arm whose end-effector a link is; WH_URDF_ARMS: none. */
static size_t arm_of_tool(const wh_reading_urdf_t *urdf, int32_t link) {
    size_t arm = 0;
    while (arm < WH_URDF_ARMS && !(arm < urdf->map.arm_count && urdf->map.tools[arm] == link)) {
        ++arm;
    }
    return arm;
}

static void refuse_link(const wh_reading_urdf_t *urdf, const wh_urdf_shape_t *shape) {
    const char *link = urdf->file->links[shape->link].name;
    const size_t arm = arm_of_tool(urdf, shape->link);
    if (arm < WH_URDF_ARMS) {
        wh_reader_refuse(
            urdf->reader, wh_reading_tool_fields[arm], link,
            "a link without shapes, for the end-effector's frame: the blade is that of shapes.blade");
    }
    wh_reader_refuse(
        urdf->reader, "urdf", urdf->name,
        "links that move with the arm's column, lift, upper arm, forearm or hand; \"%s\" moves with none "
        "of them%s%s%s",
        link, folds(urdf) ? " (is the elbow on the other side? then " : "", folds(urdf) ? urdf->lengths : "",
        folds(urdf) ? ".right_handed; is the wrist ever behind theta's axis? then r must begin farther out)"
                    : "");
}

static void make_part(const wh_reading_urdf_t *urdf, const wh_urdf_findings_t *findings, size_t index,
                      wh_part_t *part) {
    const wh_urdf_shape_t *shape = &urdf->file->shapes[index];
    const int32_t body = findings->body[shape->link];
    if (body < 0 || arm_of_tool(urdf, shape->link) < WH_URDF_ARMS) {
        refuse_link(urdf, shape);
    }
    *part = (wh_part_t){.kind = WH_PART_ARM, .owner = body, .convex = shape->convex};
    wh_urdf_shape_place(&findings->body_from_link[shape->link], &part->convex);
    if (part->convex.kind == WH_CONVEX_MESH) {
        read_hull(urdf, shape, &part->convex);
    }
    const wh_status_t status = wh_convex_validate(&part->convex);
    if (status != WH_OK) {
        wh_reader_refuse(urdf->reader, "urdf", urdf->name, "shapes of %g to %g mm; one of link \"%s\": %s",
                         WH_CONVEX_THINNEST, WH_CONVEX_LARGEST, urdf->file->links[shape->link].name,
                         wh_status_text(status));
    }
}

void wh_layout_make_urdf_parts(const wh_reading_urdf_t *urdf, const wh_urdf_findings_t *findings) {
    lua_State *L = urdf->reader->L;
    const size_t count = urdf->file->shape_count;
    wh_part_list_t *list = wh_layout_memory(L, 1, sizeof *list);
    list->parts = wh_layout_memory(L, count, sizeof *list->parts);
    list->names = wh_layout_memory(L, count, sizeof *list->names);
    list->capacity = count;
    for (size_t i = 0; i < count; ++i) {
        wh_part_t part;
        make_part(urdf, findings, i, &part);
        add_part(urdf, list, i, &part);
    }
    urdf->layout->robots[urdf->map.robot].urdf = list;
}
