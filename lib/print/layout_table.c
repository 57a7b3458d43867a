#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../layout/arms.h"
#include "../layout/axes.h"
#include "../layout/grips.h"
#include "../layout/words.h"
#include "../math/trig.h"
#include "../text/array.h"
#include "layout_ports.h"
#include "layout_print.h"
#include "layout_times.h"
#include "print_internal.h"

#define MS WH_REAL(1e3)

/* The data that every part of the listing is given. */
typedef struct {
    const wh_feasibility_t *check;
    const wh_layout_t *layout;
    wh_printer_t frame;
} listing_t;

/* -------------------------------------------------------------------------------------------- the machine */

static void print_axes(const listing_t *listing) {
    const wh_machine_t *machine = &listing->layout->machine;
    wh_real_t home[WH_AXES];
    wh_machine_home(machine, home);
    wh_grid_t *grid =
        wh_grid_new(listing->frame.style, 1,
                    "axis;from{0,6};to{0,6};home{0,6};speed{0,6};acceleration{0,6};jerk{0,6};in");
    for (size_t i = 0; i < wh_machine_robot_axes(machine); ++i) {
        const bool turns = wh_axis_turns(machine, i);
        const double unit = turns ? wh_deg_from_rad(1) : 1;
        const wh_limits_t *limits = wh_machine_limits(machine, i);
        const wh_travel_t *travel = wh_machine_travel(machine, i);
        const double values[] = {unit * travel->min,   unit * travel->max,          unit * home[i],
                                 unit * limits->speed, unit * limits->acceleration, unit * limits->jerk};
        char name[WH_NAME_SIZE];
        if (!wh_axis_exists(machine, i)) {
            continue;
        }
        wh_layout_name_axis(listing->layout, i, name, sizeof name);
        wh_grid_named_row(grid, name);
        wh_grid_numbers(grid, 1, values, 6);
        wh_grid_text(grid, 7, WH_INK_DIM, turns ? "deg, s" : "mm, s");
    }
    wh_print_titled(&listing->frame, "Robot", grid);
}

/* The kind of a gripper on a prealigner, unless it is a chuck that only turns. */
static const char *what_it_is(const wh_mount_t *mount) {
    static const char *const words[] = {"", ", on a stage", ", pins", ", clamp"};
    return wh_mount_axes(mount) > 0 ? words[mount->kind] : "";
}

/* The robot, or which of its two arms or wrists. */
static void name_arm(const wh_layout_t *layout, size_t gripper, char *name, size_t size) {
    const wh_mount_t *mount = &layout->machine.mounts[gripper];
    const wh_carrier_t *carrier = wh_machine_carrier(&layout->machine, mount->robot, NULL);
    const int length = snprintf(name, size, "%s", layout->robots[mount->robot].name);
    if (carrier && carrier->second && (size_t)length < size) {
        (void)snprintf(name + length, size - (size_t)length, ", %s %d",
                       carrier->chain.kind == WH_CHAIN_SCARA ? "wrist" : "arm", mount->arm + 1);
    }
}

/* Printed only if a gripper has another grip than vacuum. */
static void print_grips(const listing_t *listing) {
    const wh_layout_t *layout = listing->layout;
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        const wh_edge_t *edge = &layout->grips[g].edge;
        if (layout->grips[g].kind == WH_GRIP_EDGE) {
            fprintf(listing->frame.out,
                    "%s: edge grip, rests at ±%.6g degrees, clearance %.6g mm, gripped from %.6g to %.6g mm, "
                    "%.6g mm/s\n",
                    layout->grippers[g].name, (double)wh_deg_from_rad((wh_real_t)edge->alpha),
                    edge->clearance, edge->gripped_from, edge->gripped_to, edge->speed);
        }
    }
}

