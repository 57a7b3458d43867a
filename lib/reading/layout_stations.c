/* A layout's stations and wafers: places, the parameters of GET and PUT, and where wafers lie when a run
 * begins. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../layout/grips.h"
#include "../layout/ports.h"
#include "../layout/words.h"
#include "../math/deviate.h"
#include "../math/trig.h"
#include "layout_internal.h"
#include "layout_tool.h"

/* ----------------------------------------------------------------------------------------------- stations */

/* A default for wafers up to 150 mm, up to 200 mm, and larger ones. */
static double by_size(const wh_layout_t *layout, double small, double middle, double large) {
    return layout->wafer_diameter <= 150 ? small : layout->wafer_diameter <= 200 ? middle : large;
}

/* A single slot needs no pitch except to tell how near to the slot a wafer lies. */
static double default_pitch(const wh_layout_t *layout, int32_t slots) {
    const double pitch = wh_layout_default_pitch(layout);
    return pitch > 0 || slots > 1 ? pitch : by_size(layout, 4.76, 6.35, 10);
}

/* Refuses slots so near to one another that a gripper is ready on the wafers of two at once. */
static void check_pitch(wh_reader_t *reader, const wh_layout_t *layout, const wh_station_t *place) {
    const double least = 2 * layout->grasp.tolerance.projz;
    if (place->slots > 1 && place->pitch < least) {
        lua_pushnumber(reader->L, place->pitch);
        wh_reader_fail(reader, "pitch",
                       "%.10g mm or more, twice tolerance.projz: nearer a gripper takes wafers of two slots",
                       least);
    }
}

static void read_place(wh_reader_t *reader, const wh_layout_t *layout, wh_layout_station_t *station,
                       wh_station_t *place) {
    static const wh_vec3_t none = {0, 0, 0};
    station->by_axes = wh_layout_is_taught(reader, layout);
    const wh_vec3_t rpy = wh_reader_vector(reader, "rpy", &none);
    place->base_from_station.r = wh_reader_vector(reader, "at", station->by_axes ? &none : NULL);
    place->base_from_station.R = wh_mat3_from_rpy_deg(rpy.x, rpy.y, rpy.z);
    place->slots = wh_reader_whole(reader, "slots", station->foup ? 25 : 1, 1,
                                   station->prealigner || station->flipper ? 1 : WH_LAYOUT_SLOTS);
    place->pitch = wh_layout_sized(reader, layout, "pitch", default_pitch(layout, place->slots));
    place->chuck = WH_NONE;
    check_pitch(reader, layout, place);
    if (place->base_from_station.R.m[2][2] < WH_REAL(0.7)) {
        (void)wh_reader_push(reader, "rpy");
        wh_reader_fail(reader, "rpy", "a station whose z points up, tilted by less than 45 degrees");
    }
}

/* Refuses a stroke that passes the whole tolerance window between two slices: it would miss wafers in
 * silence. */
static void check_speed(wh_reader_t *reader, const wh_layout_t *layout, double pickup_speed) {
    const double step = pickup_speed * (double)layout->slice_us / 1e6;
    if (layout->grasp.check == WH_CHECK_SAMPLED && step > layout->grasp.tolerance.projz) {
        lua_pushnumber(reader->L, pickup_speed);
        wh_reader_fail(
            reader, "pickup_speed",
            "at most %.6g mm/s with slices of %lld us, or check = \"swept\", which looks between them",
            layout->grasp.tolerance.projz * 1e6 / (double)layout->slice_us, (long long)layout->slice_us);
    }
}

/* Refuses a stroke that begins below the slot underneath: it would take the wrong wafer and report
 * success. */
static void check_stroke(wh_reader_t *reader, const wh_station_t *place, const wh_layout_station_t *station) {
    const double below = station->stroke - station->offset;
    const double farther = below > station->offset ? below : station->offset;
    if (place->slots > 1 && !(farther < place->pitch)) {
        lua_pushnumber(reader->L, station->stroke);
        wh_reader_fail(
            reader, "stroke",
            "one that stays within the pitch of %.12g mm; it goes %.12g below and %.12g above the slot",
            place->pitch, below, station->offset);
    }
}

