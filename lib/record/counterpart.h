/* Chooses the wafer that a gripper is measured against, for displays. lcm-spy, WAFERHAND_PROXIMITY and
 * reports agree on it. */
#ifndef WH_RECORD_COUNTERPART_H
#define WH_RECORD_COUNTERPART_H

#include "../cell/station.h"
#include "../sim/slice.h"

/* The wafer that gripper `g` holds. Otherwise, of `count` candidates (indices of wafers; null: the first
 * `count` wafers), the one that is nearest to the three limits together. A wafer uses a share of each
 * limit: |dr_proj_z| / projz, |dr_proj_xy| / projxy and (1 - n1_proj_n2) / (1 - planar). Its largest share
 * counts; the wafer with the smallest wins, the first of equals. So a wafer that is ready comes before one
 * that is not, wherever its centre lies. Where the cell has faces, the face that looks at the gripper
 * counts. WH_NONE if there is no candidate. Poses must be valid ones. Cost: linear in the candidates, about
 * 30 products each, 6 for those that are too high or too low. */
int32_t wh_counterpart(const wh_state_t *state, size_t g, const wh_cell_t *cell, const int32_t *candidates,
                       size_t count);

#endif
