/* Notches that lie over a rest when an edge grip takes the wafer: it sinks in there. */
#include <math.h>
#include <stdio.h>

#include "../math/trig.h"
#include "feasibility_internal.h"

/* No notch is wider than this to either side, seen from the centre, rad. */
#define WIDEST WH_REAL(0.2)

static bool meets(const wh_edge_t *edge, const wh_edge_wafer_t *wafer, int side) {
    const double out = edge->radius + edge->rest;
    const double across = (double)wh_sin((wh_real_t)edge->alpha);
    return wh_edge_meets_notch(wafer, out * (double)wh_cos((wh_real_t)edge->alpha), side * out * across);
}

/* Where the middle of a wafer is once both rests touch it, along the blade. */
static double seated_at(const wh_edge_t *edge, double radius) {
    const double out = edge->radius + edge->rest;
    const double across = out * (double)wh_sin((wh_real_t)edge->alpha);
    const double reach = radius + edge->rest;
    return out * (double)wh_cos((wh_real_t)edge->alpha) - sqrt(reach * reach - across * across);
}

/* Where the rest at +y is as seen from the middle of the wafer, rad. */
static wh_real_t direction_of(const wh_edge_t *edge, const wh_edge_wafer_t *wafer) {
    const double out = edge->radius + edge->rest;
    return wh_atan2((wh_real_t)out * wh_sin((wh_real_t)edge->alpha),
                    (wh_real_t)out * wh_cos((wh_real_t)edge->alpha) - (wh_real_t)wafer->x);
}

/* How far beside a rest a notch must point, rad: halved to a microradian. */
static wh_real_t width_of(const wh_edge_t *edge, const wh_edge_wafer_t *wafer) {
    const wh_real_t rest = direction_of(edge, wafer);
    wh_real_t inside = 0;
    wh_real_t outside = WIDEST;
    while (outside - inside > WH_REAL(1e-6)) {
        const wh_real_t middle = (inside + outside) / 2;
        wh_edge_wafer_t turned = *wafer;
        turned.notch_x = (double)wh_cos(rest + middle);
        turned.notch_y = (double)wh_sin(rest + middle);
        *(meets(edge, &turned, 1) ? &inside : &outside) = middle;
    }
    return outside;
}

wh_edge_wafer_t wh_feasibility_lying(const wh_layout_t *layout, size_t w) {
    const wh_layout_wafer_t *from = &layout->wafers[w];
    const wh_pose_t blade = wh_layout_come_level(layout, &layout->places[from->station], from->slot);
    const wh_edge_wafer_t *shape = &layout->edge_wafers[w];
    const wh_vec3_t axis = wh_vec3((wh_real_t)shape->notch_x, (wh_real_t)shape->notch_y, 0);
    const wh_vec3_t in_base = wh_mat3_transform(&layout->start[w].base_from_wafer.R, &axis);
    const wh_vec3_t on_blade = wh_mat3_transform_back(&blade.R, &in_base);
    const double length = sqrt((double)(on_blade.x * on_blade.x + on_blade.y * on_blade.y));
    wh_edge_wafer_t lying = *shape;
    lying.notch_x = length > 0 ? (double)on_blade.x / length : 0;
    lying.notch_y = length > 0 ? (double)on_blade.y / length : 1;
    return lying;
}

/* -------------------------------------------------------------------------------------- where to turn it */

/* Two rests, the plunger, and two crossings of each beam. */
#define MOST_DIRECTIONS (3 + 2 * WH_BEAMS)

/* On the blade, degrees from 0 to 360, in their order. */
typedef struct {
    double at[MOST_DIRECTIONS];
    size_t count;
} directions_t;

static void add_direction(directions_t *directions, double degrees) {
    const double turned = degrees < 0 ? degrees + 360 : degrees;
    size_t i = directions->count++;
    for (; i > 0 && directions->at[i - 1] > turned; --i) {
        directions->at[i] = directions->at[i - 1];
    }
    directions->at[i] = turned;
}

/* Adds both places of the rim that a beam sees as the blade comes into a slot. The beam stands `y` beside the
 * way. */
static void add_crossings(directions_t *directions, double radius, double y) {
    if (y * y < radius * radius) {
        const wh_real_t x = wh_real_sqrt((wh_real_t)(radius * radius - y * y));
        add_direction(directions, (double)wh_deg_from_rad(wh_atan2((wh_real_t)y, x)));
        add_direction(directions, (double)wh_deg_from_rad(wh_atan2((wh_real_t)y, -x)));
    }
}