/* s: twice as long as the layout's vacuum takes to let go of a wafer and to be felt under the next
 * gripper, and its sensor to tell it. */
static double default_timeout(const wh_physics_t *physics) {
    const wh_vacuum_config_t *vacuum = &physics->vacuum;
    const double least = 0.25, below_full = vacuum->on < 1 ? 1 - vacuum->on : 1e-3;
    const double told = 2 * vacuum->debounce * physics->slice_s;
    const double slow =
        told - 2 * (vacuum->vent * wh_ln(vacuum->release) + vacuum->build * wh_ln(below_full));
    return slow < least ? least : (slow < 3600 ? slow : 3600);
}

/* With the default stroke the blade enters about midway between two wafers at the default pitch. */
static void read_moves(wh_reader_t *reader, const wh_layout_t *layout, const wh_station_t *place,
                       wh_layout_station_t *station) {
    const double lowered = layout->grasp.seat ? 0 : -layout->grasp.tolerance.projz / 2;
    wh_reader_scalars(reader, station);
    wh_reader_scalar_from(reader, "stroke", station, by_size(layout, 3, 4, 6));
    wh_reader_scalar_within(reader, "offset", station, station->stroke / 2, 0, station->stroke);
    const double bottom = station->offset - station->stroke;
    wh_reader_scalar_within(reader, "release", station, lowered > bottom ? lowered : bottom, bottom,
                            station->offset);
    wh_reader_scalar_from(reader, "timeout", station, default_timeout(&layout->physics));
    station->retract_default = !wh_reader_has(reader, "retract");
    station->release_default = !wh_reader_has(reader, "release");
    check_stroke(reader, place, station);
    check_speed(reader, layout, station->pickup_speed);
}

static int compare_names(const void *a, const void *b) {
    return strcmp(a, b); /* with which each item begins */
}

void *wh_layout_read_keys(wh_reader_t *reader, size_t most, size_t size, const char *what, size_t *count) {
    lua_State *L = reader->L;
    size_t needed = 0;
    for (lua_pushnil(L); lua_next(L, -2) != 0; lua_pop(L, 1)) {
        if (++needed > most) {
            wh_reader_fail(reader, NULL, "at most %d %s", (int)most, what);
        }
    }
    char *items = wh_layout_memory(L, needed, size);
    *count = 0;
    for (lua_pushnil(L); lua_next(L, -2) != 0; lua_pop(L, 1)) {
        size_t length = 0;
        const char *name = lua_type(L, -2) == LUA_TSTRING ? lua_tolstring(L, -2, &length) : "";
        if (length == 0 || length >= WH_NAME_SIZE || !wh_reader_is_plain(name, length)) {
            const bool fits = length > 0 && length < WH_NAME_SIZE;
            lua_pushvalue(L, -2);
            wh_reader_fail(reader, NULL, "%s by name, of 1 to %d bytes%s", what, WH_NAME_SIZE - 1,
                           fits ? " without control characters" : "");
        }
        memcpy(items + (*count)++ * size, name, length + 1);
    }
    qsort(items, *count, size, compare_names);
    return items;
}

static void read_names(wh_reader_t *reader, wh_layout_t *layout) {
    layout->stations = wh_layout_read_keys(reader, WH_LAYOUT_STATIONS, sizeof *layout->stations, "stations",
                                           &layout->station_count);
    layout->places = wh_layout_memory(reader->L, layout->station_count, sizeof *layout->places);
}

static wh_station_face_t read_face(wh_reader_t *reader, wh_station_face_t fallback) {
    return wh_reader_has(reader, "face")
               ? (wh_station_face_t)((int)wh_reader_apart(reader, "face") + WH_STATION_FACE_UP)
               : fallback;
}