static void print_grippers(const listing_t *listing) {
    const wh_layout_t *layout = listing->layout;
    wh_grid_t *grid = wh_grid_new(listing->frame.style, 1, "gripper;on;valve;at mm;turned deg{0,6}");
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        const wh_layout_gripper_t *gripper = &layout->grippers[g];
        wh_grid_named_row(grid, gripper->name);
        char on[WH_NAME_SIZE + 16];
        if (gripper->station == WH_NONE) {
            name_arm(layout, g, on, sizeof on);
        } else {
            (void)snprintf(on, sizeof on, "%s", layout->stations[gripper->station].name);
        }
        wh_grid_text(grid, 1, WH_INK_PLAIN, "%s%s", on, what_it_is(&layout->machine.mounts[g]));
        wh_grid_text(grid, 2, WH_INK_PLAIN, "%s", gripper->valve);
        if (layout->machine.mounts[g].is_shifted) {
            const wh_pose_t *shift = &layout->machine.mounts[g].effector_from_gripper;
            wh_grid_text(grid, 3, WH_INK_PLAIN, "%g, %g, %g", shift->r.x, shift->r.y, shift->r.z);
            wh_grid_number(grid, 4, WH_INK_PLAIN,
                           wh_deg_from_rad(wh_atan2(shift->R.m[1][0], shift->R.m[0][0])));
        }
    }
    wh_print_titled(&listing->frame, "Grippers", grid);
    print_grips(listing);
}

/* The stations that it is the door of, for any robot. */
static void list_stations(const wh_layout_t *layout, wh_grid_t *grid, int32_t door) {
    const size_t size = layout->station_count * (WH_NAME_SIZE + 2) + 1;
    char *names = wh_array_new(size, 1);
    for (size_t s = 0; s < layout->station_count; ++s) {
        bool is_its = false;
        for (size_t r = 0; r < layout->robot_count; ++r) {
            is_its = is_its || wh_layout_door_of(layout, s, r) == door;
        }
        const size_t length = strlen(names);
        if (is_its) {
            (void)snprintf(names + length, size - length, "%s%s", length > 0 ? ", " : "",
                           layout->stations[s].name);
        }
    }
    wh_grid_text(grid, 1, WH_INK_PLAIN, "%s", names);
    free(names);
}

static void print_doors(const listing_t *listing) {
    const wh_layout_t *layout = listing->layout;
    wh_grid_t *grid =
        wh_grid_new(listing->frame.style, 1, "door;of;at home;opens by x{0,6};y{0,6};z{0,6};seconds{0,6}");
    for (size_t d = 0; d < layout->machine.door_count; ++d) {
        const wh_door_t *door = &layout->machine.doors[d];
        wh_profile_t profile;
        (void)wh_profile_plan(&profile, door->travel, &door->limits);
        wh_grid_named_row(grid, layout->door_list[d].name);
        list_stations(layout, grid, (int32_t)d);
        wh_grid_text(grid, 2, WH_INK_PLAIN, "%s", wh_layout_door_words[door->is_open]);
        const double values[] = {door->travel * door->way.x, door->travel * door->way.y,
                                 door->travel * door->way.z, wh_profile_duration(&profile)};
        wh_grid_numbers(grid, 3, values, 4);
    }
    wh_print_titled(&listing->frame, "Doors, mm", grid);
}

/* ----------------------------------------------------------------------------------------------- stations */

/* The sensors that see wafers there. */
static const char *seen_by(const wh_layout_t *layout, size_t s) {
    const bool has_beams = wh_layout_beams_at(layout, s).count > 0;
    if (wh_layout_scanner(layout, layout->places[s].chuck)) {
        return has_beams ? ", edge sensor, beams" : ", edge sensor";
    }
    return has_beams ? ", beams" : "";
}

