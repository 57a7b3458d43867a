/* Robots' `urdf`: the map from its joints to the robot's axes, and whether both have the same poses. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../bodies/shapes.h"
#include "../bodies/urdf.h"
#include "../layout/arms.h"
#include "../layout/axes.h"
#include "../math/trig.h"
#include "layout_urdf_internal.h"

/* ----------------------------------------------------------------------------------------------- the axes */

/* The name of a source; null: this robot has no such axis or angle. */
static const char *source_name(const wh_reading_urdf_t *urdf, size_t source) {
    static const char *const angles[WH_URDF_ARMS * WH_URDF_ANGLES] = {
        "fold", "shoulder", "elbow", "wrist", "fold2", "shoulder2", "elbow2", "wrist2"};
    const wh_machine_t *machine = &urdf->layout->machine;
    const size_t angle = source - WH_URDF_FOLD;
    if (source < urdf->count) {
        return wh_axis_exists(machine, urdf->first + source) ? wh_axis_name(machine, urdf->first + source)
                                                             : NULL;
    }
    const bool is_there = source >= WH_URDF_FOLD && angle < urdf->map.arm_count * WH_URDF_ANGLES &&
                          !wh_layout_is_scara(urdf->layout, urdf->map.robot);
    return is_there ? angles[angle] : NULL;
}

/* -1: this robot has no such axis or angle. */
static int32_t find_source(const wh_reading_urdf_t *urdf, const char *name) {
    for (size_t i = 0; i < WH_URDF_SOURCES; ++i) {
        const char *known = source_name(urdf, i);
        if (known && strcmp(name, known) == 0) {
            return (int32_t)i;
        }
    }
    return -1;
}

/* All that find_source knows: "theta, r, z". */
static void list_sources(const wh_reading_urdf_t *urdf, char *text, size_t size) {
    size_t length = 0;
    text[0] = '\0';
    for (size_t i = 0; i < WH_URDF_SOURCES && length < size; ++i) {
        const char *known = source_name(urdf, i);
        if (known) {
            length += (size_t)snprintf(text + length, size - length, "%s%s", length > 0 ? ", " : "", known);
        }
    }
}

static bool source_turns(const wh_reading_urdf_t *urdf, int32_t source) {
    return source >= WH_URDF_FOLD || wh_axis_turns(&urdf->layout->machine, urdf->first + (size_t)source);
}

/* --------------------------------------------------------------------------------------------- the joints */

static int32_t read_source(const wh_reading_urdf_t *urdf, const wh_urdf_link_t *link, const char *field) {
    char name[WH_NAME_SIZE];
    char known[256];
    wh_reader_text(urdf->reader, field, NULL, name, sizeof name);
    const int32_t source = find_source(urdf, name);
    if (source < 0) {
        list_sources(urdf, known, sizeof known);
        wh_reader_refuse(urdf->reader, field, name, "what this robot has: %s", known);
    }
    if (source_turns(urdf, source) != (link->motion == WH_URDF_TURNS)) {
        wh_reader_refuse(urdf->reader, field, name, "an axis that %s, as joint \"%s\" of %s does",
                         link->motion == WH_URDF_TURNS ? "turns" : "slides", link->joint, urdf->path);
    }
    return source;
}

