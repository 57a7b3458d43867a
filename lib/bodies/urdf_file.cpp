#include "urdf_file.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include <fcntl.h>
#include <pthread.h>
#include <sys/stat.h>
#include <unistd.h>

#include <console_bridge/console.h>
#include <tinyxml.h>
#include <urdf_parser/urdf_parser.h>

extern "C" {
#include "../text/nearest.h"
#include "../text/output.h"
#include "../text/utf8.h"
}

namespace {

const double mm_per_m = 1000;

/* The file to fill in, and the message for an error. */
struct reading_t {
    const char *path;
    wh_urdf_file_t *file;
    char *message;
    size_t size;
    std::vector<const urdf::Link *> links; /* in the order of file->links */
};

/* The library uses text that it cannot read as the format of a message, so it gets this byte in place of each
 * %. */
const char percent = '\1';

std::string with_percents(std::string text) {
    std::replace(text.begin(), text.end(), percent, '%');
    return text;
}

/* Writes the path and the formatted text into the message, and returns false. */
bool refuse(const reading_t &reading, const char *format, ...) __attribute__((format(printf, 2, 3)));

bool refuse(const reading_t &reading, const char *format, ...) {
    char said[512];
    va_list arguments;
    va_start(arguments, format);
    (void)std::vsnprintf(said, sizeof said, format, arguments);
    va_end(arguments);
    const std::string all = std::string(reading.path) + ": " + with_percents(said);
    wh_utf8_visible(reading.message, reading.size, all.c_str());
    return false;
}

/* ----------------------------------------------------------------------------------------------- the text */

bool read_text(const reading_t &reading, std::string &text) {
    struct stat status;
    wh_output_note_input(reading.path);
    const int fd = open(reading.path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0) {
        return refuse(reading, "%s", std::strerror(errno));
    }
    const bool is_file = fstat(fd, &status) == 0 && S_ISREG(status.st_mode);
    text.resize(WH_URDF_BYTES + 1);
    size_t length = 0;
    for (ssize_t got = 1; is_file && got > 0 && length<text.size(); length += got> 0 ? size_t(got) : 0) {
        got = read(fd, &text[length], text.size() - length);
    }
    (void)close(fd);
    text.resize(length);
    if (!is_file) {
        return refuse(reading, "it is no regular file");
    }
    wh_output_keep(reading.path);
    return length <= WH_URDF_BYTES || refuse(reading, "more than %zu bytes", WH_URDF_BYTES);
}

/* Returns where the tag or comment that begins at `at` ends, or the text's end. `count` is set to the most
 * attributes that it may have. */
size_t pass_tag(const std::string &text, size_t at, size_t &count) {
    count = 0;
    if (text.compare(at, 4, "<!--") == 0) {
        return std::min(text.find("-->", at), text.size());
    }
    char quote = '\0';
    for (; at < text.size() && (quote != '\0' || text[at] != '>'); ++at) {
        count += size_t(quote == '\0' && text[at] == '=');
        if (text[at] == quote) {
            quote = '\0';
        } else if (quote == '\0' && (text[at] == '"' || text[at] == '\'')) {
            quote = text[at];
        }
    }
    return at;
}

size_t line_of(const std::string &text, size_t at) {
    return 1 + size_t(std::count(text.begin(), text.begin() + long(at), '\n'));
}

/* The reader compares each attribute of an element with all others of it. */
bool check_attributes(const reading_t &reading, const std::string &text) {
    size_t count = 0;
    for (size_t at = text.find('<'); at < text.size(); at = text.find('<', at)) {
        const size_t end = pass_tag(text, at, count);
        if (count > WH_URDF_ATTRIBUTES) {
            return refuse(reading, "line %zu: an element with %zu attributes (expected at most %d)",
                          line_of(text, at), count, WH_URDF_ATTRIBUTES);
        }
        at = end;
    }
    return true;
}

/* A file for xacro is XML, too, and liburdfdom would pass over its elements. */
bool check_expanded(const reading_t &reading, const std::string &text) {
    const size_t at = std::min({text.find("<xacro:"), text.find("${"), text.find("$(")});
    return at == std::string::npos ||
           refuse(reading, "line %zu: it is written for xacro (expected what `xacro FILE` makes of it)",
                  line_of(text, at));
}

/* liburdfdom's reader of XML takes text alone, and goes down one call for each element within another. */
bool check_text(const reading_t &reading, const std::string &text) {
    const size_t tags = size_t(std::count(text.begin(), text.end(), '<'));
    const size_t at = text.find_first_of(std::string{'\0', percent});
    if (at != std::string::npos) {
        return refuse(reading, "byte %zu is %d (expected text)", at, text[at]);
    }
    return tags <= WH_URDF_TAGS ? check_attributes(reading, text) && check_expanded(reading, text)
                                : refuse(reading, "%zu tags (expected at most %d)", tags, WH_URDF_TAGS);
}

/* ---------------------------------------------------------------------------------------------- elements */

size_t count_children(const TiXmlElement &element) {
    size_t count = 0;
    for (const TiXmlElement *at = element.FirstChildElement(); at; at = at->NextSiblingElement()) {
        ++count;
    }
    return count;
}

const char *name_of(const TiXmlElement &element) {
    const char *name = element.Attribute("name");
    return name ? name : "";
}

/* If one element has several shapes, liburdfdom silently takes the first. */
bool check_shape(const reading_t &reading, const TiXmlElement &link, const TiXmlElement &shape) {
    const TiXmlElement *geometry = shape.FirstChildElement("geometry");
    const bool is_one =
        geometry && !geometry->NextSiblingElement("geometry") && count_children(*geometry) == 1;
    return is_one || refuse(reading, "line %d: link \"%s\": %s (expected one geometry in it, with one shape)",
                            shape.Row(), name_of(link), shape.Value());
}

/* liburdfdom ignores elements that it does not know. An element whose name is nearly a shape's was meant as
 * that shape. */
bool check_link(const reading_t &reading, const TiXmlElement &link) {
    static const char *const known[] = {"collision", "visual"};
    bool good = true;
    for (const TiXmlElement *at = link.FirstChildElement(); good && at; at = at->NextSiblingElement()) {
        const char *name = at->Value();
        const char *nearest = wh_text_nearest(name, known, sizeof known / sizeof known[0]);
        if (nearest && std::strcmp(nearest, name) != 0) {
            good = refuse(reading,
                          "line %d: link \"%s\": element \"%s\" (expected collision, visual or others; "
                          "did you mean %s?)",
                          at->Row(), name_of(link), name, nearest);
        } else if (nearest) {
            good = check_shape(reading, link, *at);
        }
    }
    return good;
}

/* liburdfdom does not tell where it stopped reading. */
bool read_xml(const reading_t &reading, const std::string &text, TiXmlDocument &document) {
    document.Parse(text.c_str());
    if (document.Error() && document.ErrorRow() == 0) {
        return refuse(reading, "at its end: %s (expected XML)", document.ErrorDesc());
    }
    return !document.Error() || refuse(reading, "line %d, column %d: %s (expected XML)", document.ErrorRow(),
                                       document.ErrorCol(), document.ErrorDesc());
}

bool check_elements(const reading_t &reading, const TiXmlDocument &document) {
    const TiXmlElement *robot = document.RootElement();
    bool good = true;
    for (const TiXmlElement *at = robot ? robot->FirstChildElement("link") : nullptr; good && at;
         at = at->NextSiblingElement("link")) {
        good = check_link(reading, *at);
    }
    return good;
}

/* ------------------------------------------------------------------------------------------- liburdfdom */

/* Keeps the library's errors. If a shape or a mass is wrong, the library goes on without the rest of that
 * link's shapes. It then reports two errors; the second one names the link. Errors of a link's paint do not
 * count here. */
class listener_t : public console_bridge::OutputHandler {
  public:
    void log(const std::string &text, console_bridge::LogLevel level, const char *, int) override;
    std::string error;

