/* A robot's `urdf`: the map from its joints to the robot's axes, and the parts that its links are made of. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../math/trig.h"
#include "axes.h"
#include "hull.h"
#include "layout_internal.h"
#include "stl.h"
#include "urdf.h"

/* What is read of a `urdf`, while the reader is at its robot. */
typedef struct {
    wh_reader_t *reader;
    wh_layout_t *layout;
    char name[512]; /* of the file, as the layout has it */
    char path[1024];
    const wh_urdf_file_t *file;
    wh_urdf_map_t map;
} urdf_t;

static const char *const angle_names[] = {"fold", "shoulder", "elbow", "wrist"};
enum { ANGLES = WH_URDF_SOURCES - WH_URDF_FOLD };

/* --------------------------------------------------------------------------------------------- the joints */

/* -1: this robot has no such axis or angle. */
static int32_t find_source(const wh_layout_t *layout, const char *name) {
    const wh_machine_t *machine = &layout->machine;
    const size_t count = machine->carrier ? machine->carrier->axis_count : WH_ROBOT_AXES;
    for (size_t i = 0; i < count; ++i) {
        if (wh_axis_exists(machine, i) && strcmp(name, wh_axis_name(machine, i)) == 0) {
            return (int32_t)i;
        }
    }
    for (int32_t i = 0; !wh_layout_is_scara(layout) && i < ANGLES; ++i) {
        if (strcmp(name, angle_names[i]) == 0) {
            return (int32_t)WH_URDF_FOLD + i;
        }
    }
    return -1;
}

/* All that find_source knows: "theta, r, z". */
static void list_sources(const wh_layout_t *layout, char *text, size_t size) {
    const wh_machine_t *machine = &layout->machine;
    const size_t count = machine->carrier ? machine->carrier->axis_count : WH_ROBOT_AXES;
    size_t length = 0;
    text[0] = '\0';
    for (size_t i = 0; i < count + (wh_layout_is_scara(layout) ? 0 : ANGLES) && length < size; ++i) {
        if (i >= count || wh_axis_exists(machine, i)) {
            length += (size_t)snprintf(text + length, size - length, "%s%s", length > 0 ? ", " : "",
                                       i < count ? wh_axis_name(machine, i) : angle_names[i - count]);
        }
    }
}

static bool source_turns(const wh_layout_t *layout, int32_t source) {
    return source >= WH_URDF_FOLD || wh_axis_turns(&layout->machine, (size_t)source);
}

static int32_t read_source(const urdf_t *urdf, const wh_urdf_link_t *link, const char *field) {
    char name[WH_NAME_SIZE];
    char known[256];
    wh_reader_text(urdf->reader, field, NULL, name, sizeof name);
    const int32_t source = find_source(urdf->layout, name);
    if (source < 0) {
        list_sources(urdf->layout, known, sizeof known);
        wh_reader_refuse(urdf->reader, field, name, "what this robot has: %s", known);
    }
    if (source_turns(urdf->layout, source) != (link->motion == WH_URDF_TURNS)) {
        wh_reader_refuse(urdf->reader, field, name, "an axis that %s, as joint \"%s\" of %s does",
                         link->motion == WH_URDF_TURNS ? "turns" : "slides", link->joint, urdf->path);
    }
    return source;
}

static void read_drive(const urdf_t *urdf, const wh_urdf_link_t *link, wh_urdf_drive_t *drive) {
    wh_reader_t *reader = urdf->reader;
    *drive = (wh_urdf_drive_t){-1, 1, 0};
    const int type = wh_reader_push(reader, link->joint);
    if (type != LUA_TTABLE && type != LUA_TSTRING) {
        wh_reader_fail(reader, link->joint, "an axis, or { axis = , factor = , offset = }: %s %s by it",
                       urdf->path, link->motion == WH_URDF_TURNS ? "turns" : "slides");
    }
    lua_pop(reader->L, 1);
    if (type == LUA_TSTRING) {
        drive->source = read_source(urdf, link, link->joint);
        return;
    }
    (void)wh_reader_open(reader, link->joint, wh_layout_joint_fields);
    drive->source = wh_reader_has(reader, "axis") ? read_source(urdf, link, "axis") : -1;
    drive->factor = wh_reader_number(reader, "factor", 1, -1e6, 1e6);
    drive->offset = wh_reader_number(reader, "offset", 0, -1e6, 1e6);
    if (link->motion == WH_URDF_TURNS) {
        drive->offset = wh_rad_from_deg(drive->offset);
    }
    wh_reader_leave(reader);
}