static void read_drive(const wh_reading_urdf_t *urdf, const wh_urdf_link_t *link, wh_urdf_drive_t *drive) {
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
    drive->factor = wh_reader_apart(reader, "factor");
    drive->offset = wh_reader_apart(reader, "offset");
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

static void note_fold(wh_reading_urdf_t *urdf, int32_t source) {
    if (source >= WH_URDF_FOLD) {
        urdf->map.folds[(source - WH_URDF_FOLD) / WH_URDF_ANGLES] = true;
    }
}

static void read_joints(wh_reading_urdf_t *urdf) {
    static const wh_reader_field_t none[] = {{NULL, NULL, NULL, false}};
    const wh_urdf_file_t *file = urdf->file;
    if (!wh_reader_enter(urdf->reader, "joints")) {
        wh_reader_open_section(urdf->reader, "joints", none);
    }
    refuse_other_joints(urdf->reader, file);
    for (size_t i = 1; i < file->link_count; ++i) {
        if (is_driven(&file->links[i])) {
            read_drive(urdf, &file->links[i], &urdf->map.drives[i]);
            note_fold(urdf, urdf->map.drives[i].source);
        }
    }
    wh_reader_leave(urdf->reader);
}

/* The fields that name the end-effectors. */
const char *const wh_reading_tool_fields[WH_URDF_ARMS] = {"tool", "tool2"};

static void read_tool(wh_reading_urdf_t *urdf, size_t arm) {
    char name[WH_URDF_NAME];
    const wh_urdf_file_t *file = urdf->file;
    int32_t *tool = &urdf->map.tools[arm];
    wh_reader_text(urdf->reader, wh_reading_tool_fields[arm], NULL, name, sizeof name);
    *tool = -1;
    for (size_t i = 0; i < file->link_count; ++i) {
        *tool = strcmp(name, file->links[i].name) == 0 ? (int32_t)i : *tool;
    }
    if (*tool < 0) {
        wh_reader_refuse(urdf->reader, wh_reading_tool_fields[arm], name, "a link of %s", urdf->path);
    }
}

static void read_tools(wh_reading_urdf_t *urdf) {
    for (size_t arm = 0; arm < urdf->map.arm_count && arm < WH_URDF_ARMS; ++arm) {
        read_tool(urdf, arm);
    }
    if (urdf->map.arm_count < WH_URDF_ARMS) {
        wh_layout_refuse_field(urdf->reader, wh_reading_tool_fields[1],
                               "nothing: it is for a robot with two arms or two wrists");
    }
}

/* ------------------------------------------------------------------------------------------ the agreement */

/* "theta 12.5, r 400, z 900, yaw 0": degrees and mm. */
static void describe_axes(const wh_reading_urdf_t *urdf, const wh_real_t axes[], char *text, size_t size) {
    const wh_machine_t *machine = &urdf->layout->machine;
    size_t length = 0;
    for (size_t i = urdf->first; i < urdf->first + urdf->count && length < size; ++i) {
        if (wh_axis_exists(machine, i)) {
            length += (size_t)snprintf(text + length, size - length, "%s%s %.6g", length > 0 ? ", " : "",
                                       wh_axis_name(machine, i),
                                       wh_axis_turns(machine, i) ? wh_deg_from_rad(axes[i]) : axes[i]);
        }
    }
}

/* The robot's lengths, which the layout's shapes have. */
static wh_arm_t *lengths_of(const wh_reading_urdf_t *urdf) {
    return urdf->map.robot == 0 ? &urdf->layout->shapes.arm : &urdf->layout->robots[urdf->map.robot].arm;
}

static const char *tool_name(const wh_reading_urdf_t *urdf, size_t arm) {
    return urdf->file->links[urdf->map.tools[arm]].name;
}

static void measure_arm(const wh_reading_urdf_t *urdf, size_t number, wh_arm_t *arm) {
    wh_urdf_arm(&urdf->map, number, urdf->layout, arm);
    if (!(arm->link >= 10 && arm->link <= 5000 && arm->reach >= 0 && arm->reach <= 2000)) {
        wh_reader_refuse(
            urdf->reader, "urdf", urdf->name,
            "two links of 10 to 5000 mm, and 0 to 2000 mm from the wrist to \"%s\"; stretched and folded "
            "by 90 degrees they give %.9g and %.9g mm",
            tool_name(urdf, number), arm->link, arm->reach);
    }
}

/* `shapes` has been read: it may say nothing that the URDF says. Two arms of a robot are alike. */
static void take_arms(const wh_reading_urdf_t *urdf, bool says_links) {
    const bool *folds = urdf->map.folds;
    wh_arm_t arms[WH_URDF_ARMS];
    for (size_t i = 0; i < WH_URDF_ARMS; ++i) {
        arms[i] = *lengths_of(urdf);
        if (folds[i] && says_links) {
            wh_reader_refuse(urdf->reader, "urdf", urdf->name,
                             "%s without reach and link: the joints that follow fold, shoulder, elbow or "
                             "wrist have them",
                             urdf->lengths);
        }
        if (folds[i]) {
            measure_arm(urdf, i, &arms[i]);
        }
    }
    if (folds[0] && folds[1] &&
        !(wh_real_abs(arms[0].link - arms[1].link) <= WH_URDF_SAME_MM &&
          wh_real_abs(arms[0].reach - arms[1].reach) <= WH_URDF_SAME_MM)) {
        wh_reader_refuse(urdf->reader, "urdf", urdf->name,
                         "two arms alike: links of %.9g and %.9g mm, wrists %.9g and %.9g mm behind "
                         "the end-effector",
                         arms[0].link, arms[1].link, arms[0].reach, arms[1].reach);
    }
    *lengths_of(urdf) = folds[0] ? arms[0] : arms[1];
}

/* Rounding does not count as a difference. */
static wh_real_t beyond(wh_real_t difference, wh_real_t rounding) {
    return difference <= rounding ? 0 : difference;
}

static void refuse_difference(const wh_reading_urdf_t *urdf, const wh_urdf_findings_t *found) {
    char axes[256];
    describe_axes(urdf, found->axes, axes, sizeof axes);
    wh_reader_refuse(
        urdf->reader, "urdf", urdf->name,
        "\"%s\" where the end-effector is, to %g mm and %g rad; at %s it is %.9g mm and %.9g degrees off: at "
        "(%.9g, %.9g, %.9g), not at (%.9g, %.9g, %.9g)",
        tool_name(urdf, found->arm), WH_URDF_SAME_MM, WH_URDF_SAME_RAD, axes,
        beyond(found->mm, WH_URDF_SAME_MM), wh_deg_from_rad(beyond(found->rad, WH_URDF_SAME_RAD)),
        found->is.x, found->is.y, found->is.z, found->should.x, found->should.y, found->should.z);
}

static void check_agreement(const wh_reading_urdf_t *urdf, const wh_urdf_findings_t *findings) {
    if (findings->reached == 0) {
        wh_reader_refuse(urdf->reader, "urdf", urdf->name,
                         "links that reach somewhere within the travels: they are %.9g mm long",
                         lengths_of(urdf)->link);
    }
    if (!(findings->mm <= WH_URDF_SAME_MM && findings->rad <= WH_URDF_SAME_RAD)) {
        refuse_difference(urdf, findings);
    }
    if (findings->beyond >= 0) {
        const wh_urdf_link_t *link = &urdf->file->links[findings->beyond];
        const wh_real_t unit = link->motion == WH_URDF_TURNS ? wh_deg_from_rad(1) : 1;
        char axes[256];
        describe_axes(urdf, findings->beyond_axes, axes, sizeof axes);
        wh_reader_refuse(urdf->reader, "urdf", urdf->name,
                         "travels within the limits of joint \"%s\", %.9g to %.9g; at %s it would be at %.9g",
                         link->joint, unit * link->least, unit * link->most, axes,
                         unit * findings->beyond_value);
    }
}

/* ---------------------------------------------------------------------------------------------- the field */

static void read_file(wh_reading_urdf_t *urdf) {
    char message[1024];
    wh_urdf_file_t *file = wh_layout_memory(urdf->reader->L, 1, sizeof *file);
    wh_reader_text(urdf->reader, "urdf", NULL, urdf->name, sizeof urdf->name);
    wh_layout_path(urdf->path, sizeof urdf->path, urdf->layout->path, urdf->name);
    if (!wh_urdf_read(urdf->path, file, message, sizeof message)) {
        wh_reader_refuse(urdf->reader, "urdf", urdf->name, "a URDF file: %s", message);
    }
    urdf->file = file;
    urdf->map.file = file;
}

/* True if `shapes` gives lengths of the robot's arm that folding joints already give. The reader is at the
 * layout's top. */
static bool says_links(wh_reader_t *reader, const wh_layout_t *layout, size_t robot) {
    const char *const path[] = {"shapes", layout->robot_count > 1 ? "arms" : "arm",
                                layout->robots[robot].name};
    const size_t depth = layout->robot_count > 1 ? 3 : 2;
    size_t entered = 0;
    while (entered < depth && wh_reader_enter(reader, path[entered])) {
        ++entered;
    }
    const bool says = entered == depth && (wh_reader_has(reader, "reach") || wh_reader_has(reader, "link"));
    for (; entered > 0; --entered) {
        wh_reader_leave(reader);
    }
    return says;
}

static void refuse_without(wh_reader_t *reader) {
    static const char *const fields[] = {"joints", "tool", "tool2", "packages"};
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; ++i) {
        wh_layout_refuse_field(reader, fields[i], "nothing without urdf");
    }
}

