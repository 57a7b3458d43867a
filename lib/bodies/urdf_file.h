/* A robot as a URDF file describes it: links, the joints between them, and the links' shapes. liburdfdom
 * reads it.
 *
 * Here lengths are mm and angles rad; a URDF's are m and rad. Links stand behind the one that they hang on,
 * so that one pass from the root places all. Reading needs no lock of the caller's. Ends the program if out
 * of memory.
 */
#ifndef WH_BODIES_URDF_FILE_H
#define WH_BODIES_URDF_FILE_H

#include <stddef.h>

#include "../collision/convex.h"

WH_HEADER_BEGIN

/* The largest file, and the most tags, links and shapes in it. */
#define WH_URDF_BYTES ((size_t)1 << 20)
#define WH_URDF_TAGS 8192
/* The most attributes of one element. */
#define WH_URDF_ATTRIBUTES 64
#define WH_URDF_LINKS 64
#define WH_URDF_SHAPES 64
/* The longest name of a link or joint, and of a mesh's file, with the terminator. */
#define WH_URDF_NAME 64
#define WH_URDF_PATH 512

/* The motion of a joint. `continuous` and `revolute` joints turn, `prismatic` ones slide. */
typedef enum { WH_URDF_FIXED, WH_URDF_TURNS, WH_URDF_SLIDES } wh_urdf_motion_t;

typedef struct {
    char name[WH_URDF_NAME];
    int32_t parent; /* comes before this one; -1: this is the root, and the rest means nothing */
    char joint[WH_URDF_NAME];
    wh_urdf_motion_t motion;
    wh_pose_t parent_from_joint; /* where the joint is at 0, the link's frame */
    wh_vec3_t axis;              /* of length 1, in that frame */
    bool is_limited;
    wh_real_t least, most; /* the joint's limits, mm or rad */
    /* `mimic`: the joint of link `mimics` times `factor` plus `offset` (mm or rad); -1: it follows none */
    int32_t mimics;
    wh_real_t factor, offset;
} wh_urdf_link_t;

/* A `collision` element, or a `visual` one of a link that has no `collision`. A ball is a capsule whose axis
 * has no length. */
typedef struct {
    int32_t link;
    wh_convex_t convex;      /* body_from_shape: in the link's frame; a mesh has no points yet */
    char mesh[WH_URDF_PATH]; /* as the file has it; empty: no mesh */
    wh_vec3_t scale;         /* of the mesh */
} wh_urdf_shape_t;

typedef struct {
    wh_urdf_link_t links[WH_URDF_LINKS]; /* the root first */
    size_t link_count;
    wh_urdf_shape_t shapes[WH_URDF_SHAPES];
    size_t shape_count;
} wh_urdf_file_t;

/* False with *file undefined: the file cannot be read or is too large; liburdfdom refuses it, or a part of
 * it other than how links are painted: an invalid number, or an unknown shape; its joints do not form a tree,
 * or one has another type; names are too long; counts are beyond the limits above. `message` then has one
 * line that names the file, the link or joint, the value and what was expected. Sizes of shapes are not
 * checked. */
bool wh_urdf_read(const char *path, wh_urdf_file_t *file, char *message, size_t size);

WH_HEADER_END

#endif
