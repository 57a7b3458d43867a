/* Reads a convex body from an STL file, ASCII or binary, as the points of a convex mesh (collision/convex.h).
 *
 * STL has no unit, so the caller gives it. The facets serve one purpose: to see that the body is convex.
 * Their normals, the order of their corners and gaps between them are ignored. The format: M. Burns,
 * Automated Fabrication, 1993, section 6.5. Ends the program if out of
 * memory.
 */
#ifndef WH_BODIES_STL_H
#define WH_BODIES_STL_H

#include "../collision/convex.h"

/* The largest file, the most facets and the most different corners: room for what CAD programs export. */
#define WH_STL_BYTES ((size_t)512 << 20)
#define WH_STL_FACETS 1000000
#define WH_STL_POINTS 65536
/* A convex mesh with more corners than this should be reduced to the corners of its hull. */
#define WH_STL_FEW 4096
/* A corner may stand out of a facet's plane by this fraction of the body's size; for thin facets also by what
 * seven digits leave open. The body that the facets enclose may be smaller than the hull of the points by
 * that much. */
#define WH_STL_FLAT 1e-4

/* Reads the different corners of the file's only solid, in mm, sorted by x, y, z. *points is from malloc and
 * the caller's to free. wh_convex_validate accepts the mesh of these points. `mm_per_unit`: such as 1, 25.4
 * or 1000.
 *
 * False with *points and *count unchanged: the file cannot be read, is too large, is no STL or is cut off; a
 * coordinate is not finite or beyond WH_CONVEX_LARGEST; the body is not convex or is flat. `message` then has
 * one line that names the file, the line (ASCII), byte (binary) or facet (from 1), the value and what was
 * expected.
 *
 * Cost: facets times points.
 */
bool wh_stl_read(const char *path, wh_real_t mm_per_unit, wh_vec3_t **points, size_t *count, char *message,
                 size_t size);

/* Like wh_stl_read, for a body that need not be convex and may have more than WH_STL_POINTS corners. */
bool wh_stl_read_body(const char *path, wh_real_t mm_per_unit, wh_vec3_t **points, size_t *count,
                      char *message, size_t size);

/* wh_stl_read from memory; messages call it `path`. */
bool wh_stl_parse(const char *path, const char *bytes, size_t length, wh_real_t mm_per_unit,
                  wh_vec3_t **points, size_t *count, char *message, size_t size);

#endif
