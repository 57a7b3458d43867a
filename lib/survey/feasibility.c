#include "feasibility_internal.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../layout/arms.h"
#include "../layout/doors.h"
#include "../layout/ports.h"
#include "../layout/travel.h"
#include "../math/trig.h"
#include "../text/array.h"

/* How many of the wafers in no slot, or tilted too far, are named; the others are counted. */
#define NAMED_STRAYS 20

const char *wh_finding_name(wh_finding_kind_t kind) {
    static const char *const names[] = {"contact", "space",  "reach",   "links", "wafer", "entry",
                                        "ledges",  "blades", "retract", "tilt",  "gap",   "release",
                                        "sight",   "rest",   "pocket",  "play",  "size"};
    return names[kind];
}

wh_finding_t *wh_feasibility_add(wh_feasibility_t *check, wh_finding_kind_t kind, int32_t station,
                                 const char *format, ...) {
    check->findings = wh_array_grow(check->findings, check->count, &check->capacity, sizeof *check->findings);
    wh_finding_t *finding = &check->findings[check->count++];
    ++check->wrong;
    finding->kind = kind;
    finding->is_warning = false;
    finding->station = station;
    finding->slot = 0;
    finding->other = WH_NONE;
    finding->parts[0] = finding->parts[1] = WH_NONE;
    va_list values;
    va_start(values, format);
    (void)vsnprintf(finding->text, sizeof finding->text, format, values);
    va_end(values);
    return finding;
}

void wh_feasibility_warn(wh_feasibility_t *check) {
    check->findings[check->count - 1].is_warning = true;
    --check->wrong;
}

/* ------------------------------------------------------------------------------------------------ at home */

static void go_home(wh_feasibility_t *check) {
    const wh_machine_t *machine = &check->layout->machine;
    wh_real_t axes[WH_AXES] = {0};
    wh_machine_home(machine, axes);
    wh_machine_grippers(machine, axes, check->base_from_grippers);
    wh_links_at(&check->links, check->layout, axes);
}

/* A door's part at home. */
static wh_pose_t place_of_door(const wh_layout_t *layout, const wh_part_t *part) {
    wh_pose_t base_from_door[WH_DOORS];
    wh_layout_place_doors(layout, NULL, NULL, base_from_door);
    return wh_pose_compose(&base_from_door[part->owner], &part->convex.body_from_shape);
}

wh_pose_t wh_feasibility_place(const wh_feasibility_t *check, int32_t part) {
    const wh_world_config_t *world = &check->layout->world;
    if ((size_t)part >= world->part_count) {
        const wh_pose_t *wafer = &check->layout->start[(size_t)part - world->part_count].base_from_wafer;
        return wh_pose_compose(wafer, &world->wafer.body_from_shape);
    }
    const wh_part_t *from = &world->parts[part];
    switch (from->kind) {
    case WH_PART_ARM:
        return wh_pose_compose(&check->links.bodies[from->owner], &from->convex.body_from_shape);
    case WH_PART_BLADE:
    case WH_PART_CHUCK:
        return wh_pose_compose(&check->base_from_grippers[from->owner], &from->convex.body_from_shape);
    case WH_PART_DOOR:
        return place_of_door(check->layout, from);
    case WH_PART_FIXED:
    case WH_PART_LEDGE:
    case WH_PART_WAFER:
        break;
    }
    return from->convex.body_from_shape;
}

/* -------------------------------------------------------------------------------------------------- links */

static void check_links(wh_feasibility_t *check, size_t station) {
    for (size_t place = 0; place < WH_REACH_PLACES; ++place) {
        wh_unreached_t unreached;
        if (!wh_layout_reaches(check->layout, station, place, &unreached)) {
            wh_feasibility_add(check, WH_FINDING_LINKS, (int32_t)station, "%s%s slot %d: %s",
                               unreached.is_before ? "the way into " : "",
                               check->layout->stations[station].name, (int)unreached.slot, unreached.text)
                ->slot = unreached.slot;
        }
    }
}

/* --------------------------------------------------------------------------------------------------- tilt */

static double degrees_of(wh_real_t tilt) {
    return (double)wh_deg_from_rad(tilt);
}

static double tilt_limit(const wh_layout_t *layout) {
    return degrees_of(wh_acos(layout->grasp.tolerance.planar));
}

static double tilt_of(const wh_pose_t *pose) {
    const wh_vec3_t normal = wh_mat3_column(&pose->R, 2);
    return degrees_of(wh_atan2(wh_real_sqrt(normal.x * normal.x + normal.y * normal.y), normal.z));
}

double wh_feasibility_tilt(const wh_station_t *station) {
    return tilt_of(&station->base_from_station);
}