  private:
    bool names_link = false;
};

void listener_t::log(const std::string &text, console_bridge::LogLevel level, const char *, int) {
    const bool is_paint = text.compare(0, 9, "Material ") == 0;
    if (level != console_bridge::CONSOLE_BRIDGE_LOG_ERROR || is_paint || names_link) {
        return;
    }
    names_link = text.find(" for Link [") != std::string::npos;
    if (error.empty() || names_link) {
        error += (error.empty() ? "" : "; ") + text;
    }
}

/* The library's messages go to one listener of the whole process. */
pthread_mutex_t one_at_a_time = PTHREAD_MUTEX_INITIALIZER;

/* Returns null and the reason, also if the library made a model of a part of the text. */
urdf::ModelInterfaceSharedPtr parse(const std::string &text, std::string &error) {
    listener_t listener;
    (void)pthread_mutex_lock(&one_at_a_time);
    console_bridge::OutputHandler *before = console_bridge::getOutputHandler();
    console_bridge::useOutputHandler(&listener);
    urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(text);
    console_bridge::useOutputHandler(before);
    (void)pthread_mutex_unlock(&one_at_a_time);
    if (!listener.error.empty()) {
        model.reset();
    }
    error = listener.error.empty() ? "it is no URDF" : listener.error;
    return model;
}

/* ----------------------------------------------------------------------------------------------- geometry */

wh_vec3_t vector_of(const urdf::Vector3 &v, double factor) {
    return wh_vec3(factor * v.x, factor * v.y, factor * v.z);
}

wh_pose_t pose_of(const urdf::Pose &pose) {
    const urdf::Rotation &q = pose.rotation;
    const wh_pose_t made = {
        {{{1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y - q.z * q.w), 2 * (q.x * q.z + q.y * q.w)},
          {2 * (q.x * q.y + q.z * q.w), 1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z - q.x * q.w)},
          {2 * (q.x * q.z - q.y * q.w), 2 * (q.y * q.z + q.x * q.w), 1 - 2 * (q.x * q.x + q.y * q.y)}}},
        vector_of(pose.position, mm_per_m)};
    return made;
}

