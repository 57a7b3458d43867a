/* Reads a convex body from an STL file, ASCII or binary, as the points of a convex mesh (collision/convex.h).
 *
 * STL has no unit, so the caller says it. Facets serve one purpose: to see that the body is convex. Their normals are not
 * looked at, nor is which way round their corners go, nor whether they close. The format: M. Burns, Automated Fabrication,
 * 1993, section 6.5. Host code: it allocates.
 */
#ifndef WH_LAYOUT_STL_H
#define WH_LAYOUT_STL_H

#include "../collision/convex.h"

/* The largest file, most facets and most different corners that are read. */
#define WH_STL_BYTES ((size_t)16 << 20)
#define WH_STL_FACETS 16384
#define WH_STL_POINTS 4096
/* A corner may stand out of a facet's plane by this much of the body's size, and for thin facets by what seven digits
 * leave open; what the facets enclose may then be that much smaller than the hull of the points. */
#define WH_STL_FLAT 1e-4

/* The different corners of the file's only solid, in mm, sorted by x, y, z: *points is from malloc and the caller's to
 * free. Together they are a mesh that wh_convex_validate finds good. `mm_per_unit`: such as 1, 25.4 or 1000.
 * False, and one line that names file, line (ASCII) or byte (binary) or facet (from 1), value and what was expected in
 * `message`, with *points and *count unchanged: the file cannot be read, is too large, is no STL or is cut off; a
 * coordinate is not finite or beyond WH_CONVEX_LARGEST; the body is not convex or is flat. Cost: facets times points. */
bool wh_stl_read(const char *path, wh_real_t mm_per_unit, wh_vec3_t **points, size_t *count, char *message,
                 size_t size);

/* The same from memory; `path` is what the message calls it. */
bool wh_stl_parse(const char *path, const char *bytes, size_t length, wh_real_t mm_per_unit,
                  wh_vec3_t **points, size_t *count, char *message, size_t size);

#endif