/* Fills in what is known of the robot before its file is read. */
static void start(wh_reading_urdf_t *urdf, wh_reader_t *reader, wh_layout_t *layout, size_t robot) {
    const wh_carrier_t *carrier = wh_machine_carrier(&layout->machine, robot, &urdf->first);
    urdf->reader = reader;
    urdf->layout = layout;
    urdf->count = carrier ? carrier->axis_count : WH_ROBOT_AXES;
    urdf->map.robot = robot;
    urdf->map.arm_count = carrier && carrier->second ? 2 : 1;
    (void)snprintf(urdf->lengths, sizeof urdf->lengths, "shapes.arm%s%s", layout->robot_count > 1 ? "s." : "",
                   layout->robot_count > 1 ? layout->robots[robot].name : "");
}

/* The reader is at the robot. */
static void read_urdf(wh_reader_t *reader, wh_layout_t *layout, size_t robot, bool says_links) {
    wh_reading_urdf_t urdf = {.reader = reader};
    wh_urdf_findings_t findings;
    start(&urdf, reader, layout, robot);
    if (wh_reader_enter(reader, "packages")) {
        wh_reader_leave(reader);
    }
    read_file(&urdf);
    read_joints(&urdf);
    read_tools(&urdf);
    if (urdf.map.folds[0] || urdf.map.folds[1]) {
        take_arms(&urdf, says_links);
    }
    wh_urdf_examine(&urdf.map, layout, &findings);
    check_agreement(&urdf, &findings);
    wh_layout_make_urdf_parts(&urdf, &findings);
}

/* The reader is where the robots are by name. */
static void read_robot(wh_reader_t *reader, wh_layout_t *layout, size_t robot, bool says_links) {
    if (wh_reader_enter(reader, layout->robots[robot].name)) {
        if (wh_reader_has(reader, "urdf")) {
            read_urdf(reader, layout, robot, says_links);
        } else {
            refuse_without(reader);
        }
        wh_reader_leave(reader);
    }
}

void wh_layout_read_urdfs(wh_reader_t *reader, wh_layout_t *layout) {
    for (size_t robot = 0; robot < layout->robot_count; ++robot) {
        const bool says = says_links(reader, layout, robot);
        const bool is_in_list = wh_reader_enter(reader, "robots");
        read_robot(reader, layout, robot, says);
        if (is_in_list) {
            wh_reader_leave(reader);
        }
    }
}
