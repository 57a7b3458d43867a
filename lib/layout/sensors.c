/* The beams, blocks and edge sensors of a layout: which belong to what, and where they stand. */
#include "layout.h"

bool wh_layout_is_usual(const wh_layout_t *layout, size_t robot) {
    if (!wh_layout_is_shared(layout)) {
        return !layout->machine.carrier;
    }
    const wh_chain_t *chain = &layout->robots[robot].carrier.chain;
    return chain->kind == WH_CHAIN_TRZY && !chain->has_rail && !chain->has_tilt && !chain->has_flip;
}

wh_latch_order_t wh_layout_beams_at(const wh_layout_t *layout, size_t station) {
    wh_latch_order_t order = {WH_LATCH_ARM, 0, 0};
    for (size_t b = 0; b < layout->beam_count; ++b) {
        if (layout->doors[b].kind == WH_DOOR_LIGHT && (size_t)layout->beams[b].station == station) {
            order.first = order.count == 0 ? (int32_t)b : order.first;
            ++order.count;
        }
    }
    return order;
}

wh_latch_order_t wh_layout_beams_of(const wh_layout_t *layout, size_t station, size_t robot) {
    const wh_layout_approach_t *by = layout->stations[station].by;
    if (by) {
        return (wh_latch_order_t){WH_LATCH_ARM, by[robot].first_beam, by[robot].beam_count};
    }
    return wh_layout_beams_at(layout, station);
}

bool wh_layout_centres(const wh_layout_t *layout, size_t station, size_t robot) {
    const wh_layout_station_t *of = &layout->stations[station];
    return of->by ? of->by[robot].centre : of->centre;
}

wh_latch_order_t wh_layout_face_at(const wh_layout_t *layout, size_t station, size_t face) {
    for (size_t b = 0; b < layout->beam_count; ++b) {
        if (layout->doors[b].kind == WH_DOOR_TOUCH && (size_t)layout->beams[b].station == station) {
            return (wh_latch_order_t){WH_LATCH_ARM, (int32_t)(b + face), 1};
        }
    }
    return (wh_latch_order_t){WH_LATCH_ARM, 0, 0};
}

wh_block_face_t wh_layout_block_face(const wh_layout_block_t *block, size_t face) {
    wh_block_face_t found = {{block->at[0], block->at[1], block->at[2] - block->size[2] / 2}, face, -1};
    if (face == 0) {
        found.middle[0] -= block->size[0] / 2;
    } else if (face == 1) {
        found.middle[1] -= block->size[1] / 2;
    } else {
        found.middle[2] = block->at[2];
        found.sign = 1;
    }
    return found;
}

static void take_vector(const wh_vec3_t *from, double to[3]) {
    to[0] = (double)from->x;
    to[1] = (double)from->y;
    to[2] = (double)from->z;
}

static void place_face(wh_layout_t *layout, size_t b) {
    const int32_t station = layout->beams[b].station;
    const wh_layout_block_t *block = &layout->stations[station].block;
    const wh_pose_t *place = &layout->places[station].base_from_station;
    const size_t number = b - (size_t)wh_layout_face_at(layout, (size_t)station, 0).first;
    const wh_block_face_t face = wh_layout_block_face(block, number);
    wh_touch_face_t *touch = &layout->doors[b].touch;
    const size_t edge = (face.axis + 1) % 3;
    const wh_vec3_t middle = {(wh_real_t)face.middle[0], (wh_real_t)face.middle[1],
                              (wh_real_t)face.middle[2]};
    const wh_vec3_t at = wh_pose_point(place, &middle);
    const wh_mat3_t *R = &place->R;
    take_vector(&at, touch->middle);
    for (size_t i = 0; i < 3; ++i) {
        touch->normal[i] = face.sign * (double)R->m[i][face.axis];
        touch->edge[i] = (double)R->m[i][edge];
    }
    touch->along = block->size[edge] / 2;
    touch->aside = block->size[(face.axis + 2) % 3] / 2;
}

void wh_layout_place_beam(wh_layout_t *layout, size_t b) {
    if (layout->doors[b].kind == WH_DOOR_TOUCH) {
        place_face(layout, b);
        return;
    }
    const wh_layout_beam_t *beam = &layout->beams[b];
    const wh_pose_t *place = &layout->places[beam->station].base_from_station;
    layout->doors[b].beam = wh_beam_at(place, beam->x + beam->dx, beam->y + beam->dy, beam->low, beam->high);
}

wh_latching_t wh_layout_latching(const wh_layout_t *layout) {
    const wh_latching_t latching = {layout->doors, layout->beam_count, layout->rims, layout->blades};
    return latching;
}

wh_scanning_t wh_layout_scanning(const wh_layout_t *layout) {
    const wh_scanning_t scanning = {layout->scanners, layout->scanner_count, layout->rims};
    return scanning;
}

const wh_scanner_t *wh_layout_scanner(const wh_layout_t *layout, int32_t gripper) {
    for (size_t i = 0; gripper != WH_NONE && i < layout->scanner_count; ++i) {
        if (layout->scanners[i].gripper == gripper) {
            return &layout->scanners[i];
        }
    }
    return NULL;
}