/* True if a level blade takes no wafer of this pose for its tilt; then also the tilt, deg. */
static bool is_too_tilted(const wh_layout_t *layout, const wh_pose_t *pose, double *tilt) {
    *tilt = tilt_of(pose);
    return !(pose->R.m[2][2] > layout->grasp.tolerance.planar);
}

/* If the robot stays level, the layout alone decides. */
static void check_tilt(wh_feasibility_t *check, size_t station) {
    const wh_layout_t *layout = check->layout;
    const wh_layout_station_t *s = &layout->stations[station];
    double tilt;
    if (s->taught && !wh_layout_tilts(layout, station) &&
        is_too_tilted(layout, &layout->places[station].base_from_station, &tilt)) {
        (void)wh_feasibility_add(check, WH_FINDING_TILT, (int32_t)station,
                                 "%s is tilted by %.4g deg (limit %.4g deg): the level blade takes no wafer "
                                 "that lies there",
                                 s->name, tilt, tilt_limit(layout));
    }
}

/* ------------------------------------------------------------------------------------------------ release */

/* A support stops a wafer that is let go less than eps_projz below the plane of its slot, and no other. On
 * the blade a wafer lies at most eps_projz high, seated at 0. */
static void check_release(wh_feasibility_t *check, size_t station) {
    const wh_layout_t *layout = check->layout;
    const wh_layout_station_t *s = &layout->stations[station];
    const wh_real_t projz = layout->grasp.tolerance.projz;
    const wh_real_t high = layout->grasp.seat ? 0 : WH_SWEEP_INSIDE * projz;
    if (s->release < -projz - high) {
        (void)wh_feasibility_add(
            check, WH_FINDING_RELEASE, (int32_t)station,
            "%s: `release` of %.6g mm lets go of a wafer that is eps_projz, %.4g mm, or more below %s",
            s->name, (double)s->release, (double)projz, s->prealigner ? "the chuck's plane" : "its slot");
    }
}

/* ------------------------------------------------------------------------------------------------- wafers */

/* A wafer that lies in no slot; its tilt is said where that is a cause. */
static void say_stray(wh_feasibility_t *check, size_t w) {
    const wh_layout_t *layout = check->layout;
    const wh_layout_wafer_t *wafer = &layout->wafers[w];
    const wh_place_t place = wh_cell_measure(&layout->cell, &layout->places[wafer->station], wafer->slot,
                                             &layout->start[w].base_from_wafer);
    const wh_vec3_t normal = wh_mat3_column(&layout->start[w].base_from_wafer.R, 2);
    const wh_vec3_t up = wh_mat3_column(&layout->places[wafer->station].base_from_station.R, 2);
    const wh_real_t upright = wh_vec3_dot(&normal, &up);
    char tilt[80] = "";
    if (!((place.face == WH_FACE_FRONT ? -upright : upright) > layout->cell.tolerance.planar)) {
        snprintf(tilt, sizeof tilt, ", tilted against it by %.4g deg (limit %.4g deg)",
                 degrees_of(place.tilt), tilt_limit(layout));
    }
    (void)wh_feasibility_add(
        check, WH_FINDING_WAFER, wafer->station,
        "%s lies in no slot: it is %.4g mm beside and %.4g mm above the plane of %s slot %d%s", wafer->name,
        (double)wh_real_sqrt(place.dx * place.dx + place.dy * place.dy), (double)place.dz,
        layout->stations[wafer->station].name, (int)wafer->slot, tilt);
}

/* Says of a wafer that lies in a slot if that is not its own, or if no ledge is where it lies. */
static bool say_height(wh_feasibility_t *check, size_t w, const wh_place_t *place) {
    const wh_layout_t *layout = check->layout;
    const wh_layout_wafer_t *wafer = &layout->wafers[w];
    const char *station = layout->stations[wafer->station].name;
    const wh_place_t own = wh_cell_measure(&layout->cell, &layout->places[wafer->station], wafer->slot,
                                           &layout->start[w].base_from_wafer);
    const double height = (double)own.dz;
    const double projz = (double)layout->cell.tolerance.projz;
    if (fabs(height) < projz) {
        return false;
    }
    if (place->station == wafer->station && place->slot != wafer->slot) {
        (void)wh_feasibility_add(check, WH_FINDING_WAFER, wafer->station,
                                 "%s lies in slot %d of %s, %.4g mm %s the plane of its slot %d", wafer->name,
                                 (int)place->slot, station, fabs(height), height > 0 ? "above" : "below",
                                 (int)wafer->slot);
        return true;
    }
    (void)wh_feasibility_add(
        check, WH_FINDING_WAFER, wafer->station,
        "%s lies %.4g mm %s the plane of %s slot %d, where nothing bears it (expected less "
        "than eps_projz, %.4g mm)",
        wafer->name, fabs(height), height > 0 ? "above" : "below", station, (int)wafer->slot, projz);
    wh_feasibility_warn(check);
    return true;
}