static void add_station(const listing_t *listing, wh_grid_t *grid, size_t s) {
    const wh_layout_station_t *station = &listing->layout->stations[s];
    const wh_station_t *place = &listing->layout->places[s];
    const wh_vec3_t *r = &place->base_from_station.r;
    const wh_mat3_t *R = &place->base_from_station.R;
    const wh_real_t sine = wh_real_sqrt(R->m[0][2] * R->m[0][2] + R->m[1][2] * R->m[1][2]);
    wh_grid_named_row(grid, station->name);
    wh_grid_text(grid, 1, WH_INK_PLAIN, "%s%s%s%s", wh_layout_station_kind(station),
                 seen_by(listing->layout, s), station->by_axes ? ", by axes" : "",
                 station->taught ? "" : ", not taught");
    const double values[] = {r->x,
                             r->y,
                             r->z,
                             wh_deg_from_rad(wh_atan2(R->m[1][0], R->m[0][0])),
                             wh_deg_from_rad(wh_atan2(sine, R->m[2][2])),
                             place->slots,
                             place->pitch,
                             station->stroke,
                             station->offset,
                             station->retract,
                             (double)listing->check->entries[s].wafers};
    const size_t count = sizeof values / sizeof values[0];
    wh_grid_numbers(grid, 2, values, count);
    wh_grid_text(grid, 2 + count, WH_INK_PLAIN, "%s", station->counts ? "yes" : "no");
}

static void print_stations(const listing_t *listing) {
    wh_grid_t *grid =
        wh_grid_new(listing->frame.style, 1,
                    "station;kind;x{0,6};y{0,6};z{0,6};heading deg{0,6};tilt deg{0,6};slots{0};pitch{0,6};"
                    "stroke{0,6};offset{0,6};retract{0,6};wafers{0};counts");
    for (size_t s = 0; s < listing->layout->station_count; ++s) {
        add_station(listing, grid, s);
    }
    wh_print_titled(&listing->frame, "Stations", grid);
}

/* Prints which of several robots come to a station, and which one does so unless a command says otherwise. */
static void print_times(const listing_t *listing) {
    wh_grid_t *grid = wh_grid_new(listing->frame.style, 1, WH_LAYOUT_TIMES_COLUMNS);
    wh_layout_times_fill(listing->layout, grid);
    wh_print_titled(&listing->frame, "Stations that take time", grid);
}

/* Load ports, and the carriers that come to them. */
static void print_ports(const listing_t *listing) {
    wh_grid_t *ports = wh_grid_new(listing->frame.style, 1, WH_LAYOUT_PORTS_COLUMNS);
    wh_layout_ports_fill(listing->layout, ports);
    wh_print_titled(&listing->frame, "Load ports", ports);
    wh_grid_t *carriers = wh_grid_new(listing->frame.style, 1, WH_LAYOUT_CARRIERS_COLUMNS);
    wh_layout_carriers_fill(listing->layout, carriers);
    wh_print_titled(&listing->frame, "Carriers", carriers);
}

static void print_servers(const listing_t *listing) {
    const wh_layout_t *layout = listing->layout;
    if (!wh_layout_is_shared(layout)) {
        return;
    }
    wh_grid_t *grid = wh_grid_new(listing->frame.style, 2, "station;robot;heading deg{0,6};unless told");
    for (size_t i = 0; i < layout->station_count * layout->robot_count; ++i) {
        const wh_layout_station_t *station = &layout->stations[i / layout->robot_count];
        const size_t r = i % layout->robot_count;
        const wh_layout_approach_t *by = &station->by[r];
        if (by->serves) {
            const wh_mat3_t *R =
                by->is_turned ? &by->R : &layout->places[i / layout->robot_count].base_from_station.R;
            wh_grid_named_row(grid, station->name);
            wh_grid_text(grid, 1, WH_INK_PLAIN, "%s", layout->robots[r].name);
            wh_grid_number(grid, 2, WH_INK_PLAIN, wh_deg_from_rad(wh_atan2(R->m[1][0], R->m[0][0])));
            wh_grid_text(grid, 3, WH_INK_PLAIN, "%s", station->robot == (int32_t)r ? "yes" : "no");
        }
    }
    wh_print_titled(&listing->frame, "Served by", grid);
}

