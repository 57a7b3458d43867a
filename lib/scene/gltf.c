#include "gltf.h"

#include <stdlib.h>
#include <string.h>

#include "../record/quaternion.h"
#include "../text/array.h"
#include "../text/json.h"
#include "../text/packed.h"

/* glTF's numbers for types and targets. */
enum {
    TYPE_USHORT = 5123,
    TYPE_UINT = 5125,
    TYPE_FLOAT = 5126,
    TARGET_VERTICES = 34962,
    TARGET_INDICES = 34963
};

void wh_gltf_open(wh_gltf_t *gltf) {
    memset(gltf, 0, sizeof *gltf);
    json_t **const lists[] = {&gltf->accessors, &gltf->views,    &gltf->meshes,   &gltf->materials,
                              &gltf->nodes,     &gltf->samplers, &gltf->channels, &gltf->children};
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; ++i) {
        *lists[i] = json_array();
    }
}

static size_t append(json_t *list, json_t *value) {
    if (!value || json_array_append_new(list, value) != 0) {
        wh_memory_out();
    }
    return json_array_size(list) - 1;
}

static json_t *index_of(size_t index) {
    return json_integer((json_int_t)index);
}

static json_t *list_of(const double values[], size_t count) {
    json_t *list = json_array();
    for (size_t i = 0; i < count; ++i) {
        (void)append(list, json_real(values[i]));
    }
    return list;
}

/* ------------------------------------------------------------------------------------------------- buffer */

static size_t add_view(wh_gltf_t *gltf, const void *data, size_t size, int target) {
    const size_t padded = (size + 3) / 4 * 4;
    gltf->bytes = wh_array_reserve(gltf->bytes, gltf->size + padded, &gltf->capacity, 1);
    memset(gltf->bytes + gltf->size, 0, padded);
    memcpy(gltf->bytes + gltf->size, data, size);
    json_t *view = json_pack("{s:i, s:o, s:o}", "buffer", 0, "byteOffset", index_of(gltf->size), "byteLength",
                             index_of(size));
    if (target != 0) {
        (void)json_object_set_new(view, "target", json_integer(target));
    }
    gltf->size += padded;
    return append(gltf->views, view);
}

static size_t add_accessor(wh_gltf_t *gltf, size_t view, int type, const char *shape, size_t count) {
    return append(gltf->accessors, json_pack("{s:o, s:i, s:o, s:s}", "bufferView", index_of(view),
                                             "componentType", type, "count", index_of(count), "type", shape));
}

/* glTF requires the least and the greatest of each component. */
static void set_bounds(wh_gltf_t *gltf, size_t accessor, const float *data, size_t width, size_t count) {
    double low[4];
    double high[4];
    for (size_t c = 0; c < width; ++c) {
        low[c] = high[c] = (double)data[c];
        for (size_t i = 1; i < count; ++i) {
            const double value = (double)data[i * width + c];
            low[c] = value < low[c] ? value : low[c];
            high[c] = value > high[c] ? value : high[c];
        }
    }
    json_t *made = json_array_get(gltf->accessors, accessor);
    (void)json_object_set_new(made, "min", list_of(low, width));
    (void)json_object_set_new(made, "max", list_of(high, width));
}

/* `width` numbers of each of `count` items; an item is `stride` numbers long. */
typedef struct {
    const float *first;
    size_t stride, width, count;
    float scale;
    bool has_bounds;
} numbers_t;

static size_t add_floats(wh_gltf_t *gltf, const numbers_t *of, int target) {
    static const char *const shapes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    const size_t count = of->width * of->count;
    float *values = wh_array_new(count, sizeof *values);
    for (size_t i = 0; i < count; ++i) {
        values[i] = of->first[i / of->width * of->stride + i % of->width] * of->scale;
    }
    const size_t view = add_view(gltf, values, count * sizeof *values, target);
    const size_t accessor = add_accessor(gltf, view, TYPE_FLOAT, shapes[of->width], of->count);
    if (of->has_bounds) {
        set_bounds(gltf, accessor, values, of->width, of->count);
    }
    free(values);
    return accessor;
}

/* -------------------------------------------------------------------------------------- materials, meshes */

size_t wh_gltf_add_material(wh_gltf_t *gltf, const wh_ink_material_t *material) {
    const double colour[4] = {material->red, material->green, material->blue, material->opacity};
    const bool clear = material->opacity < 1;
    json_t *made = json_pack("{s:s, s:{s:o, s:f, s:f}, s:s, s:b}", "name", material->name,
                             "pbrMetallicRoughness", "baseColorFactor", list_of(colour, 4), "metallicFactor",
                             material->metallic, "roughnessFactor", material->roughness, "alphaMode",
                             clear ? "BLEND" : "OPAQUE", "doubleSided", clear ? 1 : 0);
    return append(gltf->materials, made);
}

static size_t add_indices(wh_gltf_t *gltf, const wh_mesh_t *mesh) {
    const size_t count = mesh->index_count;
    const bool is_narrow = mesh->vertex_count <= UINT16_MAX;
    uint16_t *narrow = wh_array_new(count, sizeof *narrow);
    for (size_t i = 0; i < count; ++i) {
        narrow[i] = (uint16_t)mesh->indices[i];
    }
    const size_t view = is_narrow
                            ? add_view(gltf, narrow, count * sizeof *narrow, TARGET_INDICES)
                            : add_view(gltf, mesh->indices, count * sizeof *mesh->indices, TARGET_INDICES);
    free(narrow);
    return add_accessor(gltf, view, is_narrow ? TYPE_USHORT : TYPE_UINT, "SCALAR", count);
}

