/* Shapes and gaps over libccd, beside waferhand.h: `double` only. Link with -lwaferhand_collision -lwaferhand
 * -lccd -lm. */
#ifndef WAFERHAND_COLLISION_H
#define WAFERHAND_COLLISION_H

/* In the order of the data flow. */
/* clang-format off */
#include "collision/convex.h"
#include "collision/gap.h"
#include "collision/tree.h"
#include "collision/arm.h"
#include "collision/world.h"
/* clang-format on */

#endif
