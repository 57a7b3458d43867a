/* A glTF 2.0 asset under construction: accessors, meshes, materials, nodes and one animation over one
 * buffer. Meshes and poses are given in mm and written in m.
 *
 * Host code: it ends the program if out of memory.
 */
#ifndef WH_SCENE_GLTF_H
#define WH_SCENE_GLTF_H

#include <jansson.h>

#include "../layout/inks.h"
#include "mesh.h"

/* A millimetre in glTF's unit, the metre. */
#define WH_GLTF_METRES 0.001

/* The parts of a mesh, one for each material. */
typedef struct {
    const wh_mesh_t *mesh;
    size_t material;
} wh_gltf_primitive_t;

/* It is read only; wh_gltf_open begins it. */
typedef struct {
    json_t *accessors, *views, *meshes, *materials, *nodes, *samplers, *channels, *children;
    uint8_t *bytes;
    size_t size, capacity;
} wh_gltf_t;

void wh_gltf_open(wh_gltf_t *gltf);

/* Each returns the index of the new entry. */
size_t wh_gltf_add_material(wh_gltf_t *gltf, const wh_ink_material_t *material);
size_t wh_gltf_add_mesh(wh_gltf_t *gltf, const char *name, const wh_gltf_primitive_t primitives[],
                        size_t count);

/* Adds a node at a place in the cell, mm; `mesh` may be SIZE_MAX: none. `kind` and `index` go to
 * its extras, because a name need not be unique. */
size_t wh_gltf_add_node(wh_gltf_t *gltf, const char *name, size_t mesh, const wh_pose_t *base_from_node,
                        const char *kind, size_t index);

/* The place of a node at a time. */
typedef struct {
    float time;     /* s */
    float place[3]; /* m */
    float turn[4];  /* a quaternion */
} wh_gltf_key_t;

/* The node moves from key to key, at rising times. */
void wh_gltf_add_motion(wh_gltf_t *gltf, size_t node, const wh_gltf_key_t keys[], size_t count);

/* The asset, which the caller releases. Its nodes hang on one called "cell", which turns z up to glTF's y
 * up. It frees the collected data. */
json_t *wh_gltf_finish(wh_gltf_t *gltf, const char *name, const char *generator);

#endif
