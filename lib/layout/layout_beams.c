/* The beams of light at the doors of a layout's stations, and the blades that break them beside wafers. */
#include <math.h>
#include <stdio.h>

#include "axes.h"
#include "layout_internal.h"

/* Two beams of a station that are nearer to being at the same distance from the way cannot tell which of two
 * crossings met the notch, mm. */
#define LEAST_APART 5
/* What a beam must be inside of the rim to be crossed, mm. */
#define LEAST_INSIDE 2
/* A wafer may lie so far off on its blade, and yet pass the beams between the way's two ends, mm. */
#define ROOM 5

static double chord_of(const wh_layout_t *layout, double y) {
    const double radius = layout->wafer_diameter / 2;
    return sqrt(radius * radius - y * y);
}

/* Across the way. */
static double read_across(wh_reader_t *reader, const wh_layout_t *layout, size_t first) {
    const double most = layout->wafer_diameter / 2 - LEAST_INSIDE;
    const double y = wh_reader_number(reader, "y", WH_REAL(NAN), -most, most);
    for (size_t b = first; b < layout->beam_count; ++b) {
        if (fabs(fabs(layout->beams[b].y) - fabs(y)) < LEAST_APART) {
            lua_pushnumber(reader->L, y);
            wh_reader_fail(reader, "y",
                           "a distance from the way that differs by %d mm or more from each other beam's: "
                           "equal ones cannot tell which of two crossings met the notch",
                           LEAST_APART);
        }
    }
    return y;
}

static void read_beam(wh_reader_t *reader, wh_layout_t *layout, size_t s, size_t first) {
    static const char *const stuck[] = {"no", "dark", "lit", NULL};
    const wh_station_t *place = &layout->places[s];
    wh_layout_beam_t *beam = &layout->beams[layout->beam_count];
    wh_door_beam_t *door = &layout->doors[layout->beam_count];
    const double top = (place->slots - 1) * place->pitch;
    (void)snprintf(beam->name, sizeof beam->name, "%s.beam%zu", layout->stations[s].name,
                   layout->beam_count - first + 1);
    beam->station = (int32_t)s;
    beam->x = wh_reader_number(reader, "x", -layout->stations[s].retract / 2, -10000, 10000);
    beam->y = read_across(reader, layout, first);
    beam->low = wh_reader_number(reader, "low", -30, -1000, 1000);
    const double high = top + 30 > beam->low ? top + 30 : beam->low + 60;
    beam->high = wh_reader_number(reader, "high", high, beam->low + 1, 1e4);
    beam->sd = wh_reader_number(reader, "sd", 0, 0, 0.5);
    beam->dx = wh_reader_number(reader, "dx", 0, -5, 5);
    beam->dy = wh_reader_number(reader, "dy", 0, -5, 5);
    beam->delay_on = wh_reader_number(reader, "delay_on", 0, 0, 0.009);
    beam->delay_off = wh_reader_number(reader, "delay_off", 0, 0, 0.009);
    beam->late = wh_reader_number(reader, "late", 0, 0, 0.001);
    door->delay_on = beam->delay_on + beam->late;
    door->delay_off = beam->delay_off + beam->late;
    door->jitter = wh_reader_number(reader, "jitter", 0, 0, 0.001);
    door->seed = (uint64_t)wh_reader_whole(reader, "seed", 1, 0, INT32_MAX);
    door->stuck = (wh_beam_stuck_t)wh_reader_choice(reader, "stuck", 0, stuck);
    wh_layout_place_beam(layout, layout->beam_count);
}

/* Refuses what could never centre: beams that the wafer does not pass whole on the way in. */
static void check_centring(wh_reader_t *reader, const wh_layout_t *layout, size_t s, size_t first) {
    if (layout->beam_count - first < 2) {
        lua_pushboolean(reader->L, 1);
        wh_reader_fail(reader, "centre", "false, or two beams at the station's door");
    }
    for (size_t b = first; b < layout->beam_count; ++b) {
        const wh_layout_beam_t *beam = &layout->beams[b];
        const double chord = chord_of(layout, beam->y);
        const double least = chord + ROOM - layout->stations[s].retract;
        if (least > -chord - ROOM) {
            lua_pushnumber(reader->L, layout->stations[s].retract);
            wh_reader_fail(
                reader, "retract",
                "%.6g mm or more, so that all of a wafer passes the beam at y = %.6g on the way in, "
                "for `centre`",
                ceil(2 * (chord + ROOM)), beam->y);
        }
        if (beam->x < least || beam->x > -chord - ROOM) {
            char path[40];
            snprintf(path, sizeof path, "beams[%zu].x", b - first + 1);
            lua_pushnumber(reader->L, beam->x);
            wh_reader_fail(reader, path,
                           "from %.6g to %.6g mm, where all of a wafer passes it on the way in of %.6g mm "
                           "(`retract`), for `centre`",
                           least, -chord - ROOM, layout->stations[s].retract);
        }
    }
}

void wh_layout_read_beams(wh_reader_t *reader, wh_layout_t *layout, size_t s) {
    const size_t first = layout->beam_count;
    if (wh_reader_enter(reader, "beams")) {
        const size_t count = wh_reader_list(reader);
        if (layout->machine.carrier) {
            wh_reader_fail(reader, NULL, "nothing: beams are for " WH_AXES_USUAL);
        }
        if (count + first > WH_BEAMS) {
            wh_reader_fail(reader, NULL, "at most %d beams in all of the cell", WH_BEAMS);
        }
        if (layout->wafer_diameter < WH_SENSED_LEAST || layout->wafer_diameter > WH_SENSED_MOST) {
            wh_reader_fail(reader, NULL, "nothing: beams see wafers from %d to %d mm, these have %.12g",
                           WH_SENSED_LEAST, WH_SENSED_MOST, layout->wafer_diameter);
        }
        for (size_t i = 0; i < count; ++i) {
            wh_reader_enter_item(reader, (lua_Integer)i + 1);
            wh_reader_refuse_unknown(reader, wh_layout_beam_fields);
            read_beam(reader, layout, s, first);
            ++layout->beam_count;
            wh_reader_leave(reader);
        }
        wh_reader_leave(reader);
    }
    layout->stations[s].centre = wh_reader_boolean(reader, "centre", false);
    if (layout->stations[s].centre) {
        check_centring(reader, layout, s, first);
    }
}

void wh_layout_read_blades(wh_layout_t *layout) {
    for (size_t g = 0; layout->beam_count > 0 && g < layout->machine.gripper_count; ++g) {
        const wh_mount_t *mount = &layout->machine.mounts[g];
        if (layout->grippers[g].station == WH_NONE) {
            layout->blades[g] = wh_shapes_outline(&layout->shapes, &mount->effector_from_gripper);
        }
    }
}

void wh_layout_place_beam(wh_layout_t *layout, size_t b) {
    if (layout->doors[b].kind == WH_DOOR_TOUCH) {
        wh_layout_place_face(layout, b);
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
