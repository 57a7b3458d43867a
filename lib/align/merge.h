/* Several turns of one wafer as one: for each direction the mean of the turns' readings there.
 *
 * Noise shrinks by the root of the number of turns, and light that falls through glass in one of them is
 * left out. Errors that are equal in each turn, such as rounding without noise, remain. It uses no heap and
 * no state, and has equal bits on every machine.
 */
#ifndef WH_ALIGN_MERGE_H
#define WH_ALIGN_MERGE_H

#include "sensing.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(merge);

/* The most turns. */
#define WH_MERGE_TURNS 16

/* `points` are of one direction, one for each turn; `count` is from 1 to WH_MERGE_TURNS. If at least half
 * see the rim, the result is the mean of those within 0.2 mm of their median; otherwise it is the first
 * point that does not see it. The angle is the first's. Nothing is checked. Cost: the square of the
 * count. */
wh_rim_point_t wh_rim_points_merge(const wh_rim_point_t points[], size_t count)
    WH_SYMBOL(wh_rim_points_merge);

WH_HEADER_END

#endif