bool copy_name(const reading_t &reading, const char *what, const std::string &name, char *to, size_t size) {
    if (name.empty() || name.size() >= size) {
        return refuse(reading, "%s \"%s\" (expected 1 to %zu bytes)", what, name.c_str(), size - 1);
    }
    std::memcpy(to, with_percents(name).c_str(), name.size() + 1);
    return true;
}

bool take_mesh(const reading_t &reading, const urdf::Mesh &mesh, const char *link, wh_urdf_shape_t *shape) {
    shape->convex.kind = WH_CONVEX_MESH;
    shape->scale = vector_of(mesh.scale, 1);
    const wh_vec3_t &s = shape->scale;
    if (!(std::fabs(s.x) > 0 && std::fabs(s.y) > 0 && std::fabs(s.z) > 0 && wh_vec3_is_finite(&s))) {
        return refuse(reading,
                      "link \"%s\": scale %g %g %g of mesh \"%s\" (expected three numbers other than 0)",
                      link, s.x, s.y, s.z, mesh.filename.c_str());
    }
    return copy_name(reading, "mesh", mesh.filename, shape->mesh, sizeof shape->mesh);
}

bool take_shape(reading_t &reading, size_t link, const urdf::Geometry *geometry, const urdf::Pose &origin) {
    const char *name = reading.file->links[link].name;
    if (reading.file->shape_count == WH_URDF_SHAPES) {
        return refuse(reading, "link \"%s\": more than %d shapes in the file", name, WH_URDF_SHAPES);
    }
    if (geometry == nullptr) {
        return refuse(reading, "link \"%s\": a shape without geometry", name);
    }
    wh_urdf_shape_t *shape = &reading.file->shapes[reading.file->shape_count++];
    *shape = wh_urdf_shape_t{};
    shape->link = int32_t(link);
    shape->convex.body_from_shape = pose_of(origin);
    if (geometry->type == urdf::Geometry::BOX) {
        shape->convex.kind = WH_CONVEX_BOX;
        shape->convex.half = vector_of(static_cast<const urdf::Box *>(geometry)->dim, mm_per_m / 2);
    } else if (geometry->type == urdf::Geometry::CYLINDER) {
        const auto *cylinder = static_cast<const urdf::Cylinder *>(geometry);
        shape->convex.kind = WH_CONVEX_CYLINDER;
        shape->convex.half = wh_vec3(mm_per_m * cylinder->radius, 0, mm_per_m / 2 * cylinder->length);
    } else if (geometry->type == urdf::Geometry::SPHERE) {
        shape->convex.kind = WH_CONVEX_CAPSULE;
        shape->convex.half = wh_vec3(mm_per_m * static_cast<const urdf::Sphere *>(geometry)->radius, 0, 0);
    } else {
        return take_mesh(reading, *static_cast<const urdf::Mesh *>(geometry), name, shape);
    }
    return true;
}