static void read_station(wh_reader_t *reader, wh_layout_t *layout, size_t index) {
    wh_layout_station_t *station = &layout->stations[index];
    wh_reader_enter(reader, station->name);
    wh_reader_refuse_unknown(reader, wh_layout_station_fields);
    const int kind = (int)wh_reader_apart(reader, "kind");
    station->prealigner = kind == 1;
    station->foup = kind == 2 || kind == WH_LAYOUT_LOAD_PORT;
    station->flipper = kind == 3;
    read_place(reader, layout, station, &layout->places[index]);
    read_moves(reader, layout, &layout->places[index], station);
    if (station->flipper) {
        wh_layout_refuse_field(reader, "face", "nothing: a flipper turns wafers over");
    }
    station->face = read_face(reader, WH_STATION_ANY_FACE);
    layout->has_faces = layout->has_faces || station->flipper || station->face == WH_STATION_FACE_DOWN;
    wh_layout_read_approach(reader, layout, index);
    wh_reader_leave(reader);
}

/* Ranks stations as the places where wafers end up, if the layout does not say it: FOUPs first, then stations
 * with several slots, then with one, never a chuck. */
static int rank_of(const wh_layout_t *layout, size_t s) {
    const wh_layout_station_t *station = &layout->stations[s];
    const int by_slots = layout->places[s].slots > 1 ? 2 : 1;
    return station->prealigner || station->flipper ? 0 : station->foup ? 3 : by_slots;
}

static bool says_counts(wh_reader_t *reader, const wh_layout_station_t *station) {
    wh_reader_enter(reader, station->name);
    const bool says = wh_reader_has(reader, "counts");
    wh_reader_leave(reader);
    return says;
}

/* Reads which stations count. Among those that do not say it, the ones of the highest rank count. */
static void read_counts(wh_reader_t *reader, wh_layout_t *layout) {
    int highest = 1;
    for (size_t s = 0; s < layout->station_count; ++s) {
        if (!says_counts(reader, &layout->stations[s])) {
            const int rank = rank_of(layout, s);
            highest = rank > highest ? rank : highest;
        }
    }
    for (size_t s = 0; s < layout->station_count; ++s) {
        (void)wh_reader_open(reader, layout->stations[s].name, wh_layout_station_fields);
        layout->stations[s].counts =
            wh_reader_apart_from(reader, "counts", rank_of(layout, s) == highest) > 0;
        wh_reader_leave(reader);
    }
}

void wh_layout_read_stations(wh_reader_t *reader, wh_layout_t *layout) {
    if (!wh_reader_enter(reader, "stations")) {
        wh_reader_refuse(reader, "stations", NULL, "a table of stations by name");
    }
    read_names(reader, layout);
    for (size_t s = 0; s < layout->station_count; ++s) {
        read_station(reader, layout, s);
    }
    read_counts(reader, layout);
    wh_layout_place(layout);
    wh_reader_leave(reader);
}

static void read_effector(wh_reader_t *reader, const wh_layout_t *layout, wh_layout_station_t *station) {
    static const char of_one[] = "the name of a gripper on = \"robot\"";
    const char *expected = layout->robot_count > 1 ? "the name of a gripper on a robot" : of_one;
    station->effector = wh_layout_read_gripper_name(reader, layout, "effector", expected);
    const wh_layout_gripper_t *gripper = &layout->grippers[station->effector];
    if (gripper->station != WH_NONE) {
        wh_reader_refuse(reader, "effector", gripper->name, "%s", expected);
    }
}

void wh_layout_read_effectors(wh_reader_t *reader, wh_layout_t *layout) {
    wh_reader_enter(reader, "stations");
    for (size_t s = 0; s < layout->station_count; ++s) {
        wh_reader_enter(reader, layout->stations[s].name);
        read_effector(reader, layout, &layout->stations[s]);
        wh_layout_read_server(reader, layout, s);
        wh_reader_leave(reader);
    }
    wh_reader_leave(reader);
}