static void check_wafers(wh_feasibility_t *check) {
    const wh_layout_t *layout = check->layout;
    size_t strays = 0, high = 0;
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        const wh_layout_wafer_t *wafer = &layout->wafers[w];
        wh_place_t place;
        if (wh_layout_is_outside(&layout->start[w].base_from_wafer)) {
            continue; /* it comes with a carrier */
        }
        ++check->entries[wafer->station].wafers;
        if (wh_cell_locate(&layout->cell, &layout->start[w].base_from_wafer, &place)) {
            high += high < NAMED_STRAYS && say_height(check, w, &place) ? 1 : 0;
        } else if (++strays <= NAMED_STRAYS) {
            say_stray(check, w);
        }
    }
    if (strays > NAMED_STRAYS) {
        (void)wh_feasibility_add(check, WH_FINDING_WAFER, WH_NONE, "%zu more wafers lie in no slot",
                                 strays - NAMED_STRAYS);
    }
}

static bool is_face_too_tilted(const wh_layout_t *layout, const wh_pose_t *base_from_wafer, wh_face_t face,
                               double *tilt) {
    wh_pose_t base_from_face;
    wh_face_frame(base_from_wafer, layout->cell.thickness, face, &base_from_face);
    return is_too_tilted(layout, &base_from_face, tilt);
}

/* True if a wafer lies in a slot where the blade could take one, but is itself tilted too far. */
static bool is_askew(const wh_layout_t *layout, size_t w, double *tilt) {
    const int32_t station = layout->wafers[w].station;
    const wh_pose_t *base_from_wafer = &layout->start[w].base_from_wafer;
    wh_place_t place;
    return layout->stations[station].taught && !wh_layout_tilts(layout, (size_t)station) &&
           !is_too_tilted(layout, &layout->places[station].base_from_station, tilt) &&
           wh_cell_locate(&layout->cell, base_from_wafer, &place) &&
           is_face_too_tilted(layout, base_from_wafer, place.face, tilt);
}

static void check_askew(wh_feasibility_t *check) {
    const wh_layout_t *layout = check->layout;
    size_t askew = 0;
    double tilt;
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        if (is_askew(layout, w, &tilt) && ++askew <= NAMED_STRAYS) {
            (void)wh_feasibility_add(check, WH_FINDING_TILT, layout->wafers[w].station,
                                     "%s is tilted by %.4g deg (limit %.4g deg): the level blade does not "
                                     "take it",
                                     layout->wafers[w].name, tilt, tilt_limit(layout));
        }
    }
    if (askew > NAMED_STRAYS) {
        (void)wh_feasibility_add(check, WH_FINDING_TILT, WH_NONE, "%zu more wafers are tilted too far",
                                 askew - NAMED_STRAYS);
    }
}

/* ---------------------------------------------------------------------------------------------------- all */

static void check_parts(wh_feasibility_t *check) {
    wh_feasibility_contacts(check);
    wh_feasibility_full(check);
    wh_feasibility_blades(check);
    for (size_t s = 0; s < check->layout->station_count; ++s) {
        if (wh_layout_is_served(check->layout, s)) {
            wh_feasibility_room(check, s);
        }
    }
}

/* True if several robots serve a station. */
static bool has_shared_station(const wh_layout_t *layout) {
    bool has = false;
    for (size_t s = 0; layout->robot_count > 1 && s < layout->station_count; ++s) {
        size_t count = 0;
        for (size_t r = 0; r < layout->robot_count; ++r) {
            count += layout->stations[s].by[r].serves ? 1 : 0;
        }
        has = has || count > 1;
    }
    return has;
}

void wh_feasibility(wh_feasibility_t *check, const wh_layout_t *layout) {
    memset(check, 0, sizeof *check);
    check->layout = layout;
    check->has_parts = layout->part_names != NULL;
    check->entries = wh_array_new(layout->station_count, sizeof *check->entries);
    go_home(check);
    if (check->has_parts) {
        check_parts(check);
    }
    for (size_t s = 0; s < layout->station_count; ++s) {
        check_tilt(check, s);
        check_release(check, s);
        check_links(check, s);
    }
    check_wafers(check);
    check_askew(check);
    if (has_shared_station(layout)) {
        (void)wh_feasibility_add(
            check, WH_FINDING_LINKS, WH_NONE,
            "of a station that several of %s, %s%s serve, the room of one of them alone is looked at",
            layout->robots[0].name, layout->robots[1].name, layout->robot_count > 2 ? " and others" : "");
        wh_feasibility_warn(check);
    }
    wh_feasibility_sizes(check);
    wh_feasibility_units(check);
    wh_feasibility_sight(check);
    wh_feasibility_rests(check);
    wh_feasibility_pockets(check);
}

void wh_feasibility_free(wh_feasibility_t *check) {
    free(check->entries);
    free(check->findings);
    memset(check, 0, sizeof *check);
}