static void find_directions(const wh_layout_t *layout, const wh_edge_t *edge, const wh_edge_wafer_t *wafer,
                            directions_t *directions) {
    const double rest = (double)wh_deg_from_rad(direction_of(edge, wafer));
    directions->count = 0;
    add_direction(directions, rest);
    add_direction(directions, -rest);
    add_direction(directions, 180);
    for (size_t b = 0; b < layout->beam_count; ++b) {
        if (layout->doors[b].kind == WH_DOOR_LIGHT) {
            add_crossings(directions, wafer->radius, (double)layout->beams[b].y);
        }
    }
}

/* "-29.5 to 29.5, 30.5 to 179.5": the rest of a turn, without `width` on both sides of each direction. */
static void put_ranges(const directions_t *directions, double width, char *text, size_t size) {
    size_t length = 0;
    text[0] = 0;
    for (size_t i = 0; i < directions->count && length < size; ++i) {
        const double before = i > 0 ? directions->at[i - 1] : directions->at[directions->count - 1] - 360;
        const double from = before + width;
        const double to = directions->at[i] - width;
        if (from < to) {
            const int put =
                snprintf(text + length, size - length, "%s%.4g to %.4g", length > 0 ? ", " : "", from, to);
            length += put > 0 ? (size_t)put : 0;
        }
    }
}

/* True if a rest of the station's edge grip meets the wafer's notch, which lies so on the gripper. */
static bool is_met(const wh_layout_t *layout, size_t w, wh_edge_wafer_t *lying) {
    const int32_t gripper = layout->stations[layout->wafers[w].station].effector;
    const wh_edge_t *edge = &layout->grips[gripper].edge;
    if (layout->grips[gripper].kind != WH_GRIP_EDGE || !(layout->edge_wafers[w].depth > 0)) {
        return false;
    }
    *lying = wh_feasibility_lying(layout, w);
    lying->x = seated_at(edge, lying->radius);
    return meets(edge, lying, 1) || meets(edge, lying, -1);
}

/* How many behind this wafer lie so at its station. */
static size_t count_more(const wh_layout_t *layout, size_t w) {
    size_t count = 0;
    for (size_t other = w + 1; other < layout->wafer_count; ++other) {
        wh_edge_wafer_t lying;
        const bool is_there = layout->wafers[other].station == layout->wafers[w].station;
        count += is_there && is_met(layout, other, &lying) ? 1 : 0;
    }
    return count;
}

static void say_met(wh_feasibility_t *check, size_t w, int32_t gripper, const wh_edge_wafer_t *lying) {
    const wh_layout_t *layout = check->layout;
    const wh_edge_t *edge = &layout->grips[gripper].edge;
    const int32_t station = layout->wafers[w].station;
    directions_t directions;
    char ranges[320], others[60] = "";
    find_directions(layout, edge, lying, &directions);
    put_ranges(&directions, (double)wh_deg_from_rad(width_of(edge, lying)), ranges, sizeof ranges);
    const size_t more = count_more(layout, w);
    if (more > 0) {
        (void)snprintf(others, sizeof others, " (and so do those of %zu more there)", more);
    }
    wh_finding_t *finding = wh_feasibility_add(
        check, WH_FINDING_REST, station,
        "%s slot %d: the notch of %s points to %.4g degrees of %s, where a rest is, and sinks in there%s; "
        "ALIGN keeps it off rests, plunger and beams at %s degrees",
        layout->stations[station].name, (int)layout->wafers[w].slot, layout->wafers[w].name,
        (double)wh_deg_from_rad(wh_atan2((wh_real_t)lying->notch_y, (wh_real_t)lying->notch_x)),
        layout->grippers[gripper].name, others, ranges);
    finding->slot = layout->wafers[w].slot;
    wh_feasibility_warn(check);
}

void wh_feasibility_rests(wh_feasibility_t *check) {
    const wh_layout_t *layout = check->layout;
    int32_t said = WH_NONE;
    for (size_t w = 0; layout->edge_wafers && w < layout->wafer_count; ++w) {
        const int32_t station = layout->wafers[w].station;
        wh_edge_wafer_t lying;
        if (station != said && is_met(layout, w, &lying)) {
            say_met(check, w, layout->stations[station].effector, &lying);
            said = station;
        }
    }
}
