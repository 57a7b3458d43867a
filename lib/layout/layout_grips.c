#include "grips.h"

#include <math.h>
#include <stdio.h>

#include "../math/trig.h"
#include "layout_internal.h"

/* ------------------------------------------------------------------------------------------------ reading */

static const char *const kinds[] = {"vacuum", "edge", "passive", NULL};

const char *wh_layout_grip_name(wh_grip_kind_t kind) {
    return kinds[kind];
}

static double larger(double a, double b) {
    return a > b ? a : b;
}

/* Each default is moved within the limits of the fields before it. */
static void read_windows(wh_reader_t *reader, wh_edge_t *edge) {
    const double open = -(edge->clearance + 1);
    edge->retracted =
        wh_reader_number(reader, "retracted", edge->retracted < open ? edge->retracted : open, -50, open);
    edge->gripped_from =
        wh_reader_number(reader, "gripped_from", edge->gripped_from, larger(-5, edge->retracted + 0.001), 5);
    edge->gripped_to =
        wh_reader_number(reader, "gripped_to", edge->gripped_from < edge->gripped_to ? edge->gripped_to : 5,
                         edge->gripped_from, 5);
    edge->end = larger(edge->end, edge->gripped_to + 1);
    if (wh_reader_has(reader, "stroke")) {
        edge->end = edge->retracted + wh_reader_number(reader, "stroke", WH_REAL(NAN),
                                                       edge->gripped_to - edge->retracted + 0.01,
                                                       10 - edge->retracted);
    }
}

static void read_edge(wh_reader_t *reader, const wh_layout_t *layout, wh_edge_t *edge) {
    const double radius = layout->wafer_diameter / 2;
    const double most = radius / 10 < 10 ? radius / 10 : 10;
    *edge = wh_edge_default(radius);
    wh_reader_open_section(reader, "grip", wh_layout_edge_grip_fields);
    (void)wh_reader_choice(reader, "kind", WH_GRIP_EDGE, (const char *const[]){"edge", NULL});
    edge->rest = wh_reader_number(reader, "rest", edge->rest, 0.1, 20);
    edge->plunger = wh_reader_number(reader, "plunger", edge->plunger, 0.1, 20);
    if (wh_reader_has(reader, "alpha")) {
        edge->alpha = wh_rad_from_deg(wh_reader_number(reader, "alpha", WH_REAL(NAN), 25, 60));
    }
    edge->clearance =
        wh_reader_number(reader, "clearance", edge->clearance < most ? edge->clearance : most, 0, most);
    read_windows(reader, edge);
    edge->speed = wh_reader_number(reader, "speed", edge->speed, 0.01, 1e4);
    wh_reader_leave(reader);
}

static void check_edge(wh_reader_t *reader, const wh_layout_t *layout, size_t g) {
    if (layout->wafer_diameter < 2 * 10 || layout->wafer_diameter > 2 * 300) {
        (void)wh_reader_push(reader, "grip");
        wh_reader_fail(reader, "grip", "\"vacuum\": an edge grip is for wafers from 20 to 600 mm");
    }
    if (layout->grippers[g].station != WH_NONE) {
        (void)wh_reader_push(reader, "grip");
        wh_reader_fail(reader, "grip", "\"vacuum\": an edge grip is on a robot");
    }
}

void wh_layout_read_grip(wh_reader_t *reader, wh_layout_t *layout, size_t g) {
    wh_grip_t *grip = &layout->grips[g];
    const int type = wh_reader_push(reader, "grip");
    const bool is_edge = type == LUA_TTABLE;
    if (type != LUA_TTABLE && type != LUA_TNIL && type != LUA_TSTRING) {
        wh_reader_fail(reader, "grip", "\"vacuum\", \"edge\", \"passive\" or { rest = , alpha = , ... }");
    }
    lua_pop(reader->L, 1);
    grip->kind =
        is_edge ? WH_GRIP_EDGE : (wh_grip_kind_t)wh_reader_choice(reader, "grip", WH_GRIP_VACUUM, kinds);
    if (grip->kind == WH_GRIP_PASSIVE && layout->grippers[g].station != WH_NONE &&
        !wh_layout_is_pins(layout, g)) {
        wh_reader_refuse(reader, "grip", "passive",
                         "\"vacuum\": a chuck holds the wafer that it turns; passive are blades and pins");
    }
    grip->edge = wh_edge_default(layout->wafer_diameter / 2);
    if (is_edge) {
        read_edge(reader, layout, &grip->edge);
    }
    if (grip->kind == WH_GRIP_EDGE) {
        check_edge(reader, layout, g);
    }
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

/* Why an edge grip cannot take a wafer with this rim; null if it can. */
static const char *refuses(const wh_edge_t *edge, const wh_rim_t *rim, const wh_edge_wafer_t *wafer) {
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
                        refuses(&layout->grips[g].edge, rim, &wafer) == NULL);
    }
    return good;
}

static void check_wafer(wh_reader_t *reader, const wh_layout_t *layout, const wh_edge_t *edge, size_t g,
                        size_t w) {
    const char *expected = refuses(edge, layout->rims[w], &layout->edge_wafers[w]);
    if (expected) {
        char field[64];
        (void)snprintf(field, sizeof field, "grippers[%zu].grip", g + 1);
        wh_reader_refuse(reader, field, wh_layout_grip_name(WH_GRIP_EDGE), "%s; %s is not such a wafer",
                         expected, layout->wafers[w].name);
    }
}

void wh_layout_read_edge_wafers(wh_reader_t *reader, wh_layout_t *layout) {
    if (!wh_layout_has_edge(layout)) {
        return;
    }
    wh_edge_wafer_t *wafers = wh_layout_memory(reader->L, layout->wafer_count, sizeof *wafers);
    layout->edge_wafers = wafers;
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        wafers[w] = wh_layout_edge_wafer(layout->rims[w]);
        for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
            if (layout->grips[g].kind == WH_GRIP_EDGE) {
                check_wafer(reader, layout, &layout->grips[g].edge, g, w);
            }
        }
    }
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
    static const char *const names[] = {"up or down", "up", "down"};
    return names[face];
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