static void add_timed(const wh_layout_t *layout, wh_grid_t *grid, int32_t robot, int32_t station) {
    const wh_flow_tool_t *timed = layout->timed;
    const size_t of = wh_flow_of(timed, robot, station);
    const char *side = wh_flow_side_words[timed->sides[of]];
    wh_grid_named_row(grid, timed->robots[robot].name);
    wh_grid_text(grid, 1, WH_INK_PLAIN, "%s", timed->stations[station].name);
    wh_grid_number(grid, 2, WH_INK_PLAIN, (double)timed->pick_us[of] / 1e6);
    wh_grid_number(grid, 3, WH_INK_PLAIN, (double)timed->place_us[of] / 1e6);
    wh_grid_text(grid, 4, WH_INK_PLAIN, "%s", side ? side : "");
    wh_grid_text(grid, 5, WH_INK_PLAIN, "%s",
                 timed->doors[of].is_real ? layout->door_list[timed->doors[of].number].name : "");
}

/* Robots beside those with axes, and the stations to which they come. */
static void print_timed(const listing_t *listing) {
    const wh_flow_tool_t *timed = listing->layout->timed;
    if (!timed) {
        return;
    }
    wh_grid_t *grid =
        wh_grid_new(listing->frame.style, 2, "times alone;station;pick s{3};place s{3};side;door");
    for (size_t i = 0; i < timed->robot_count * timed->station_count; ++i) {
        if (timed->serves[i]) {
            add_timed(listing->layout, grid, (int32_t)(i / timed->station_count),
                      (int32_t)(i % timed->station_count));
        }
    }
    wh_print_titled(&listing->frame, "Robots that are times alone", grid);
}

static void add_gap(wh_grid_t *grid, size_t column, bool has, wh_real_t gap) {
    if (has) {
        wh_grid_number(grid, column, gap > 0 ? WH_INK_PLAIN : WH_INK_BAD, gap);
    }
}

static void print_room(const listing_t *listing) {
    wh_grid_t *grid = wh_grid_new(listing->frame.style, 1,
                                  "blade entered at;to the wafer above{3};to the one below{3};"
                                  "to ledges or chuck{3};`retract` before{3};above a lifted wafer{3}");
    for (size_t s = 0; listing->check->has_parts && s < listing->layout->station_count; ++s) {
        const wh_entry_t *entry = &listing->check->entries[s];
        wh_grid_named_row(grid, listing->layout->stations[s].name);
        add_gap(grid, 1, entry->has_above, entry->above);
        add_gap(grid, 2, entry->has_below, entry->below);
        add_gap(grid, 3, entry->has_beside, entry->beside);
        add_gap(grid, 4, entry->has_before, entry->before);
        add_gap(grid, 5, entry->has_lifted, entry->lifted);
    }
    wh_print_titled(&listing->frame, "Room", grid);
}

/* ------------------------------------------------------------------------------------------------ physics */

/* Whole slices; the layout may say a part of one more. */
static void print_debounce(wh_grid_t *grid, const wh_layout_t *layout) {
    const double told = wh_layout_debounce_ms(layout), given = layout->debounce_given;
    if (given > 0 && told - given > 1e-6) {
        wh_grid_text(grid, 1, WH_INK_PLAIN,
                     "tells a level that has stood for %g ms: %g ms, rounded up to slices", told, given);
    } else {
        wh_grid_text(grid, 1, WH_INK_PLAIN, "tells a level that has stood for %g ms", told);
    }
}

