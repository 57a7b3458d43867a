#include <stdlib.h>

#include "../math/trig.h"
#include "layout_table_internal.h"

static const wh_grid_digits_t whole = {0, 6, false, 0};
static const wh_grid_digits_t fine = {3, 3, false, 0};

int wh_listing_finish(const wh_listing_t *listing, const char *title, wh_grid_t *grid) {
    if (wh_grid_rows(grid) == 0) {
        return wh_grid_discard(grid);
    }
    fputc('\n', listing->out);
    wh_style_print(listing->style, listing->out, WH_INK_BOLD, "%s", title);
    fputc('\n', listing->out);
    return wh_grid_print(grid, listing->out);
}

/* ------------------------------------------------------------------------------------------------ the machine */

static int print_axes(const wh_listing_t *listing) {
    static const char *const names[WH_ROBOT_AXES] = {"theta", "R", "Z", "yaw"};
    static const char *const headings[] = {"from", "to", "home", "speed", "acceleration", "jerk"};
    const wh_robot_t *robot = &listing->layout->machine.robot;
    wh_grid_t *grid = wh_grid_new(listing->style, 1);
    wh_grid_text_column(grid, "axis");
    for (size_t i = 0; i < 6; ++i) {
        wh_grid_number_column(grid, headings[i], whole);
    }
    wh_grid_text_column(grid, "in");
    for (size_t i = 0; i < WH_ROBOT_AXES; ++i) {
        const bool turns = i == WH_AXIS_THETA || i == WH_AXIS_YAW;
        const wh_limits_t *limits = &robot->limits[i];
        const wh_real_t values[] = {robot->travel[i].min, robot->travel[i].max, robot->home[i],
                                    limits->speed,        limits->acceleration, limits->jerk};
        wh_grid_row(grid);
        wh_grid_text(grid, 0, WH_INK_PLAIN, "%s", names[i]);
        for (size_t column = 0; column < 6; ++column) {
            wh_grid_number(grid, column + 1, WH_INK_PLAIN,
                           (double)(turns ? wh_deg_from_rad(values[column]) : values[column]));
        }
        wh_grid_text(grid, 7, WH_INK_DIM, turns ? "deg, s" : "mm, s");
    }
    return wh_listing_finish(listing, "Robot", grid);
}

static int print_grippers(const wh_listing_t *listing) {
    const wh_layout_t *layout = listing->layout;
    wh_grid_t *grid = wh_grid_new(listing->style, 1);
    wh_grid_text_column(grid, "gripper");
    wh_grid_text_column(grid, "on");
    wh_grid_text_column(grid, "valve");
    wh_grid_text_column(grid, "at mm");
    wh_grid_number_column(grid, "turned deg", whole);
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        const wh_layout_gripper_t *gripper = &layout->grippers[g];
        wh_grid_row(grid);
        wh_grid_text(grid, 0, WH_INK_PLAIN, "%s", gripper->name);
        wh_grid_text(grid, 1, WH_INK_PLAIN, "%s",
                     gripper->station == WH_NONE ? "robot" : layout->stations[gripper->station].name);
        wh_grid_text(grid, 2, WH_INK_PLAIN, "%s", gripper->valve);
        if (layout->machine.mounts[g].is_shifted) {
            const wh_pose_t *shift = &layout->machine.mounts[g].effector_from_gripper;
            wh_grid_text(grid, 3, WH_INK_PLAIN, "%g, %g, %g", (double)shift->r.x, (double)shift->r.y,
                         (double)shift->r.z);
            wh_grid_number(grid, 4, WH_INK_PLAIN,
                           (double)wh_deg_from_rad(wh_atan2(shift->R.m[1][0], shift->R.m[0][0])));
        }
    }
    return wh_listing_finish(listing, "Grippers", grid);
}

/* --------------------------------------------------------------------------------------------------- stations */

enum { NAME, KIND, X, Y, Z, HEADING, TILT, SLOTS, PITCH, STROKE, OFFSET, RETRACT, WAFERS };

