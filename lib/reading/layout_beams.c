/* The beams of light at the doors of a layout's stations, and the blades that break them beside wafers. */
#include <math.h>
#include <stdio.h>

#include "../bodies/shapes.h"
#include "../layout/axes.h"
#include "../layout/words.h"
#include "layout_internal.h"

/* Two beams of a station that are nearer to being at the same distance from the way cannot tell which of two
 * crossings met the notch, mm. */
#define LEAST_APART 5
/* A wafer crosses a beam only if the beam is inside its rim by this, mm. */
#define LEAST_INSIDE 2
/* A wafer may lie off by this on its blade and still passes the beams between the way's two ends, mm. */
#define ROOM 5

static double chord_of(const wh_layout_t *layout, double y) {
    const double radius = layout->wafer_diameter / 2;
    return sqrt(radius * radius - y * y);
}

/* With several robots the limits apply along each robot's own way in, see find_passed. */
static double read_across_any(wh_reader_t *reader) {
    return wh_reader_number(reader, "y", WH_REAL(NAN), -10000, 10000);
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
    const wh_station_t *place = &layout->places[s];
    wh_layout_beam_t *beam = &layout->beams[layout->beam_count];
    wh_door_beam_t *door = &layout->doors[layout->beam_count];
    const double top = (place->slots - 1) * place->pitch;
    (void)snprintf(beam->name, sizeof beam->name, "%s.beam%zu", layout->stations[s].name,
                   layout->beam_count - first + 1);
    beam->station = (int32_t)s;
    wh_reader_scalars(reader, beam);
    wh_reader_scalar_from(reader, "x", beam, -layout->stations[s].retract / 2);
    beam->y = wh_layout_is_shared(layout) ? read_across_any(reader) : read_across(reader, layout, first);
    const double high = top + 30 > beam->low ? top + 30 : beam->low + 60;
    wh_reader_scalar_within(reader, "high", beam, high, beam->low + 1, 1e4);
    door->delay_on = beam->delay_on + beam->late;
    door->delay_off = beam->delay_off + beam->late;
    door->jitter = wh_reader_apart(reader, "jitter");
    door->seed = (uint64_t)wh_reader_apart(reader, "seed");
    door->stuck = (wh_beam_stuck_t)wh_reader_apart(reader, "stuck");
    wh_layout_place_beam(layout, layout->beam_count);
}

/* ---------------------------------------------------------------------------------------- who passes them */

/* A beam as seen along a way in: x in, y to the left, from the slot's centre, mm. */
typedef struct {
    double x, y;
} spot_t;

/* A robot's way in to a station, and the beams on it. */
typedef struct {
    const wh_layout_t *layout;
    size_t station;
    const wh_layout_approach_t *by; /* null of one robot: the station's own way */
    const char *robot;
    wh_latch_order_t beams;
} way_t;

static spot_t see(const way_t *way, size_t b) {
    const wh_layout_beam_t *beam = &way->layout->beams[b];
    const spot_t own = {beam->x, beam->y};
    if (!way->by || !way->by->is_turned) {
        return own;
    }
    const wh_mat3_t *R = &way->layout->places[way->station].base_from_station.R;
    const wh_vec3_t in_base = wh_mat3_column(&way->by->R, 0);
    const wh_vec3_t in = wh_mat3_transform_back(R, &in_base);
    return (spot_t){in.x * beam->x + in.y * beam->y, in.x * beam->y - in.y * beam->x};
}

/* True if wafers break it on this way in: before the slot, behind where the way begins. */
static bool is_passed(const way_t *way, size_t b) {
    const spot_t spot = see(way, b);
    const double radius = way->layout->wafer_diameter / 2;
    const double begin = -way->layout->stations[way->station].retract - radius;
    return spot.x < 0 && spot.x > begin && fabs(spot.y) <= radius - LEAST_INSIDE;
}

static void enter_item(wh_reader_t *reader, const way_t *way, size_t b) {
    const int32_t first = wh_layout_beams_at(way->layout, way->station).first;
    (void)wh_reader_enter(reader, "beams");
    wh_reader_enter_item(reader, (lua_Integer)b - first + 1);
}

/* Fills in way->beams. They are armed together, so they come one after another, and none is as far from the
 * way as another one. */
static void find_passed(wh_reader_t *reader, way_t *way) {
    const wh_latch_order_t all = wh_layout_beams_at(way->layout, way->station);
    wh_latch_order_t *found = &way->beams;
    for (int32_t b = all.first; b < all.first + all.count; ++b) {
        if (!is_passed(way, (size_t)b)) {
            continue;
        }
        found->first = found->count == 0 ? b : found->first;
        if (b != found->first + found->count) {
            enter_item(reader, way, (size_t)b);
            wh_reader_fail(reader, NULL, "beams that %s passes one after another in the list", way->robot);
        }
        for (int32_t other = found->first; other < b; ++other) {
            const double y = see(way, (size_t)b).y;
            if (fabs(fabs(see(way, (size_t)other).y) - fabs(y)) < LEAST_APART) {
                enter_item(reader, way, (size_t)b);
                lua_pushnumber(reader->L, y);
                wh_reader_fail(reader, NULL,
                               "one whose distance from the way of %s differs by %d mm or more from each "
                               "other beam's: equal ones cannot tell which of two crossings met the notch",
                               way->robot, LEAST_APART);
            }
        }
        ++found->count;
    }
}

static const char *way_text(const way_t *way, char text[WH_NAME_SIZE + 20]) {
    (void)snprintf(text, WH_NAME_SIZE + 20, way->by ? "the way in of %s" : "the way in", way->robot);
    return text;
}