/* ------------------------------------------------------------------------------------------------- wafers */

/* A wafer's own field, else its station's, else face up. Refuses what the station does not allow. */
static wh_station_face_t read_wafer_face(wh_reader_t *reader, const wh_layout_station_t *station) {
    const wh_station_face_t usual = station->face == WH_STATION_ANY_FACE ? WH_STATION_FACE_UP : station->face;
    const wh_station_face_t face = read_face(reader, usual);
    if (face != usual && station->face != WH_STATION_ANY_FACE) {
        (void)wh_reader_push(reader, "face");
        wh_reader_fail(reader, "face", "\"%s\", as all wafers of %s lie: its own `face` says so",
                       wh_layout_face_name(station->face), station->name);
    }
    return face;
}

/* The fields give the place of the face that lies on the slot. */
static void read_position(wh_reader_t *reader, wh_layout_t *layout, const wh_layout_wafer_t *wafer,
                          wh_pose_t *base_from_wafer) {
    static const wh_vec3_t none = {0, 0, 0};
    const wh_pose_t base_from_slot = wh_station_slot(&layout->places[wafer->station], wafer->slot);
    const wh_vec3_t rpy = wh_reader_vector(reader, "rpy", &none);
    wh_pose_t slot_from_wafer;
    slot_from_wafer.r.x = wh_reader_apart(reader, "dx");
    slot_from_wafer.r.y = wh_reader_apart(reader, "dy");
    slot_from_wafer.r.z = wh_reader_apart(reader, "dz");
    slot_from_wafer.R = wh_mat3_from_rpy_deg(rpy.x, rpy.y, rpy.z);
    *base_from_wafer = wh_pose_compose(&base_from_slot, &slot_from_wafer);
    if (read_wafer_face(reader, &layout->stations[wafer->station]) == WH_STATION_FACE_DOWN) {
        const wh_pose_t base_from_front = *base_from_wafer;
        wh_face_frame(&base_from_front, layout->wafer_thickness, WH_FACE_FRONT, base_from_wafer);
        layout->has_faces = true;
    }
}

static void read_wafer(wh_reader_t *reader, wh_layout_t *layout, size_t w) {
    char fallback[WH_NAME_SIZE];
    wh_layout_wafer_t *wafer = &layout->wafers[w];
    wh_reader_refuse_unknown(reader, wh_layout_wafer_fields);
    snprintf(fallback, sizeof fallback, "Wafer %zu", w + 1);
    wh_reader_text(reader, "name", fallback, wafer->name, sizeof wafer->name);
    wafer->station = wh_layout_read_name(reader, layout, "station", NULL, wh_layout_find_station,
                                         "the name of a station of this layout");
    wafer->slot = wh_reader_whole(reader, "slot", 0, 1, layout->places[wafer->station].slots);
    wafer->thickness = wh_reader_apart_from(reader, "thickness", layout->wafer_thickness);
    wafer->recipe = wh_layout_read_recipe(reader, layout->recipes);
    read_position(reader, layout, wafer, &layout->start[w].base_from_wafer);
}

/* Pointers are sorted: the wafers themselves stay in their order. */
typedef const wh_layout_wafer_t *entry_t;

/* Among equals the earlier one comes first. */
static int in_order(const wh_layout_wafer_t *one, const wh_layout_wafer_t *two, int order) {
    return order != 0 ? order : (one > two) - (one < two);
}

static int compare_wafer_names(const void *a, const void *b) {
    const wh_layout_wafer_t *one = *(const entry_t *)a;
    const wh_layout_wafer_t *two = *(const entry_t *)b;
    return in_order(one, two, strcmp(one->name, two->name));
}

static int compare_slots(const void *a, const void *b) {
    const wh_layout_wafer_t *one = *(const entry_t *)a;
    const wh_layout_wafer_t *two = *(const entry_t *)b;
    const int stations = (one->station > two->station) - (one->station < two->station);
    return in_order(one, two, stations != 0 ? stations : (one->slot > two->slot) - (one->slot < two->slot));
}