static void add_station(const wh_listing_t *listing, wh_grid_t *grid, size_t s) {
    const wh_layout_station_t *station = &listing->layout->stations[s];
    const wh_station_t *place = &listing->layout->places[s];
    const wh_mat3_t *R = &place->base_from_station.R;
    const wh_real_t sine = wh_real_sqrt(R->m[0][2] * R->m[0][2] + R->m[1][2] * R->m[1][2]);
    const char *kind = station->foup ? "foup" : "slots";
    wh_grid_row(grid);
    wh_grid_text(grid, NAME, WH_INK_PLAIN, "%s", station->name);
    wh_grid_text(grid, KIND, WH_INK_PLAIN, "%s%s", station->prealigner ? "prealigner" : kind,
                 station->taught ? "" : ", not taught");
    wh_grid_number(grid, X, WH_INK_PLAIN, (double)place->base_from_station.r.x);
    wh_grid_number(grid, Y, WH_INK_PLAIN, (double)place->base_from_station.r.y);
    wh_grid_number(grid, Z, WH_INK_PLAIN, (double)place->base_from_station.r.z);
    wh_grid_number(grid, HEADING, WH_INK_PLAIN, (double)wh_deg_from_rad(wh_atan2(R->m[1][0], R->m[0][0])));
    wh_grid_number(grid, TILT, WH_INK_PLAIN, (double)wh_deg_from_rad(wh_atan2(sine, R->m[2][2])));
    wh_grid_number(grid, SLOTS, WH_INK_PLAIN, place->slots);
    wh_grid_number(grid, PITCH, WH_INK_PLAIN, (double)place->pitch);
    wh_grid_number(grid, STROKE, WH_INK_PLAIN, (double)station->stroke);
    wh_grid_number(grid, OFFSET, WH_INK_PLAIN, (double)station->offset);
    wh_grid_number(grid, RETRACT, WH_INK_PLAIN, (double)station->retract);
    wh_grid_number(grid, WAFERS, WH_INK_PLAIN, (double)listing->check->entries[s].wafers);
}

static int print_stations(const wh_listing_t *listing) {
    static const char *const headings[] = {"x",     "y",      "z",      "heading deg", "tilt deg", "slots",
                                           "pitch", "stroke", "offset", "retract",     "wafers"};
    wh_grid_t *grid = wh_grid_new(listing->style, 1);
    wh_grid_text_column(grid, "station");
    wh_grid_text_column(grid, "kind");
    for (size_t i = 0; i < sizeof headings / sizeof headings[0]; ++i) {
        wh_grid_number_column(grid, headings[i], whole);
    }
    for (size_t s = 0; s < listing->layout->station_count; ++s) {
        add_station(listing, grid, s);
    }
    return wh_listing_finish(listing, "Stations", grid);
}

static void add_gap(wh_grid_t *grid, size_t column, bool has, wh_real_t gap) {
    if (has) {
        wh_grid_number(grid, column, gap > 0 ? WH_INK_PLAIN : WH_INK_BAD, (double)gap);
    }
}

static int print_room(const wh_listing_t *listing) {
    wh_grid_t *grid = wh_grid_new(listing->style, 1);
    wh_grid_text_column(grid, "blade entered at");
    wh_grid_number_column(grid, "to the wafer above", fine);
    wh_grid_number_column(grid, "to the one below", fine);
    wh_grid_number_column(grid, "to ledges or chuck", fine);
    for (size_t s = 0; listing->check->has_parts && s < listing->layout->station_count; ++s) {
        const wh_entry_t *entry = &listing->check->entries[s];
        wh_grid_row(grid);
        wh_grid_text(grid, 0, WH_INK_PLAIN, "%s", listing->layout->stations[s].name);
        add_gap(grid, 1, entry->has_above, entry->above);
        add_gap(grid, 2, entry->has_below, entry->below);
        add_gap(grid, 3, entry->has_beside, entry->beside);
    }
    return wh_listing_finish(listing, "Room", grid);
}

/* ------------------------------------------------------------------------------------------------------ shapes */