size_t wh_gltf_add_mesh(wh_gltf_t *gltf, const char *name, const wh_gltf_primitive_t primitives[],
                        size_t count) {
    json_t *list = json_array();
    for (size_t i = 0; i < count; ++i) {
        const wh_mesh_t *mesh = primitives[i].mesh;
        const float *vertices = mesh->vertices[0];
        const numbers_t places = {vertices, 6, 3, mesh->vertex_count, (float)WH_GLTF_METRES, true};
        const numbers_t normals = {vertices + 3, 6, 3, mesh->vertex_count, 1, false};
        const size_t place = add_floats(gltf, &places, TARGET_VERTICES);
        const size_t normal = add_floats(gltf, &normals, TARGET_VERTICES);
        (void)append(list, json_pack("{s:{s:o, s:o}, s:o, s:o}", "attributes", "POSITION", index_of(place),
                                     "NORMAL", index_of(normal), "indices", index_of(add_indices(gltf, mesh)),
                                     "material", index_of(primitives[i].material)));
    }
    return append(gltf->meshes, json_pack("{s:o, s:o}", "name", wh_json_text(name), "primitives", list));
}

/* -------------------------------------------------------------------------------------------------- nodes */

size_t wh_gltf_add_node(wh_gltf_t *gltf, const char *name, size_t mesh, const wh_pose_t *base_from_node,
                        const char *kind, size_t index) {
    const double place[3] = {WH_GLTF_METRES * base_from_node->r.x, WH_GLTF_METRES * base_from_node->r.y,
                             WH_GLTF_METRES * base_from_node->r.z};
    double turn[4];
    wh_quaternion_from_matrix(&base_from_node->R, NULL, turn);
    json_t *node = json_pack("{s:o, s:o, s:o}", "name", wh_json_text(name), "translation", list_of(place, 3),
                             "rotation", list_of(turn, 4));
    if (mesh != SIZE_MAX) {
        (void)json_object_set_new(node, "mesh", index_of(mesh));
    }
    (void)json_object_set_new(node, "extras",
                              json_pack("{s:s, s:o}", "kind", kind, "index", index_of(index)));
    const size_t added = append(gltf->nodes, node);
    (void)append(gltf->children, index_of(added));
    return added;
}

static void add_channel(wh_gltf_t *gltf, size_t node, const char *path, size_t input, size_t output) {
    const size_t sampler =
        append(gltf->samplers, json_pack("{s:o, s:o, s:s}", "input", index_of(input), "output",
                                         index_of(output), "interpolation", "LINEAR"));
    (void)append(gltf->channels, json_pack("{s:o, s:{s:o, s:s}}", "sampler", index_of(sampler), "target",
                                           "node", index_of(node), "path", path));
}

void wh_gltf_add_motion(wh_gltf_t *gltf, size_t node, const wh_gltf_key_t keys[], size_t count) {
    enum { STRIDE = sizeof keys[0] / sizeof(float) };
    const numbers_t times = {&keys->time, STRIDE, 1, count, 1, true};
    const numbers_t places = {keys->place, STRIDE, 3, count, 1, false};
    const numbers_t turns = {keys->turn, STRIDE, 4, count, 1, false};
    const size_t input = add_floats(gltf, &times, 0);
    add_channel(gltf, node, "translation", input, add_floats(gltf, &places, 0));
    add_channel(gltf, node, "rotation", input, add_floats(gltf, &turns, 0));
}

/* ---------------------------------------------------------------------------------------------- finishing */

/* The buffer as a data URI, so that the asset is one file. */
static json_t *data_uri(const wh_gltf_t *gltf) {
    char *text = wh_packed_bytes("data:application/octet-stream;base64,", gltf->bytes, gltf->size);
    json_t *uri = json_string(text);
    free(text);
    return uri;
}

static void set_list(json_t *root, const char *key, json_t *list) {
    if (json_array_size(list) > 0) {
        (void)json_object_set(root, key, list);
    }
    json_decref(list);
}

json_t *wh_gltf_finish(wh_gltf_t *gltf, const char *name, const char *generator) {
    /* From z up to y up: -90 degrees about x. */
    static const double turn[4] = {-0.70710678118654752, 0, 0, 0.70710678118654752};
    const size_t cell = append(gltf->nodes, json_pack("{s:s, s:o, s:o}", "name", "cell", "rotation",
                                                      list_of(turn, 4), "children", gltf->children));
    json_t *root =
        json_pack("{s:{s:s, s:s}, s:i, s:[{s:o, s:[o]}]}", "asset", "version", "2.0", "generator", generator,
                  "scene", 0, "scenes", "name", wh_json_text(name), "nodes", index_of(cell));
    if (json_array_size(gltf->channels) > 0) {
        (void)json_object_set_new(root, "animations",
                                  json_pack("[{s:s, s:O, s:O}]", "name", "run", "channels", gltf->channels,
                                            "samplers", gltf->samplers));
    }
    json_decref(gltf->channels);
    json_decref(gltf->samplers);
    set_list(root, "nodes", gltf->nodes);
    set_list(root, "meshes", gltf->meshes);
    set_list(root, "materials", gltf->materials);
    set_list(root, "accessors", gltf->accessors);
    set_list(root, "bufferViews", gltf->views);
    if (gltf->size > 0) {
        (void)json_object_set_new(
            root, "buffers",
            json_pack("[{s:o, s:o}]", "byteLength", index_of(gltf->size), "uri", data_uri(gltf)));
    }
    free(gltf->bytes);
    memset(gltf, 0, sizeof *gltf);
    return root;
}
