#include "grips.h"

#include "../math/trig.h"
#include "words.h"

const char *wh_layout_grip_name(wh_grip_kind_t kind) {
    return wh_layout_grip_words[kind];
}

/* --------------------------------------------------------------------------------- what edges they meet */

static bool has_kind(const wh_layout_t *layout, wh_grip_kind_t kind) {
    bool any = false;
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        any = any || layout->grips[g].kind == kind;
    }
    return any;
}

bool wh_layout_has_edge(const wh_layout_t *layout) {
    return has_kind(layout, WH_GRIP_EDGE);
}

bool wh_layout_has_rims(const wh_layout_t *layout) {
    return layout->scanner_count + layout->beam_count > 0 || wh_layout_has_edge(layout);
}

wh_edge_wafer_t wh_layout_edge_wafer(const wh_rim_t *rim) {
    wh_real_t sine;
    wh_real_t cosine;
    wh_sin_cos((wh_real_t)rim->notch.direction, &sine, &cosine);
    const wh_edge_wafer_t wafer = {.radius = rim->radius,
                                   .depth = rim->notch.depth,
                                   .opening = rim->notch.opening,
                                   .bottom = rim->notch.bottom,
                                   .notch_x = cosine,
                                   .notch_y = sine};
    return wafer;
}

const char *wh_layout_edge_refuses(const wh_edge_t *edge, const wh_rim_t *rim, const wh_edge_wafer_t *wafer) {
    const double apart = rim->radius - edge->radius;
    if (rim->flats[0].length > 0 || rim->flats[1].length > 0) {
        return "wafers without flats: an edge grip holds what is round but for a notch";
    }
    if (apart > 1 || apart < -1) {
        return "wafers within 2 mm of wafer.diameter";
    }
    return wh_edge_wafer_validate(edge, wafer) == WH_OK
               ? NULL
               : "wafers with a notch of depth 0, or from 0.2 mm to a hundredth of the diameter, of 85 to "
                 "120 "
                 "degrees, with a bottom no rounder than its rests and its plunger";
}

bool wh_layout_edges_take(const wh_layout_t *layout, const wh_rim_t *rim) {
    const wh_edge_wafer_t wafer = wh_layout_edge_wafer(rim);
    bool good = true;
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        good = good && (layout->grips[g].kind != WH_GRIP_EDGE ||
                        wh_layout_edge_refuses(&layout->grips[g].edge, rim, &wafer) == NULL);
    }
    return good;
}

/* ------------------------------------------------------------------------------------------- simulators */

void wh_layout_find_faces(wh_layout_t *layout) {
    for (const wh_carrier_t *robot = layout->machine.carrier; robot; robot = robot->next) {
        layout->has_faces = layout->has_faces || robot->chain.has_flip;
    }
    layout->cell.thickness = layout->has_faces ? layout->wafer_thickness : 0;
}

bool wh_layout_has_grips(const wh_layout_t *layout) {
    bool any = layout->has_faces;
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        any = any || layout->grips[g].kind != WH_GRIP_VACUUM;
    }
    return any;
}

wh_grips_parts_t wh_layout_grips(const wh_layout_t *layout) {
    const wh_grips_parts_t parts = {.thickness = layout->cell.thickness,
                                    .dt = (double)layout->slice_us / 1e6,
                                    .grips = layout->grips,
                                    .shapes = layout->edge_wafers,
                                    .supports = layout->supports,
                                    .support_count = layout->support_count};
    return parts;
}

bool wh_layout_complete_grips(const wh_layout_t *layout, const wh_gripper_t grippers[],
                              wh_physics_state_t *physics) {
    const wh_grips_parts_t parts = wh_layout_grips(layout);
    return wh_grips_complete(&parts, grippers, layout->machine.gripper_count, layout->wafer_count,
                             physics->grips) == WH_OK;
}

bool wh_layout_has_passive(const wh_layout_t *layout) {
    return has_kind(layout, WH_GRIP_PASSIVE);
}

size_t wh_layout_count_supports(const wh_layout_t *layout) {
    size_t count = 0;
    for (size_t s = 0; wh_layout_has_passive(layout) && s < layout->station_count; ++s) {
        count += (size_t)layout->places[s].slots;
    }
    return count;
}

void wh_layout_take_supports(wh_layout_t *layout, wh_pose_t supports[]) {
    layout->supports = supports;
    layout->support_count = 0;
    for (size_t s = 0; wh_layout_has_passive(layout) && s < layout->station_count; ++s) {
        for (int32_t slot = 1; slot <= layout->places[s].slots; ++slot) {
            supports[layout->support_count++] = wh_station_slot(&layout->places[s], slot);
        }
    }
}

size_t wh_layout_seen(const wh_layout_t *layout) {
    return wh_layout_has_grips(layout) ? layout->wafer_count : 0;
}

size_t wh_layout_buckets(const wh_layout_t *layout) {
    return wh_layout_has_grips(layout) ? 0
                                       : wh_grasp_buckets(layout->wafer_count, layout->machine.gripper_count);
}

wh_status_t wh_layout_give_grips(const wh_layout_t *layout, wh_simulator_t *simulator,
                                 wh_grips_room_t *room) {
    if (!wh_layout_has_grips(layout)) {
        return WH_OK;
    }
    wh_grips_parts_t parts = wh_layout_grips(layout);
    parts.states = simulator->physics.grips;
    parts.seen = room->seen;
    return wh_simulator_set_grips(simulator, &parts);
}

wh_pose_t wh_layout_lying(const wh_layout_t *layout, int32_t station, int32_t slot) {
    const bool down = layout->stations[station].face == WH_STATION_FACE_DOWN;
    const wh_pose_t base_from_face = wh_station_slot(&layout->places[station], slot);
    wh_pose_t base_from_wafer;
    wh_face_frame(&base_from_face, layout->wafer_thickness, down ? WH_FACE_FRONT : WH_FACE_BACK,
                  &base_from_wafer);
    return base_from_wafer;
}

const char *wh_layout_face_name(wh_station_face_t face) {
    return face == WH_STATION_ANY_FACE ? "up or down" : wh_layout_face_words[face - WH_STATION_FACE_UP];
}

bool wh_layout_is_face_down(const wh_pose_t *base_from_wafer) {
    return base_from_wafer->R.m[2][2] < 0;
}

const char *wh_layout_face_of(const wh_pose_t *base_from_wafer) {
    return wh_layout_is_face_down(base_from_wafer) ? "down" : "up";
}

wh_face_t wh_layout_face_towards(const wh_layout_t *layout, const wh_pose_t *base_from_wafer,
                                 const wh_pose_t *base_from_gripper) {
    return layout->has_faces ? wh_face_towards(base_from_wafer, base_from_gripper) : WH_FACE_BACK;
}

wh_status_t wh_layout_measure(const wh_layout_t *layout, const wh_pose_t *base_from_wafer,
                              const wh_pose_t *base_from_gripper, wh_proximity_t *result) {
    const wh_tolerance_t *tolerance = &layout->grasp.tolerance;
    wh_face_t face;
    return layout->has_faces ? wh_face_measure(base_from_wafer, layout->cell.thickness, base_from_gripper,
                                               tolerance, &face, result)
                             : wh_proximity_measure(base_from_wafer, base_from_gripper, tolerance, result);
}