static void print_holding(const listing_t *listing) {
    const wh_vacuum_config_t *vacuum = &listing->layout->physics.vacuum;
    const wh_pads_t *pads = &listing->layout->physics.pads;
    wh_grid_t *grid = wh_grid_new(listing->frame.style, 1, "of all grippers;");
    wh_grid_named_row(grid, "vacuum");
    if (vacuum->build <= 0 && vacuum->vent <= 0) {
        wh_grid_text(grid, 1, WH_INK_PLAIN, "ideal: an open valve holds at once");
    } else {
        wh_grid_text(grid, 1, WH_INK_PLAIN, "builds in %g ms, vents in %g ms, is at %g without a wafer",
                     (vacuum->build * MS), (vacuum->vent * MS), vacuum->idle);
        wh_grid_named_row(grid, "thresholds");
        wh_grid_text(grid, 1, WH_INK_PLAIN, "sensor on at %g, off below %g; lets go below %g", vacuum->on,
                     vacuum->off, vacuum->release);
    }
    if (vacuum->debounce > 0) {
        wh_grid_named_row(grid, "sensor");
        print_debounce(grid, listing->layout);
    }
    if (pads->mass > 0) {
        wh_grid_named_row(grid, "pads");
        wh_grid_text(grid, 1, WH_INK_PLAIN, "friction %g, %g N of vacuum, a wafer of %.4g kg", pads->friction,
                     pads->force, pads->mass);
    }
    wh_print_titled(&listing->frame, "Holding", grid);
}

/* ------------------------------------------------------------------------------------------------- faults */

static const char *target_of(const wh_layout_t *layout, const wh_fault_t *fault) {
    if (fault->target == WH_NONE) {
        return "all";
    }
    if (wh_fault_is_of_door(fault->kind)) {
        return layout->door_list[fault->target].name;
    }
    if (wh_fault_is_of_beam(fault->kind)) {
        return layout->stations[layout->beams[fault->target].station].name;
    }
    if (wh_fault_is_of_station(fault->kind)) {
        return layout->stations[fault->target].name;
    }
    if (wh_fault_is_of_controller(fault->kind)) {
        return layout->robot_count > 0 ? layout->robots[fault->target].name : "robot";
    }
    return wh_fault_is_of_wafer(fault->kind) ? layout->wafers[fault->target].name
                                             : layout->grippers[fault->target].name;
}

/* The unit of the value. */
static const char *unit_of(wh_fault_kind_t kind) {
    switch ((int)kind) {
    case WH_FAULT_LEAK:
    case WH_FAULT_EDGE_SENSOR_STUCK:
        return "";
    case WH_FAULT_PLUNGER_SLOW:
    case WH_FAULT_DOOR_SLOW:
        return " mm/s";
    case WH_FAULT_STATION_SLOW:
        return " times";
    default:
        return " s";
    }
}

static void add_fault(const listing_t *listing, wh_grid_t *grid, const wh_fault_t *fault) {
    const double slice_s = (double)listing->layout->slice_us / 1e6;
    wh_grid_named_row(grid, wh_fault_name(fault->kind));
    wh_grid_text(grid, 1, WH_INK_PLAIN, "%s", target_of(listing->layout, fault));
    wh_grid_text(grid, 2, WH_INK_PLAIN, "%.10g", (double)(fault->from - 1) * slice_s);
    if (fault->until == WH_FAULT_FOREVER) {
        wh_grid_text(grid, 3, WH_INK_DIM, "it is cleared");
    } else {
        wh_grid_text(grid, 3, WH_INK_PLAIN, "%.10g", (double)(fault->until - 1) * slice_s);
    }
    if (wh_fault_most(fault->kind) > 0) {
        wh_grid_text(grid, 4, WH_INK_PLAIN, "%g%s", fault->value, unit_of(fault->kind));
    }
}

static void print_faults(const listing_t *listing) {
    const wh_physics_t *physics = &listing->layout->physics;
    wh_grid_t *grid = wh_grid_new(listing->frame.style, 1, "fault;of;from s;until s;value");
    for (size_t i = 0; i < physics->fault_count; ++i) {
        add_fault(listing, grid, &physics->faults[i]);
    }
    wh_print_titled(&listing->frame, "Faults on purpose", grid);
}