static bool is_driven(const wh_urdf_link_t *link) {
    return link->motion != WH_URDF_FIXED && link->mimics < 0;
}

static void refuse_other_joints(wh_reader_t *reader, const wh_urdf_file_t *file) {
    wh_reader_field_t known[WH_URDF_LINKS + 1] = {{0}};
    size_t count = 0;
    for (size_t i = 1; i < file->link_count; ++i) {
        if (is_driven(&file->links[i])) {
            known[count++].name = file->links[i].joint;
        }
    }
    wh_reader_refuse_unknown(reader, known);
}

static void read_joints(urdf_t *urdf) {
    static const wh_reader_field_t none[] = {{NULL, NULL, NULL, false}};
    const wh_urdf_file_t *file = urdf->file;
    if (!wh_reader_enter(urdf->reader, "joints")) {
        wh_reader_open_section(urdf->reader, "joints", none);
    }
    refuse_other_joints(urdf->reader, file);
    for (size_t i = 1; i < file->link_count; ++i) {
        if (is_driven(&file->links[i])) {
            read_drive(urdf, &file->links[i], &urdf->map.drives[i]);
            urdf->map.folds = urdf->map.folds || urdf->map.drives[i].source >= WH_URDF_FOLD;
        }
    }
    wh_reader_leave(urdf->reader);
}

static void read_tool(urdf_t *urdf) {
    char name[WH_URDF_NAME];
    const wh_urdf_file_t *file = urdf->file;
    wh_reader_text(urdf->reader, "tool", NULL, name, sizeof name);
    urdf->map.tool = -1;
    for (size_t i = 0; i < file->link_count; ++i) {
        urdf->map.tool = strcmp(name, file->links[i].name) == 0 ? (int32_t)i : urdf->map.tool;
    }
    if (urdf->map.tool < 0) {
        wh_reader_refuse(urdf->reader, "tool", name, "a link of %s", urdf->path);
    }
}

/* ------------------------------------------------------------------------------------------ the agreement */

/* "theta 12.5, r 400, z 900, yaw 0": degrees and mm. */
static void describe_axes(const wh_layout_t *layout, const wh_real_t axes[], char *text, size_t size) {
    const wh_machine_t *machine = &layout->machine;
    const size_t count = machine->carrier ? machine->carrier->axis_count : WH_ROBOT_AXES;
    size_t length = 0;
    for (size_t i = 0; i < count && length < size; ++i) {
        if (wh_axis_exists(machine, i)) {
            length += (size_t)snprintf(text + length, size - length, "%s%s %.6g", length > 0 ? ", " : "",
                                       wh_axis_name(machine, i),
                                       wh_axis_turns(machine, i) ? wh_deg_from_rad(axes[i]) : axes[i]);
        }
    }
}

/* `shapes.arm` has been read: of what the URDF says nothing may be in it. */
static void take_arm(const urdf_t *urdf, bool says_links) {
    wh_arm_t *arm = &urdf->layout->shapes.arm;
    if (says_links) {
        wh_reader_refuse(urdf->reader, "urdf", urdf->name,
                         "shapes.arm without reach and link: the joints that follow fold, shoulder, elbow or "
                         "wrist have them");
    }
    wh_urdf_arm(&urdf->map, arm);
    if (!(arm->link >= 10 && arm->link <= 5000 && arm->reach >= 0 && arm->reach <= 2000)) {
        wh_reader_refuse(
            urdf->reader, "urdf", urdf->name,
            "two links of 10 to 5000 mm, and 0 to 2000 mm from the wrist to \"%s\"; stretched and folded "
            "by 90 degrees they give %.9g and %.9g mm",
            urdf->file->links[urdf->map.tool].name, arm->link, arm->reach);
    }
}

