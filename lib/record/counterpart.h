/* Which wafer a gripper is measured against, for people to look at: the same one in lcm-spy, on
 * WAFERHAND_PROXIMITY and in a report. */
#ifndef WH_RECORD_COUNTERPART_H
#define WH_RECORD_COUNTERPART_H

#include "../cell/station.h"
#include "../sim/slice.h"

/* The wafer that gripper `g` holds; else, of `count` candidates (indices of wafers; null: the first `count`
 * wafers), the one that comes nearest to the three limits together. Of each limit a wafer uses a share:
 * |dr_proj_z| / projz, |dr_proj_xy| / projxy and (1 - n1_proj_n2) / (1 - planar). A wafer counts by its
 * largest share, the smallest of these wins, the first of equals. So a wafer that is ready comes before one
 * that is not, wherever its centre lies. Of a wafer the face counts that looks at the gripper, where the cell
 * has faces. WH_NONE if there is no candidate. Poses must be valid ones.
 * Cost: linear in the candidates, about 30 products each, 6 for those that are too high or too low. */
int32_t wh_counterpart(const wh_state_t *state, size_t g, const wh_cell_t *cell, const int32_t *candidates,
                       size_t count);

#endif