/* ----------------------------------------------------------------------------------------------- findings */

static void print_finding(const listing_t *listing, const wh_finding_t *finding) {
    FILE *out = listing->frame.out;
    const char *cross = wh_style_glyph(listing->frame.style, WH_GLYPH_CROSS);
    wh_style_print(listing->frame.style, out, finding->is_warning ? WH_INK_WARN : WH_INK_BAD, "%s",
                   finding->is_warning ? "!" : cross);
    fputc(' ', out);
    wh_style_put(out, finding->text);
    fputc('\n', out);
}

static void print_findings(const listing_t *listing) {
    const wh_feasibility_t *check = listing->check;
    fputc('\n', listing->frame.out);
    for (size_t i = 0; i < check->count; ++i) {
        print_finding(listing, &check->findings[i]);
    }
    if (check->wrong == 0) {
        wh_style_print(listing->frame.style, listing->frame.out, WH_INK_GOOD, "%s",
                       wh_style_glyph(listing->frame.style, WH_GLYPH_TICK));
        fprintf(listing->frame.out, " nothing%s is wrong with it%s\n", check->count > 0 ? " else" : "",
                check->layout->station_count > 1 ? "; ways between stations are not judged" : "");
    }
}

static void print_wafers(const listing_t *listing) {
    const wh_layout_t *layout = listing->layout;
    fprintf(listing->frame.out, "\n%zu wafer%s of %g mm, %g mm thick, ", layout->wafer_count,
            layout->wafer_count == 1 ? "" : "s", layout->wafer_diameter, layout->wafer_thickness);
    if (layout->notch_depth > 0) {
        fprintf(listing->frame.out, "notch at %g%s\n", wh_deg_from_rad(layout->notch),
                wh_style_glyph(listing->frame.style, WH_GLYPH_DEGREE));
    } else {
        fputs("without a notch\n", listing->frame.out);
    }
}

static void print_heading(const listing_t *listing) {
    const wh_layout_t *layout = listing->layout;
    const wh_tolerance_t *limits = &layout->grasp.tolerance;
    wh_style_put(listing->frame.out, layout->path);
    print_wafers(listing);
    fprintf(listing->frame.out, "tolerance %s: %g mm%s, %g mm%s, %.10g%s; checked %s %g ms\n",
            layout->tolerance_name, limits->projz, wh_print_default(layout, 0), limits->projxy,
            wh_print_default(layout, 1), limits->planar, wh_print_default(layout, 2), wh_print_check(layout),
            (double)layout->slice_us / 1e3);
    fprintf(listing->frame.out, "wafers %s%s; collisions are %schecked, %zu parts\n",
            layout->grasp.seat ? "are drawn onto the pads" : "stay as they were taken",
            layout->cell.settle ? ", and settle on what they are put down on" : "",
            layout->collision ? "" : "not ", layout->world.part_count + layout->wafer_count);
    const wh_corrections_t *most = &layout->corrections;
    fprintf(listing->frame.out, "corrections of a command are at most x %g, y %g, z %g mm, turn %g%s\n",
            most->x, most->y, most->z, most->turn_deg, wh_style_glyph(listing->frame.style, WH_GLYPH_DEGREE));
}

int wh_layout_print_table(const wh_feasibility_t *check, FILE *out, const wh_style_t *style) {
    const listing_t listing = {check, check->layout, {NULL, style, out}};
    print_heading(&listing);
    print_axes(&listing);
    print_grippers(&listing);
    print_doors(&listing);
    print_stations(&listing);
    print_times(&listing);
    print_ports(&listing);
    print_servers(&listing);
    print_timed(&listing);
    print_room(&listing);
    print_holding(&listing);
    print_faults(&listing);
    wh_layout_print_bodies(&listing.frame, check->layout);
    print_findings(&listing);
    return fflush(out) != 0 || ferror(out) ? -1 : 0;
}