bool take_shapes(reading_t &reading, size_t link) {
    const urdf::Link &from = *reading.links[link];
    bool good = true;
    for (const auto &collision : from.collision_array) {
        good = good && take_shape(reading, link, collision->geometry.get(), collision->origin);
    }
    for (size_t i = 0; from.collision_array.empty() && i < from.visual_array.size(); ++i) {
        const urdf::Visual &visual = *from.visual_array[i];
        good = good && take_shape(reading, link, visual.geometry.get(), visual.origin);
    }
    return good;
}

/* ------------------------------------------------------------------------------------------------- joints */

/* The names of liburdfdom's types, by their numbers. */
const char *type_of(const urdf::Joint &joint) {
    static const char *const names[] = {"unknown",  "revolute", "continuous", "prismatic",
                                        "floating", "planar",   "fixed"};
    return names[joint.type];
}

/* Limits of 0 and 0 mean that the file gives none for the joint. */
void take_limits(const urdf::Joint &joint, wh_urdf_link_t *link) {
    const double unit = link->motion == WH_URDF_SLIDES ? mm_per_m : 1;
    const bool can_be = joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::PRISMATIC;
    link->is_limited =
        can_be && joint.limits && (std::fabs(joint.limits->lower) > 0 || std::fabs(joint.limits->upper) > 0);
    link->least = link->is_limited ? unit * joint.limits->lower : 0;
    link->most = link->is_limited ? unit * joint.limits->upper : 0;
}

bool take_axis(const reading_t &reading, const urdf::Joint &joint, wh_urdf_link_t *link) {
    const wh_vec3_t axis = vector_of(joint.axis, 1);
    const double length = wh_vec3_norm(&axis);
    if (!(length > 0 && std::isfinite(length))) {
        return refuse(reading, "joint \"%s\": axis %g %g %g (expected a direction)", link->joint, axis.x,
                      axis.y, axis.z);
    }
    link->axis = wh_vec3_scale(1 / length, &axis);
    return true;
}

bool take_joint(const reading_t &reading, const urdf::Joint &joint, wh_urdf_link_t *link) {
    if (!copy_name(reading, "joint", joint.name, link->joint, sizeof link->joint)) {
        return false;
    }
    link->parent_from_joint = pose_of(joint.parent_to_joint_origin_transform);
    const wh_vec3_t &r = link->parent_from_joint.r;
    if (!(wh_vec3_norm(&r) <= WH_CONVEX_LARGEST)) {
        return refuse(reading, "joint \"%s\": origin %g %g %g m (expected within %g m)", link->joint,
                      r.x / mm_per_m, r.y / mm_per_m, r.z / mm_per_m, WH_CONVEX_LARGEST / mm_per_m);
    }
    if (joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS) {
        link->motion = WH_URDF_TURNS;
    } else if (joint.type == urdf::Joint::PRISMATIC) {
        link->motion = WH_URDF_SLIDES;
    } else if (joint.type != urdf::Joint::FIXED) {
        return refuse(reading, "joint \"%s\": type %s (expected revolute, continuous, prismatic or fixed)",
                      link->joint, type_of(joint));
    }
    take_limits(joint, link);
    return link->motion == WH_URDF_FIXED || take_axis(reading, joint, link);
}

int32_t find_joint(const wh_urdf_file_t &file, const std::string &name) {
    for (size_t i = 1; i < file.link_count; ++i) {
        if (with_percents(name) == file.links[i].joint) {
            return int32_t(i);
        }
    }
    return -1;
}