/* Rounding is no difference. */
static wh_real_t beyond(wh_real_t difference, wh_real_t rounding) {
    return difference <= rounding ? 0 : difference;
}

static void refuse_difference(const urdf_t *urdf, const wh_urdf_findings_t *findings) {
    char axes[256];
    describe_axes(urdf->layout, findings->axes, axes, sizeof axes);
    wh_reader_refuse(
        urdf->reader, "urdf", urdf->name,
        "\"%s\" where the end-effector is, to %g mm; at %s it is %.9g mm and %.9g degrees off: at "
        "(%.9g, %.9g, %.9g), not at (%.9g, %.9g, %.9g)",
        urdf->file->links[urdf->map.tool].name, WH_URDF_SAME_MM, axes, beyond(findings->mm, WH_URDF_SAME_MM),
        wh_deg_from_rad(beyond(findings->rad, WH_URDF_SAME_RAD)), findings->is.x, findings->is.y,
        findings->is.z, findings->should.x, findings->should.y, findings->should.z);
}

static void check_agreement(const urdf_t *urdf, const wh_urdf_findings_t *findings) {
    if (findings->reached == 0) {
        wh_reader_refuse(urdf->reader, "urdf", urdf->name,
                         "links that reach somewhere within the travels: they are %.9g mm long",
                         urdf->layout->shapes.arm.link);
    }
    if (!(findings->mm <= WH_URDF_SAME_MM && findings->rad <= WH_URDF_SAME_RAD)) {
        refuse_difference(urdf, findings);
    }
    if (findings->beyond >= 0) {
        const wh_urdf_link_t *link = &urdf->file->links[findings->beyond];
        const wh_real_t unit = link->motion == WH_URDF_TURNS ? wh_deg_from_rad(1) : 1;
        char axes[256];
        describe_axes(urdf->layout, findings->beyond_axes, axes, sizeof axes);
        wh_reader_refuse(urdf->reader, "urdf", urdf->name,
                         "travels within the limits of joint \"%s\", %.9g to %.9g; at %s it would be at %.9g",
                         link->joint, unit * link->least, unit * link->most, axes,
                         unit * findings->beyond_value);
    }
}

/* ---------------------------------------------------------------------------------------------- the parts */

/* A mesh's path: beside the URDF, or in one of the packages. */
static void find_mesh(const urdf_t *urdf, const char *mesh, char *path, size_t size) {
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
    } else if (strncmp(mesh, file, sizeof file - 1) == 0) {
        (void)snprintf(path, size, "%s", mesh + sizeof file - 1);
    } else if (strstr(mesh, "://")) {
        wh_reader_refuse(reader, "urdf", mesh, "a mesh beside %s, file:// or package://NAME/FILE",
                         urdf->path);
    } else {
        wh_layout_path(path, size, urdf->path, mesh);
    }
}

