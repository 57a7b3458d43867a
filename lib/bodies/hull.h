/* The corners of a body's convex hull, by libqhull.
 *
 * Reentrant; the library's memory is gone when the call returns. Ends the program if out of memory.
 */
#ifndef WH_BODIES_HULL_H
#define WH_BODIES_HULL_H

#include "../math/vector.h"

/* Keeps those of `points`, mm, that are corners of their convex hull, in their order, and sets *count to
 * their number. The other points lie within the hull or, to rounding, on it.
 *
 * False with all unchanged: the points lie in a plane, or are too few. `message` then has one line of
 * libqhull. Cost: about points times the logarithm of their number. */
bool wh_hull_reduce(wh_vec3_t points[], size_t *count, char *message, size_t size);

#endif