/* Refuses beams that could never centre: the whole wafer must pass each beam on the way in. */
static void check_whole(wh_reader_t *reader, const way_t *way, size_t b) {
    const wh_layout_t *layout = way->layout;
    const double retract = layout->stations[way->station].retract;
    const spot_t spot = see(way, b);
    const double chord = chord_of(layout, spot.y);
    const double least = chord + ROOM - retract;
    char name[WH_NAME_SIZE + 20];
    if (least > -chord - ROOM) {
        lua_pushnumber(reader->L, retract);
        wh_reader_fail(reader, "retract",
                       "%.6g mm or more, so that all of a wafer passes the beam at y = %.6g on %s, "
                       "for `centre`",
                       ceil(2 * (chord + ROOM)), spot.y, way_text(way, name));
    }
    if (spot.x < least || spot.x > -chord - ROOM) {
        const int32_t first = wh_layout_beams_at(layout, way->station).first;
        char path[40];
        (void)snprintf(path, sizeof path, "beams[%d].x", (int)((int32_t)b - first + 1));
        lua_pushnumber(reader->L, spot.x);
        wh_reader_fail(reader, path,
                       "from %.6g to %.6g mm, where all of a wafer passes it on %s of %.6g mm "
                       "(`retract`), for `centre`",
                       least, -chord - ROOM, way_text(way, name), retract);
    }
}

static void check_centring(wh_reader_t *reader, const way_t *way) {
    if (way->beams.count < 2) {
        lua_pushboolean(reader->L, 1);
        wh_reader_fail(reader, "centre",
                       way->by ? "false, or two beams that %s passes on its way in"
                               : "false, or two beams at the station's door",
                       way->robot);
    }
    for (int32_t b = way->beams.first; b < way->beams.first + way->beams.count; ++b) {
        check_whole(reader, way, (size_t)b);
    }
}

/* Each beam is on some robot's way in, else nothing would ever break it. */
static void refuse_idle(wh_reader_t *reader, const wh_layout_t *layout, size_t s) {
    const wh_latch_order_t all = wh_layout_beams_at(layout, s);
    for (int32_t b = all.first; b < all.first + all.count; ++b) {
        bool is_used = false;
        for (size_t r = 0; r < layout->robot_count; ++r) {
            const wh_latch_order_t of = wh_layout_beams_of(layout, s, r);
            is_used = is_used || (b >= of.first && b < of.first + of.count);
        }
        if (!is_used) {
            const way_t way = {.layout = layout, .station = s};
            enter_item(reader, &way, (size_t)b);
            wh_reader_fail(
                reader, NULL,
                "a beam on the way in of a robot in `by`, before the slot, where a wafer breaks it; "
                "beams are for " WH_AXES_USUAL_OF_SEVERAL);
        }
    }
}

/* Each of several robots has its own way in, and passes its own part of the station's beams. Robots of other
 * kinds are not checked. */
static void find_ways(wh_reader_t *reader, const wh_layout_t *layout, size_t s) {
    const wh_layout_station_t *station = &layout->stations[s];
    bool is_any = false;
    for (size_t r = 0; r < layout->robot_count; ++r) {
        wh_layout_approach_t *by = &station->by[r];
        way_t way = {.layout = layout, .station = s, .by = by, .robot = layout->robots[r].name};
        if (!by->serves) {
            continue;
        }
        find_passed(reader, &way);
        by->centre = station->centre && way.beams.count > 0;
        if (wh_layout_is_usual(layout, r)) {
            by->first_beam = way.beams.first;
            by->beam_count = way.beams.count;
            if (by->centre) {
                check_centring(reader, &way);
                is_any = true;
            }
        }
    }
    refuse_idle(reader, layout, s);
    if (station->centre && !is_any) {
        lua_pushboolean(reader->L, 1);
        wh_reader_fail(reader, "centre",
                       "false, or two beams on the way in of a robot in `by`: of " WH_AXES_USUAL_OF_SEVERAL);
    }
}

/* -------------------------------------------------------------------------------------------- a station's */

void wh_layout_read_beams(wh_reader_t *reader, wh_layout_t *layout, size_t s) {
    const size_t first = layout->beam_count;
    if (wh_reader_enter(reader, "beams")) {
        const size_t count = wh_reader_list(reader);
        if (!wh_layout_is_shared(layout) && !wh_layout_is_usual(layout, 0)) {
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
    layout->stations[s].centre = wh_reader_apart(reader, "centre") > 0;
    if (layout->stations[s].by) {
        find_ways(reader, layout, s);
    } else if (layout->stations[s].centre) {
        const way_t way = {.layout = layout, .station = s, .beams = wh_layout_beams_at(layout, s)};
        check_centring(reader, &way);
    }
}

/* The most blades and wafers that a simulator checks against beams; a robot may hold both. */
static void refuse_crowd(wh_reader_t *reader, const wh_layout_t *layout) {
    size_t count = 0;
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        count += layout->grippers[g].station == WH_NONE ? 2 : 1;
    }
    if (layout->robot_count > 1 && layout->beam_count > 0 && count > WH_SHADES) {
        lua_pushinteger(reader->L, (lua_Integer)count);
        wh_reader_fail(reader, "grippers",
                       "with beams or blocks and several robots at most %d, those on robots counted twice",
                       WH_SHADES);
    }
}

void wh_layout_read_blades(wh_reader_t *reader, wh_layout_t *layout) {
    refuse_crowd(reader, layout);
    for (size_t g = 0; layout->beam_count > 0 && g < layout->machine.gripper_count; ++g) {
        const wh_mount_t *mount = &layout->machine.mounts[g];
        if (layout->grippers[g].station == WH_NONE) {
            layout->blades[g] = wh_shapes_outline(&layout->shapes, &mount->effector_from_gripper);
        }
    }
}