bool take_mimic(const reading_t &reading, size_t i) {
    wh_urdf_link_t *link = &reading.file->links[i];
    const urdf::JointMimicSharedPtr &mimic = reading.links[i]->parent_joint->mimic;
    if (!mimic || link->motion == WH_URDF_FIXED) {
        return true;
    }
    const int32_t other = find_joint(*reading.file, mimic->joint_name);
    if (other < 0 || reading.file->links[other].motion != link->motion) {
        return refuse(reading, "joint \"%s\" mimics \"%s\" (expected a joint that %s, too)", link->joint,
                      mimic->joint_name.c_str(), link->motion == WH_URDF_TURNS ? "turns" : "slides");
    }
    link->mimics = other;
    link->factor = mimic->multiplier;
    link->offset = (link->motion == WH_URDF_SLIDES ? mm_per_m : 1) * mimic->offset;
    return true;
}

/* Each joint that mimics another leads to one that does not. */
bool check_mimics(const reading_t &reading) {
    const wh_urdf_file_t &file = *reading.file;
    for (size_t i = 1; i < file.link_count; ++i) {
        size_t steps = 0;
        for (int32_t at = int32_t(i); at >= 0 && steps <= file.link_count; ++steps) {
            at = file.links[at].mimics;
        }
        if (steps > file.link_count) {
            return refuse(reading, "joint \"%s\" mimics itself, by way of others", file.links[i].joint);
        }
    }
    return true;
}

/* -------------------------------------------------------------------------------------------------- links */

/* Lists the links from the root on, each behind its parent. */
bool list_links(reading_t &reading, const urdf::ModelInterface &model) {
    wh_urdf_file_t &file = *reading.file;
    if (model.links_.size() > WH_URDF_LINKS) {
        return refuse(reading, "%zu links (expected at most %d)", model.links_.size(), WH_URDF_LINKS);
    }
    reading.links.push_back(model.getRoot().get());
    file.links[0] = wh_urdf_link_t{};
    file.links[0].parent = file.links[0].mimics = -1;
    for (size_t i = 0; i < reading.links.size(); ++i) {
        for (const auto &child : reading.links[i]->child_links) {
            if (std::find(reading.links.begin(), reading.links.end(), child.get()) != reading.links.end()) {
                return refuse(reading, "link \"%s\" is the child of several joints (expected a tree)",
                              child->name.c_str());
            }
            file.links[reading.links.size()] = wh_urdf_link_t{};
            file.links[reading.links.size()].parent = int32_t(i);
            file.links[reading.links.size()].mimics = -1;
            reading.links.push_back(child.get());
        }
    }
    file.link_count = reading.links.size();
    return file.link_count == model.links_.size() ||
           refuse(reading, "%zu of %zu links hang on the root \"%s\" (expected a tree)", file.link_count,
                  model.links_.size(), reading.links[0]->name.c_str());
}

bool take_model(reading_t &reading, const urdf::ModelInterface &model) {
    wh_urdf_file_t &file = *reading.file;
    bool good = list_links(reading, model);
    for (size_t i = 0; good && i < file.link_count; ++i) {
        good = copy_name(reading, "link", reading.links[i]->name, file.links[i].name, WH_URDF_NAME) &&
               (i == 0 || take_joint(reading, *reading.links[i]->parent_joint, &file.links[i]));
    }
    for (size_t i = 0; good && i < file.link_count; ++i) {
        good = take_shapes(reading, i) && (i == 0 || take_mimic(reading, i));
    }
    return good && check_mimics(reading);
}

} // namespace

bool wh_urdf_read(const char *path, wh_urdf_file_t *file, char *message, size_t size) {
    reading_t reading = {path, file, message, size, {}};
    std::string text;
    std::string error;
    file->link_count = file->shape_count = 0;
    if (!read_text(reading, text) || !check_text(reading, text)) {
        return false;
    }
    std::replace(text.begin(), text.end(), '%', percent);
    TiXmlDocument document;
    if (!read_xml(reading, text, document)) {
        return false;
    }
    const urdf::ModelInterfaceSharedPtr model = parse(text, error);
    if (!model) {
        return refuse(reading, "%s", error.c_str());
    }
    return check_elements(reading, document) && take_model(reading, *model);
}