/* A URDF's meshes are in m, times their scale. */
static void read_hull(const urdf_t *urdf, const wh_urdf_shape_t *shape, wh_convex_t *convex) {
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

/* "forearm", and of its other shapes "forearm 2"; "forearm hull" where it is the hull of a mesh. */
static void add_part(const urdf_t *urdf, wh_part_list_t *list, size_t index, const wh_part_t *part) {
    const wh_urdf_shape_t *shapes = urdf->file->shapes;
    const char *link = urdf->file->links[shapes[index].link].name;
    const char *what = part->convex.kind == WH_CONVEX_MESH ? " hull" : "";
    int number = 1;
    for (size_t i = 0; i < index; ++i) {
        number += shapes[i].link == shapes[index].link;
    }
    if (number > 1) {
        wh_shapes_add(list, part, "%s %d%s", link, number, what);
    } else {
        wh_shapes_add(list, part, "%s%s", link, what);
    }
}

static void refuse_link(const urdf_t *urdf, const wh_urdf_shape_t *shape) {
    const char *link = urdf->file->links[shape->link].name;
    if (shape->link == urdf->map.tool) {
        wh_reader_refuse(
            urdf->reader, "tool", link,
            "a link without shapes, for the end-effector's frame: the blade is that of shapes.blade");
    }
    wh_reader_refuse(
        urdf->reader, "urdf", urdf->name,
        "links that move with the arm's column, lift, upper arm, forearm or hand; \"%s\" moves with none "
        "of them%s",
        link,
        urdf->map.folds ? " (is the elbow on the other side? then shapes.arm.right_handed; is the wrist "
                          "ever behind theta's axis? then r must begin farther out)"
                        : "");
}

static void make_part(const urdf_t *urdf, const wh_urdf_findings_t *findings, size_t index, wh_part_t *part) {
    const wh_urdf_shape_t *shape = &urdf->file->shapes[index];
    const int32_t body = findings->body[shape->link];
    if (body < 0 || shape->link == urdf->map.tool) {
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

static void make_parts(const urdf_t *urdf, const wh_urdf_findings_t *findings) {
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
    urdf->layout->urdf = list;
}

/* ---------------------------------------------------------------------------------------------- the field */

/* The links are those of one arm. */
static void refuse_several(const urdf_t *urdf) {
    const wh_carrier_t *carrier = urdf->layout->machine.carrier;
    if (carrier && (carrier->second || carrier->next)) {
        wh_reader_refuse(urdf->reader, "urdf", urdf->name,
                         "nothing: it is for one robot with one arm and one wrist");
    }
}

static void read_file(urdf_t *urdf) {
    char message[1024];
    wh_urdf_file_t *file = wh_layout_memory(urdf->reader->L, 1, sizeof *file);
    wh_reader_text(urdf->reader, "urdf", NULL, urdf->name, sizeof urdf->name);
    refuse_several(urdf);
    wh_layout_path(urdf->path, sizeof urdf->path, urdf->layout->path, urdf->name);
    if (!wh_urdf_read(urdf->path, file, message, sizeof message)) {
        wh_reader_refuse(urdf->reader, "urdf", urdf->name, "a URDF file: %s", message);
    }
    urdf->file = file;
    urdf->map.file = file;
}

static bool says_links(wh_reader_t *reader) {
    bool says = false;
    if (wh_reader_enter(reader, "shapes")) {
        if (wh_reader_enter(reader, "arm")) {
            says = wh_reader_has(reader, "reach") || wh_reader_has(reader, "link");
            wh_reader_leave(reader);
        }
        wh_reader_leave(reader);
    }
    return says;
}

static void refuse_without(wh_reader_t *reader) {
    static const char *const fields[] = {"joints", "tool", "packages"};
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; ++i) {
        if (wh_reader_has(reader, fields[i])) {
            (void)wh_reader_push(reader, fields[i]);
            wh_reader_fail(reader, fields[i], "nothing without urdf");
        }
    }
}

void wh_layout_read_urdf(wh_reader_t *reader, wh_layout_t *layout) {
    const bool says = says_links(reader);
    layout->urdf = NULL;
    if (!wh_reader_enter(reader, "robot")) {
        return;
    }
    if (wh_reader_has(reader, "urdf")) {
        urdf_t urdf = {.reader = reader, .layout = layout};
        wh_urdf_findings_t findings;
        if (wh_reader_enter(reader, "packages")) {
            wh_reader_leave(reader);
        }
        read_file(&urdf);
        read_joints(&urdf);
        read_tool(&urdf);
        if (urdf.map.folds) {
            take_arm(&urdf, says);
        }
        wh_urdf_examine(&urdf.map, layout, &findings);
        check_agreement(&urdf, &findings);
        make_parts(&urdf, &findings);
    } else {
        refuse_without(reader);
    }
    wh_reader_leave(reader);
}
