/* The pose of a second frame as seen from a first one, for scripts; a report's measuring tool shows these
 * values. */
#ifndef WH_MATH_RELATION_H
#define WH_MATH_RELATION_H

#include "pose.h"

WH_HEADER_BEGIN
WH_REFUSE_PACKING(relation);

typedef struct {
    wh_real_t distance; /* between the origins, mm */
    wh_vec3_t r;        /* from the first origin to the second, in the first frame's axes, mm */
    wh_real_t angle;    /* between the two z axes, rad, 0 to pi */
    wh_real_t turn;     /* the whole rotation from the first to the second, rad, 0 to pi */
} wh_relation_t;

/* Both poses are base_from_frame and valid. Angles are exact to about 1e-15 in the whole range, also small
 * ones and those near pi. */
wh_relation_t wh_relate(const wh_pose_t *first, const wh_pose_t *second) WH_SYMBOL(wh_relate);

WH_HEADER_END

#endif