static int print_shapes(const wh_listing_t *listing) {
    const wh_shapes_t *s = &listing->layout->shapes;
    wh_grid_t *grid = wh_grid_new(listing->style, 1);
    wh_grid_text_column(grid, "shape");
    wh_grid_text_column(grid, "size");
    wh_grid_row(grid);
    wh_grid_text(grid, 0, WH_INK_PLAIN, "blade");
    wh_grid_text(grid, 1, WH_INK_PLAIN, "%g thick, %g wide, fingers of %g, %g before its origin, %g behind",
                 (double)s->blade.thickness, 2 * (double)s->blade.half_width, (double)s->blade.finger,
                 (double)s->blade.length, (double)s->blade.palm);
    wh_grid_row(grid);
    wh_grid_text(grid, 0, WH_INK_PLAIN, "ledges");
    wh_grid_text(grid, 1, WH_INK_PLAIN, "%g thick, %g long, from %g to %g beside the middle",
                 (double)s->ledge.thickness, (double)s->ledge.length, (double)s->ledge.inner,
                 (double)s->ledge.outer);
    wh_grid_row(grid);
    wh_grid_text(grid, 0, WH_INK_PLAIN, "arm");
    wh_grid_text(grid, 1, WH_INK_PLAIN, "two links of %g, wrist %g behind the end-effector, elbow %s",
                 (double)s->arm.link, (double)s->arm.reach, s->arm.right_handed ? "right" : "left");
    wh_grid_row(grid);
    wh_grid_text(grid, 0, WH_INK_PLAIN, "FOUP");
    wh_grid_text(grid, 1, WH_INK_PLAIN,
                 "walls of %g, %g from the wafer; floor %g below, roof %g above the slots",
                 (double)s->shell.wall, (double)s->shell.room, (double)s->shell.floor, (double)s->shell.roof);
    wh_grid_row(grid);
    wh_grid_text(grid, 0, WH_INK_PLAIN, "chuck");
    wh_grid_text(grid, 1, WH_INK_PLAIN, "radius %g, %g high; a body of radius %g below it",
                 (double)s->chuck.radius, (double)s->chuck.height, (double)s->chuck.body);
    return wh_listing_finish(listing, "Shapes, mm", grid);
}

static void describe_size(wh_grid_t *grid, size_t column, const wh_convex_t *convex) {
    const double x = 2 * (double)convex->half.x;
    const double z = 2 * (double)convex->half.z;
    switch (convex->kind) {
    case WH_CONVEX_BOX:
        wh_grid_text(grid, column, WH_INK_PLAIN, "box, %g by %g by %g", x, 2 * (double)convex->half.y, z);
        break;
    case WH_CONVEX_CYLINDER:
        wh_grid_text(grid, column, WH_INK_PLAIN, "cylinder, %g wide, %g high", x, z);
        break;
    case WH_CONVEX_CAPSULE:
        wh_grid_text(grid, column, WH_INK_PLAIN, "capsule, %g wide, %g high and its caps", x, z);
        break;
    case WH_CONVEX_MESH:
        wh_grid_text(grid, column, WH_INK_PLAIN, "mesh of %zu points", convex->point_count);
        break;
    }
}

static const char *carrier_of(const wh_layout_t *layout, const wh_part_t *part) {
    static const char *const bodies[WH_ARM_BODIES] = {"column", "lift", "upper arm", "forearm", "hand"};
    if (part->kind == WH_PART_FIXED) {
        return "base";
    }
    return part->kind == WH_PART_ARM ? bodies[part->owner] : layout->grippers[part->owner].name;
}

static int print_obstacles(const wh_listing_t *listing) {
    const wh_world_config_t *world = &listing->layout->world;
    wh_grid_t *grid = wh_grid_new(listing->style, 1);
    wh_grid_text_column(grid, "obstacle");
    wh_grid_text_column(grid, "on");
    wh_grid_text_column(grid, "shape");
    wh_grid_number_column(grid, "x", whole);
    wh_grid_number_column(grid, "y", whole);
    wh_grid_number_column(grid, "z", whole);
    for (size_t i = 0; i < world->part_count; ++i) {
        const wh_part_t *part = &world->parts[i];
        const bool hung = i + listing->layout->hung_count >= world->part_count;
        if (hung || (part->kind == WH_PART_FIXED && part->owner == WH_NONE)) {
            wh_grid_row(grid);
            wh_grid_text(grid, 0, WH_INK_PLAIN, "%s", listing->layout->part_names[i]);
            wh_grid_text(grid, 1, WH_INK_PLAIN, "%s", carrier_of(listing->layout, part));
            describe_size(grid, 2, &part->convex);
            wh_grid_number(grid, 3, WH_INK_PLAIN, (double)part->convex.body_from_shape.r.x);
            wh_grid_number(grid, 4, WH_INK_PLAIN, (double)part->convex.body_from_shape.r.y);
            wh_grid_number(grid, 5, WH_INK_PLAIN, (double)part->convex.body_from_shape.r.z);
        }
    }
    return wh_listing_finish(listing, "Obstacles, mm", grid);
}