/* One of two wafers: that of the list, if the other one comes with a carrier. */
static void fail_at(wh_reader_t *reader, const wh_layout_t *layout, const entry_t of[2], const char *field,
                    const char *expected) {
    const wh_layout_wafer_t *wafer = of[1]->carrier == 0 ? of[1] : of[0];
    char path[40];
    snprintf(path, sizeof path, "[%d].%s", (int)(wafer - layout->wafers) + 1, field);
    wh_reader_fail(reader, path, "%s", expected);
}

/* Sorting puts wafers with the same name side by side. */
static void refuse_same_name(wh_reader_t *reader, const wh_layout_t *layout, entry_t *order) {
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        order[w] = &layout->wafers[w];
    }
    qsort(order, layout->wafer_count, sizeof(entry_t), compare_wafer_names);
    for (size_t i = 1; i < layout->wafer_count; ++i) {
        if (strcmp(order[i - 1]->name, order[i]->name) == 0) {
            lua_pushstring(reader->L, order[i]->name);
            fail_at(reader, layout, &order[i - 1], "name", "a name that no other wafer has");
        }
    }
}

/* Wafers that are still to come lie in no slot. */
static void refuse_same_slot(wh_reader_t *reader, const wh_layout_t *layout, entry_t *order) {
    size_t count = 0;
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        order[count] = &layout->wafers[w];
        count += wh_layout_is_outside(&layout->start[w].base_from_wafer) ? 0 : 1;
    }
    qsort(order, count, sizeof(entry_t), compare_slots);
    for (size_t i = 1; i < count; ++i) {
        const wh_layout_wafer_t *wafer = order[i];
        const wh_layout_wafer_t *before = order[i - 1];
        if (before->station == wafer->station && before->slot == wafer->slot) {
            char expected[200];
            snprintf(expected, sizeof expected, "a slot of %s of its own; \"%s\" lies in this one",
                     layout->stations[wafer->station].name, wafer->carrier == 0 ? before->name : wafer->name);
            lua_pushinteger(reader->L, wafer->slot);
            fail_at(reader, layout, &order[i - 1], "slot", expected);
        }
    }
}

static void read_list(wh_reader_t *reader, wh_layout_t *layout, size_t count) {
    for (; layout->wafer_count < count; ++layout->wafer_count) {
        wh_reader_enter_item(reader, (lua_Integer)layout->wafer_count + 1);
        read_wafer(reader, layout, layout->wafer_count);
        wh_reader_leave(reader);
    }
}

/* Those of the list, and those that come with carriers. */
void wh_layout_read_wafers(wh_reader_t *reader, wh_layout_t *layout) {
    const size_t carried = wh_layout_read_ports(reader, layout);
    const bool is_said = wh_reader_enter(reader, "wafers");
    const size_t count = is_said ? wh_reader_list(reader) : 0;
    if (count + carried > WH_LAYOUT_WAFERS) {
        wh_reader_fail(reader, NULL, "at most %d wafers", WH_LAYOUT_WAFERS);
    }
    if (count + carried == 0) {
        if (is_said) {
            wh_reader_leave(reader);
        }
        wh_layout_begin_ports(reader, layout);
        return;
    }
    layout->wafers = wh_layout_memory(reader->L, count + carried, sizeof *layout->wafers);
    layout->start = wh_layout_memory(reader->L, count + carried, sizeof *layout->start);
    read_list(reader, layout, count);
    wh_layout_add_carried(reader, layout);
    entry_t *order = wh_layout_memory(reader->L, layout->wafer_count, sizeof(entry_t));
    refuse_same_name(reader, layout, order);
    refuse_same_slot(reader, layout, order);
    if (is_said) {
        wh_reader_leave(reader);
    }
    wh_layout_begin_ports(reader, layout);
}