static int print_limits(const wh_listing_t *listing) {
    wh_grid_t *grid = wh_grid_new(listing->style, 1);
    wh_grid_text_column(grid, "clearance");
    wh_grid_number_column(grid, "at least mm", whole);
    for (int kind = 0; kind < WH_CLEARANCES; ++kind) {
        if (listing->layout->world.limits[kind] > 0) {
            wh_grid_row(grid);
            wh_grid_text(grid, 0, WH_INK_PLAIN, "%s", wh_clearance_name((wh_clearance_kind_t)kind));
            wh_grid_number(grid, 1, WH_INK_PLAIN, (double)listing->layout->world.limits[kind]);
        }
    }
    return wh_listing_finish(listing, "Clearances", grid);
}

/* --------------------------------------------------------------------------------------------------- findings */

static int put(const wh_listing_t *listing, const char *text) {
    char *printable = wh_style_printable(text);
    fputs(printable ? printable : "", listing->out);
    free(printable);
    return printable ? 0 : -1;
}

static int print_findings(const wh_listing_t *listing) {
    int status = 0;
    fputc('\n', listing->out);
    if (listing->check->count == 0) {
        wh_style_print(listing->style, listing->out, WH_INK_GOOD, "%s", wh_style_tick(listing->style));
        fputs(" nothing is wrong with it\n", listing->out);
    }
    for (size_t i = 0; i < listing->check->count; ++i) {
        wh_style_print(listing->style, listing->out, WH_INK_BAD, "%s", wh_style_cross(listing->style));
        fputc(' ', listing->out);
        status |= put(listing, listing->check->findings[i].text);
        fputc('\n', listing->out);
    }
    return status;
}

static int print_heading(const wh_listing_t *listing) {
    const wh_layout_t *layout = listing->layout;
    const wh_tolerance_t *limits = &layout->grasp.tolerance;
    const int status = put(listing, layout->path);
    fprintf(listing->out, "\n%zu wafer%s of %g mm, %g mm thick, notch at %g%s\n", layout->wafer_count,
            layout->wafer_count == 1 ? "" : "s", layout->wafer_diameter, layout->wafer_thickness,
            (double)wh_deg_from_rad((wh_real_t)layout->notch), wh_style_degree(listing->style));
    fprintf(listing->out, "tolerance %s: %g mm, %g mm, %.10g; checked %s %g ms\n", layout->tolerance_name,
            (double)limits->projz, (double)limits->projxy, (double)limits->planar,
            layout->grasp.check == WH_CHECK_SWEPT ? "along the whole of each slice of"
                                                  : "once a slice, every",
            (double)layout->slice_us / 1e3);
    fprintf(listing->out, "wafers %s%s; collisions are %schecked, %zu parts\n",
            layout->grasp.seat ? "are drawn onto the pads" : "stay as they were taken",
            layout->cell.settle ? ", and settle on what they are put down on" : "",
            layout->collision ? "" : "not ", layout->world.part_count + layout->wafer_count);
    return status;
}

int wh_layout_print_table(const wh_feasibility_t *check, FILE *out, const wh_style_t *style) {
    const wh_listing_t listing = {check, check->layout, style, out};
    int status = print_heading(&listing);
    status |= print_axes(&listing);
    status |= print_grippers(&listing);
    status |= print_stations(&listing);
    status |= print_room(&listing);
    status |= wh_listing_print_physics(&listing);
    status |= print_shapes(&listing);
    status |= print_obstacles(&listing);
    status |= print_limits(&listing);
    status |= print_findings(&listing);
    return status != 0 || fflush(out) != 0 || ferror(out) ? -1 : 0;
}
